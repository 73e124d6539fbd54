"""Two-wheelers, in metres of the real thing, facing −z."""

from __future__ import annotations

import numpy as np

from renderer.models.shapes import Color, Shape, assemble, join
from renderer.models.surfaces import (
    ball,
    box,
    copies,
    curve,
    disc,
    pillow,
    ring,
    rod,
    rounded,
    spun,
    sweep,
)
from renderer.models.wheels import STEEL, road_wheel, spoked_wheel, tyre

BLACK: Color = (0.10, 0.10, 0.11)


def bike() -> Shape:
    """A bicycle: diamond frame, spoked wheels, chain, straight bars, saddle."""
    paint = (0.05, 0.52, 0.50)
    r, front, rear = 0.34, (0.0, 0.34, -0.53), (0.0, 0.34, 0.50)
    crank, seat, head, low = (0, 0.29, 0.06), (0, 0.80, 0.22), (0, 0.86, -0.34), (0, 0.72, -0.39)
    thick, thin = 0.021, 0.013
    frame = [
        rod(crank, seat, thick, paint, 12),
        rod((0, 0.79, 0.215), (0, 0.83, -0.35), thick, paint, 12),
        rod(crank, (0, 0.73, -0.385), 0.024, paint, 12),
        rod(head, low, 0.027, paint, 12),
        join(
            rod((0.02, 0.29, 0.06), (0.06, 0.34, 0.50), thin, paint),
            rod((0.015, 0.77, 0.21), (0.06, 0.34, 0.50), thin, paint),
            sweep(curve([(0.03, 0.70, -0.395), (0.055, 0.66, -0.41), (0.055, 0.5, -0.465),
                         (0.055, 0.34, -0.53)], 10), 0.015, paint),
        ).both(),
        rod((-0.05, 0.70, -0.397), (0.05, 0.70, -0.397), 0.018, paint),
    ]  # fmt: skip
    bars = sweep(
        curve(
            [
                (-0.29, 1.0, -0.22),
                (-0.2, 1.0, -0.27),
                (-0.08, 0.985, -0.385),
                (0, 0.98, -0.40),
                (0.08, 0.985, -0.385),
                (0.2, 1.0, -0.27),
                (0.29, 1.0, -0.22),
            ],
            24,
        ),
        0.0125,
        STEEL,
    )
    grips = rod((0.2, 1.0, -0.27), (0.3, 1.0, -0.215), 0.02, BLACK, 12).both()
    stem = join(
        rod(head, (0, 0.97, -0.305), 0.016, STEEL),
        rod((0, 0.97, -0.305), (0, 0.98, -0.40), 0.018, STEEL),
    )
    post = rod(seat, (0, 0.92, 0.26), 0.014, STEEL)
    saddle = pillow((0.16, 0.07, 0.28), BLACK, 0.6, 24).bent(_saddle).at(0, 0.945, 0.25)
    parts = [*frame, bars, grips, stem, post, saddle, _drive(crank, rear)]
    wheel = spoked_wheel(r, 0.035, 0.036, 28, 0.03)
    parts += [wheel.at(*front), wheel.at(*rear)]
    lamp = join(
        ball((0.035, 0.035, 0.03), STEEL, 12),
        disc(0.03, 0.02, (1, 0.97, 0.8), 16).turned("x", 90).at(z=-0.025),
    )
    guard = [
        _mudguard(place, r + 0.022, a, b, paint)
        for place, a, b in ((front, 20, 130), (rear, -10, 150))
    ]
    return assemble(*parts, lamp.at(0, 0.86, -0.42), *guard, size=1.75)


def _mudguard(axle: tuple, radius: float, start: float, end: float, color: Color) -> Shape:
    """A strip round a wheel from one angle to another, degrees about +x from the back upwards."""
    angle = np.radians(np.linspace(start, end, 20))
    path = np.stack([0 * angle, np.sin(angle) * radius, np.cos(angle) * radius], axis=1)
    return sweep(path + axle, 0.026, color, section=rounded(0.3, 2, 0.14, 2))


def _saddle(p: np.ndarray) -> np.ndarray:
    taper = np.interp(p[:, 2], [-0.14, -0.02, 0.14], [0.3, 0.45, 1.15])
    return p * np.stack([taper, np.ones_like(taper), np.ones_like(taper)], axis=1)


def _drive(crank: tuple, rear: tuple) -> Shape:
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


