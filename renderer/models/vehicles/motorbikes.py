"""A motorcycle, in metres of the real thing, facing −z."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.forms.shapes import Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import (
    ball,
    box,
    copies,
    curve,
    disc,
    pillow,
    rod,
    sweep,
)
from seethrough.renderer.models.vehicles.cycles import BLACK, mudguard
from seethrough.renderer.models.vehicles.wheels import STEEL, road_wheel, tyre

RED = (0.72, 0.07, 0.08)


def motorbike() -> Shape:
    """A red motorcycle: tank, twin engine, exhausts, round lamp."""
    r = 0.31
    front, rear = (0, r, -0.74), (0, r, 0.68)
    wheel = join(tyre(r, 0.13, 0.085, 40, 4), road_wheel(r * 0.8, 0.10, STEEL, 6))
    tank = pillow((0.30, 0.26, 0.56), RED, 0.7, 32).bent(_tank).turned("x", 8).at(0, 0.82, -0.17)
    seat = pillow((0.27, 0.12, 0.62), BLACK, 0.45, 28).bent(_saddle).at(0, 0.77, 0.36)
    tail = pillow((0.2, 0.14, 0.3), RED, 0.6, 20).turned("x", 12).at(0, 0.78, 0.72)
    light = pillow((0.1, 0.06, 0.05), (0.85, 0.05, 0.05), 0.5, 14).at(0, 0.79, 0.87)
    guards = join(
        mudguard(front, r + 0.03, 0.085, (20, 150), RED),
        mudguard(rear, r + 0.035, 0.085, (10, 110), RED),
    )
    return assemble(wheel.at(*front), wheel.at(*rear), tank, seat, tail, light, guards,
                    _steering(), _frame(), _engine(), size=1.8)  # fmt: skip


def _steering() -> Shape:
    """Lamp, fork, bars, grips and mirrors."""
    lamp = join(
        ball((0.1, 0.1, 0.1), STEEL, 24).at(0, 0, 0.02),
        pillow((0.17, 0.17, 0.06), (1, 0.97, 0.82), 0.9, 20).at(0, 0, -0.07),
    ).at(0, 0.88, -0.62)
    yokes = copies(box((0.24, 0.035, 0.08), BLACK, 0.01), [(0, 0.72, -0.575), (0, 0.93, -0.485)])
    bend = [(0.1, 0.99, -0.46), (0.26, 1.08, -0.34), (0.38, 1.06, -0.25)]
    path = curve([*((-x, y, z) for x, y, z in bend[::-1]), *bend], 24)
    sides = join(
        rod((0.09, 0.31, -0.74), (0.09, 0.95, -0.47), 0.024, STEEL, 12),
        rod((0.09, 0.28, -0.755), (0.09, 0.55, -0.64), 0.035, BLACK, 12),
        rod((0.29, 1.078, -0.315), (0.40, 1.055, -0.235), 0.024, BLACK, 12),
        rod((0.24, 1.07, -0.36), (0.28, 1.22, -0.38), 0.008, STEEL),
        disc(0.055, 0.02, STEEL, 16, 0.006).turned("x", 80).at(0.29, 1.25, -0.38),
    )
    return join(lamp, yokes, sweep(path, 0.014, STEEL, 10), sides.both())


def _frame() -> Shape:
    """The tube under the engine, swing arm, dampers with their springs."""
    tube = curve(
        [(0.06, 0.85, -0.45), (0.07, 0.45, -0.40), (0.09, 0.26, -0.25), (0.09, 0.24, 0.2),
         (0.08, 0.42, 0.34)], 16
    )  # fmt: skip
    coils = [(0.124, 0.42 + 0.05 * i, 0.607 - 0.018 * i) for i in range(5)]
    return join(
        sweep(tube, 0.02, BLACK),
        rod((0.11, 0.31, 0.68), (0.09, 0.36, 0.22), 0.026, BLACK, 10),
        rod((0.13, 0.33, 0.64), (0.11, 0.72, 0.50), 0.022, STEEL, 10),
        copies(disc(0.042, 0.014, RED, 14).turned("x", -20), coils),
    ).both()


def _saddle(p: np.ndarray) -> np.ndarray:
    return p + np.outer(0.5 * p[:, 2] ** 2, (0, 1, 0))


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
