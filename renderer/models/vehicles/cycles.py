"""A bicycle, in metres of the real thing, facing −z."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    curve,
    disc,
    pillow,
    ring,
    rod,
    rounded,
    spun,
    sweep,
)
from seethrough.renderer.models.vehicles.wheels import STEEL, spoked_wheel

BLACK: Color = (0.10, 0.10, 0.11)


def bike() -> Shape:
    """A bicycle: diamond frame, spoked wheels, chain, straight bars, saddle."""
    paint = (0.05, 0.52, 0.50)
    r, front, rear = 0.34, (0.0, 0.34, -0.53), (0.0, 0.34, 0.50)
    crank, seat = (0, 0.29, 0.06), (0, 0.80, 0.22)
    post = rod(seat, (0, 0.92, 0.26), 0.014, STEEL)
    saddle = pillow((0.16, 0.07, 0.28), BLACK, 0.6, 24).bent(_saddle).at(0, 0.945, 0.25)
    wheel = spoked_wheel(r, 0.035, 0.036, 28, 0.03)
    lamp = join(
        ball((0.035, 0.035, 0.03), STEEL, 12),
        disc(0.03, 0.02, (1, 0.97, 0.8), 16).turned("x", 90).at(z=-0.025),
    )
    guards = join(
        mudguard(front, r + 0.022, 0.026, (20, 130), paint),
        mudguard(rear, r + 0.022, 0.026, (-10, 150), paint),
    )
    return assemble(_frame(crank, seat, paint), _handlebars(), post, saddle, _drive(crank, rear),
                    wheel.at(*front), wheel.at(*rear), lamp.at(0, 0.86, -0.42), guards,
                    size=1.75)  # fmt: skip


def _frame(crank: Sequence[float], seat: Sequence[float], paint: Color) -> Shape:
    """The diamond, the stays to the rear wheel and the fork."""
    head, low = (0, 0.86, -0.34), (0, 0.72, -0.39)
    blade = curve(
        [(0.03, 0.70, -0.395), (0.055, 0.66, -0.41), (0.055, 0.5, -0.465), (0.055, 0.34, -0.53)], 10
    )
    sides = join(
        rod((0.02, 0.29, 0.06), (0.06, 0.34, 0.50), 0.013, paint),
        rod((0.015, 0.77, 0.21), (0.06, 0.34, 0.50), 0.013, paint),
        sweep(blade, 0.015, paint),
    )
    return join(
        rod(crank, seat, 0.021, paint, 12),
        rod((0, 0.79, 0.215), (0, 0.83, -0.35), 0.021, paint, 12),
        rod(crank, (0, 0.73, -0.385), 0.024, paint, 12),
        rod(head, low, 0.027, paint, 12),
        rod((-0.05, 0.70, -0.397), (0.05, 0.70, -0.397), 0.018, paint),
        sides.both(),
    )


def _handlebars() -> Shape:
    bend = [(0.08, 0.985, -0.385), (0.2, 1.0, -0.27), (0.29, 1.0, -0.22)]
    path = curve([*((-x, y, z) for x, y, z in bend[::-1]), (0, 0.98, -0.40), *bend], 24)
    stem = join(
        rod((0, 0.86, -0.34), (0, 0.97, -0.305), 0.016, STEEL),
        rod((0, 0.97, -0.305), (0, 0.98, -0.40), 0.018, STEEL),
    )
    grips = rod((0.2, 1.0, -0.27), (0.3, 1.0, -0.215), 0.02, BLACK, 12).both()
    return join(sweep(path, 0.0125, STEEL), stem, grips)


def mudguard(
    axle: Sequence[float], radius: float, half_width: float, span: tuple[float, float], color: Color
) -> Shape:
    """A strip round a wheel over a span of angles, degrees about +x from the back upwards."""
    angle = np.radians(np.linspace(*span, 20))
    path = np.stack([0 * angle, np.sin(angle) * radius, np.cos(angle) * radius], axis=1)
    thin = 0.008 / half_width  # 8 mm of thickness
    return sweep(path + axle, half_width, color, section=rounded(thin, 2, 0.48 * thin, 2))


def _saddle(p: np.ndarray) -> np.ndarray:
    taper = np.interp(p[:, 2], [-0.14, -0.02, 0.14], [0.3, 0.45, 1.15])
    return p * np.stack([taper, np.ones_like(taper), np.ones_like(taper)], axis=1)


def _drive(crank: Sequence[float], rear: Sequence[float]) -> Shape:
    """Chainwheel, cranks, pedals, sprocket and chain on the right side."""
    x, big, small = 0.05, 0.095, 0.04
    wheel = ring(
        [(big - 0.015, -0.002), (big, -0.002), (big, 0.002), (big - 0.015, 0.002)], STEEL, 32
    ).turned("z", 90)
    arms = spun(box((0.004, 0.085, 0.014), STEEL).at(y=0.0425), 5)
    sprocket = disc(small, 0.006, STEEL, 20).turned("z", 90).at(x, *rear[1:])
    a = np.linspace(np.pi / 2, 3 * np.pi / 2, 16)
    one = np.stack([np.sin(a) * big + crank[1], np.cos(a) * big + crank[2]], axis=1)
    two = np.stack(
        [np.sin(a + np.pi) * small + rear[1], np.cos(a + np.pi) * small + rear[2]], axis=1
    )
    loop = np.concatenate([one, two])
    chain = sweep(np.column_stack([np.full(len(loop), x), loop]), 0.007, BLACK, 4, closed=True)
    lever = rod((0.075, 0, 0), (0.085, -0.12, -0.11), 0.012, STEEL)
    pedal = box((0.09, 0.024, 0.07), BLACK, 0.006).at(0.135, -0.12, -0.11)
    right = join(lever, pedal)
    left = right.turned("x", 180).mirrored()
    shaft = rod((-0.08, 0, 0), (0.08, 0, 0), 0.02, STEEL, 12)
    return join(join(join(wheel, arms).at(x), right, left, shaft).at(*crank), sprocket, chain)
