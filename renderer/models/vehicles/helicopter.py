"""A helicopter, in metres of the real thing, facing −z."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.forms.shapes import Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    copies,
    curve,
    disc,
    lathe,
    pillow,
    rod,
    spun,
    sweep,
)
from seethrough.renderer.models.vehicles.wheels import GLASS, STEEL, wing

ORANGE = (0.90, 0.38, 0.08)
WHITE = (0.94, 0.94, 0.92)
DARK = (0.13, 0.13, 0.14)


def helicopter() -> Shape:
    """A rescue helicopter on skids."""
    cabin = ball((0.75, 0.85, 1.5), ORANGE, 48).painted(GLASS, _windscreen)
    cabin = cabin.painted(WHITE, lambda p: (p[:, 1] < 0) & (p[:, 1] > -0.22))
    cabin = cabin.bent(_cabin).at(0, 1.45, -0.6)
    window = pillow((0.1, 0.5, 0.62), GLASS, 0.45, 24).at(0.68, 1.80, -0.28).both()
    handle = box((0.05, 0.05, 0.16), STEEL, 0.015).at(0.74, 1.42, -0.1).both()
    spine = curve([(0, 1.75, 0.5), (0, 1.80, 1.6), (0, 1.95, 3.6)], 16)
    boom = sweep(spine, np.linspace(0.34, 0.11, 16), ORANGE, 20)
    band = sweep([(0, 1.855, 2.3), (0, 1.885, 2.7)], [0.238, 0.205], WHITE, 20)
    fin = wing((0, 0, 3.2), 0.62, (0.95, 0, 3.75), 0.4, 0.12, ORANGE, 6, 16)
    fin = fin.turned("z", 90).at(y=1.85)
    plane = wing((0.05, 1.9, 2.9), 0.4, (0.75, 1.92, 2.98), 0.3, 0.12, WHITE, 4, 16).both()
    engine = pillow((0.75, 0.5, 1.5), ORANGE, 0.55, 28).at(0, 2.28, 0.05)
    exhaust = lathe([(0.1, 0), (0.14, 0.3), (0.1, 0.3), (0.08, 0.1)], DARK, 20).turned("x", 70)
    return assemble(cabin, window, handle, boom, band, fin, plane, engine, _rotors(), _skids(),
                    exhaust.at(0.2, 2.3, 0.75), size=2.0)  # fmt: skip


def _rotors() -> Shape:
    """Four blades on the mast, three at the tail."""
    grey = (0.22, 0.22, 0.24)
    hub = [(0.14, 2.4), (0.08, 2.6), (0.06, 2.95), (0.16, 2.97), (0.16, 3.05), (0, 3.12)]
    blade = box((0.26, 0.035, 2.9), grey, 0.012).at(0, 0, 1.6)
    tip = box((0.262, 0.037, 0.3), (0.92, 0.80, 0.15), 0.012).at(0, 0, 2.9)
    arm = join(blade, tip).turned("x", 2)
    main = join(*(arm.turned("y", a) for a in (25, 115, 205, 295))).at(0, 3.0, 0)
    short = box((0.03, 0.62, 0.1), grey, 0.01).at(y=0.33).turned("x", 20)
    tail = join(spun(short, 3), disc(0.07, 0.2, DARK, 16).turned("z", 90)).at(0.16, 2.35, 3.72)
    return join(lathe(hub, DARK, 24), main, tail)


def _cabin(p: np.ndarray) -> np.ndarray:
    """Flattens the belly and draws the back out into the boom."""
    y = np.where(p[:, 1] < 0, p[:, 1] * 0.85, p[:, 1])
    rise = np.where(p[:, 2] > 0, p[:, 2] * 0.22, 0)
    return np.column_stack([p[:, 0], y + rise, p[:, 2]])


def _windscreen(p: np.ndarray) -> np.ndarray:
    """Where the bubble (n, 3) is of glass: above its middle, in front."""
    return (p[:, 1] > 0) & (np.abs(np.arctan2(p[:, 0] / 0.75, -p[:, 2] / 1.5)) < np.radians(62))


def _skids() -> Shape:
    runner = curve(
        [(0.85, 0.32, -2.05), (0.85, 0.12, -1.8), (0.85, 0.06, -1.5), (0.85, 0.06, 0.7)], 24
    )
    bow = [(0, 0.82, 0), (0.4, 0.75, 0), (0.75, 0.4, 0), (0.85, 0.08, 0)]
    bows = copies(sweep(curve(bow, 14), 0.05, DARK, 12), [(0, 0, -1.15), (0, 0, 0.2)])
    step = rod((0.95, 0.3, -1.15), (0.95, 0.3, 0.2), 0.035, DARK, 10)
    return join(sweep(runner, 0.06, DARK, 14), bows, step).both()