def motorbike() -> Shape:
    """A red motorcycle: tank, twin engine, exhausts, round lamp."""
    red, r = (0.72, 0.07, 0.08), 0.31
    front, rear = (0, r, -0.74), (0, r, 0.68)
    tread = join(tyre(r, 0.13, 0.085, 40, 4), road_wheel(r * 0.8, 0.10, STEEL, 6))
    tank = pillow((0.30, 0.26, 0.56), red, 0.7, 32).bent(_tank).turned("x", 8).at(0, 0.82, -0.17)
    seat = (
        pillow((0.27, 0.12, 0.62), BLACK, 0.45, 28)
        .bent(lambda p: p + np.outer(0.5 * p[:, 2] ** 2, (0, 1, 0)))
        .at(0, 0.77, 0.36)
    )
    tail = pillow((0.2, 0.14, 0.3), red, 0.6, 20).turned("x", 12).at(0, 0.78, 0.72)
    lamp = join(
        ball((0.1, 0.1, 0.1), STEEL, 24).at(0, 0, 0.02),
        pillow((0.17, 0.17, 0.06), (1, 0.97, 0.82), 0.9, 20).at(0, 0, -0.07),
    ).at(0, 0.88, -0.62)
    fork = join(
        rod((0.09, 0.31, -0.74), (0.09, 0.95, -0.47), 0.024, STEEL, 12),
        rod((0.09, 0.28, -0.755), (0.09, 0.55, -0.64), 0.035, BLACK, 12),
    ).both()
    yokes = copies(box((0.24, 0.035, 0.08), BLACK, 0.01), [(0, 0.72, -0.575), (0, 0.93, -0.485)])
    bars = sweep(curve([(-0.38, 1.06, -0.25), (-0.26, 1.08, -0.34), (-0.1, 0.99, -0.46),
                        (0.1, 0.99, -0.46), (0.26, 1.08, -0.34), (0.38, 1.06, -0.25)], 24),
                 0.014, STEEL, 10)  # fmt: skip
    grips = join(
        rod((0.29, 1.078, -0.315), (0.40, 1.055, -0.235), 0.024, BLACK, 12),
        rod((0.24, 1.07, -0.36), (0.28, 1.22, -0.38), 0.008, STEEL),
        disc(0.055, 0.02, STEEL, 16, 0.006).turned("x", 80).at(0.29, 1.25, -0.38),
    ).both()
    frame = [
        sweep(
            curve(
                [
                    (0.06, 0.85, -0.45),
                    (0.07, 0.45, -0.40),
                    (0.09, 0.26, -0.25),
                    (0.09, 0.24, 0.2),
                    (0.08, 0.42, 0.34),
                ],
                16,
            ),
            0.02,
            BLACK,
        ).both(),
        rod((0.11, 0.31, 0.68), (0.09, 0.36, 0.22), 0.026, BLACK, 10).both(),
        rod((0.13, 0.33, 0.64), (0.11, 0.72, 0.50), 0.022, STEEL, 10).both(),
        copies(
            disc(0.042, 0.014, red, 14).turned("x", -20),
            [(s, 0.42 + 0.05 * i, 0.607 - 0.018 * i) for s in (-0.124, 0.124) for i in range(5)],
        ),
    ]
    guards = [_guard(front, r + 0.03, 20, 150, red), _guard(rear, r + 0.035, 10, 110, red)]
    light = pillow((0.1, 0.06, 0.05), (0.85, 0.05, 0.05), 0.5, 14).at(0, 0.79, 0.87)
    return assemble(tread.at(*front), tread.at(*rear), tank, seat, tail, lamp, fork, yokes, bars,
                    grips, *frame, *guards, light, _engine(), size=1.8)  # fmt: skip


def _guard(axle: tuple, radius: float, start: float, end: float, color: Color) -> Shape:
    angle = np.radians(np.linspace(start, end, 20))
    path = np.stack([0 * angle, np.sin(angle) * radius, np.cos(angle) * radius], axis=1)
    return sweep(path + axle, 0.085, color, section=rounded(0.25, 2, 0.12, 2))


def _tank(p: np.ndarray) -> np.ndarray:
    taper = np.interp(p[:, 2], [-0.28, 0.0, 0.28], [1.0, 1.0, 0.6])
    return p * np.stack([taper, 0.5 + 0.5 * taper, np.ones_like(taper)], axis=1)


def _engine() -> Shape:
    """V-twin with cooling fins, gearbox, and two pipes on the right."""
    grey = (0.55, 0.56, 0.60)
    block = pillow((0.3, 0.26, 0.44), grey, 0.5, 24).at(0, 0.36, 0.02)
    cover = disc(0.11, 0.34, STEEL, 28, 0.02).turned("z", 90).at(0, 0.36, 0.06)
    fins = copies(disc(0.095, 0.014, grey, 20), [(0, 0.03 * i, 0) for i in range(9)])
    barrel = join(
        fins, disc(0.075, 0.26, BLACK, 20).at(y=0.12), disc(0.085, 0.07, STEEL, 20, 0.02).at(y=0.28)
    )
    pipes = []
    for dy, start in ((0, -0.24), (0.09, 0.05)):
        path = curve([(0.06, 0.58 + dy, start - 0.06), (0.15, 0.5 + dy, start - 0.10),
                      (0.17, 0.30 + dy, start + 0.04), (0.17, 0.24 + dy, 0.3),
                      (0.18, 0.27 + dy, 0.95)], 30)  # fmt: skip
        pipes.append(sweep(path, np.interp(path[:, 2], [0.25, 0.36], [0.024, 0.045]), STEEL, 14))
    filters = disc(0.09, 0.1, STEEL, 20, 0.02).turned("z", 90).at(0.14, 0.62, -0.02)
    pair = join(
        barrel.turned("x", -24).at(0, 0.42, -0.07), barrel.turned("x", 24).at(0, 0.42, 0.08)
    )
    rests = box((0.04, 0.04, 0.12), BLACK, 0.01).at(0.2, 0.28, -0.12).both()
    return join(block, cover, pair, *pipes, filters, rests)
