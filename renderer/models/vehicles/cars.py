"""Cars and trucks, in metres of the real thing, facing −z."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.renderer.models.forms.shapes import Color, Shape, assemble, join
from seethrough.renderer.models.forms.surfaces import box, copies, disc, pillow, rod, rounded, tube
from seethrough.renderer.models.vehicles.wheels import (
    GLASS,
    RUBBER,
    STEEL,
    arch_stations,
    arched,
    hull,
    plate,
    road_wheel,
)

DARK: Color = (0.12, 0.12, 0.13)
LIGHT: Color = (0.98, 0.95, 0.80)
RED_LIGHT: Color = (0.75, 0.06, 0.05)


Section = tuple[float, float, float, float]


def cabin(
    belt: Section,
    roof: Section,
    color: Color,
    glass: Color = GLASS,
    pillars: Sequence[float] = (0.5,),
) -> Shape:
    """A car's upper part: (y, front z, rear z, half width) at the belt and at the roof.

    Windows sit on its four sides; `pillars` are the places, as shares of the length, that divide
    the side windows.
    """
    rings = []
    for s, crown in ((0.0, 0.0), (0.9, 0.0), (0.97, 0.02), (1.0, 0.09), (1.0, 0.5)):
        y, front, rear, w = (b + (r - b) * s for b, r in zip(belt, roof, strict=True))
        flat = rounded(2 * w * (1 - crown * 0.6), (rear - front) * (1 - crown * 0.5), 0.07, 4)
        flat += (0, (front + rear) / 2)
        lift = 0.02 if crown == 0.5 else 0.0
        rings.append(np.column_stack([flat[:, 0], np.full(len(flat), y + lift), flat[:, 1]])[::-1])
    shell = tube(rings, color)
    (y0, f0, r0, w0), (y1, f1, r1, w1) = belt, roof

    def spot(share: float, s: float) -> tuple[float, float, float]:
        return (w0 + (w1 - w0) * s + 0.004, y0 + (y1 - y0) * s,
                (f0 + (f1 - f0) * s) * (1 - share) + (r0 + (r1 - r0) * s) * share)  # fmt: skip

    edges = [0.09, *pillars, 0.93]
    sides = []
    for i in range(len(edges) - 1):
        a, b = edges[i] + 0.018, edges[i + 1] - 0.018
        sides.append(
            plate([spot(b, 0.1), spot(a, 0.1), spot(a, 0.86), spot(b, 0.86)], 0.016, glass)
        )
    ends = []
    for za, zb, out in ((f0, f1, -0.006), (r0, r1, 0.006)):
        low, high = 0.1, 0.86
        p = [(x * (w0 + (w1 - w0) * s - 0.1), y0 + (y1 - y0) * s, za + (zb - za) * s + out)
             for x, s in ((1, low), (-1, low), (-1, high), (1, high))]  # fmt: skip
        ends.append(plate(p if out < 0 else p[::-1], 0.016, glass))
    return join(shell, join(*sides).both(), *ends)


def wheels(x: float, y: float, places: list[float], one: Shape) -> Shape:
    """The wheel, outer face at +x, on both sides at each z."""
    return join(*(one.at(x, y, z) for z in places)).both()


def car() -> Shape:
    """A yellow saloon."""
    paint = (0.95, 0.70, 0.08)
    axles, r = [-1.32, 1.28], 0.33
    z = arch_stations(-2.0, 2.02, axles, 0.40, 24)
    top = np.interp(
        z,
        [-2.0, -1.9, -1.3, -0.75, 0.4, 1.3, 1.9, 2.02],
        [0.74, 0.80, 0.88, 0.93, 0.95, 0.95, 0.93, 0.85],
    )
    w = np.interp(
        z, [-2.0, -1.9, -1.5, -0.8, 1.2, 1.7, 2.02], [0.72, 0.80, 0.86, 0.88, 0.88, 0.85, 0.76]
    )
    low = arched(z, 0.24, axles, r, 0.40)
    body = hull(z, w, low, top, paint, 0.09, 4, 0.05)
    floor = box((1.2, 0.42, 3.6), DARK).at(y=0.42)
    top_part = cabin((0.93, -0.88, 1.50, 0.82), (1.50, -0.22, 0.98, 0.66), paint)
    trim = [
        box((1.62, 0.15, 0.16), STEEL, 0.06, 3).at(y=0.40, z=-1.99),
        box((1.62, 0.15, 0.16), STEEL, 0.06, 3).at(y=0.42, z=2.0),
        pillow((0.72, 0.13, 0.08), DARK, 0.3, 20).at(y=0.60, z=-2.0),
        copies(box((0.70, 0.012, 0.09), STEEL), [(0, y, -2.005) for y in (0.565, 0.6, 0.635)]),
        box((0.45, 0.1, 0.02), (0.93, 0.93, 0.9)).at(y=0.60, z=2.03),
    ]
    side = join(
        disc(0.115, 0.1, STEEL, 24, 0.02).turned("x", 90).at(0.56, 0.63, -1.95),
        pillow((0.19, 0.19, 0.08), LIGHT, 0.9, 20).at(0.56, 0.63, -2.0),
        box((0.24, 0.17, 0.08), RED_LIGHT, 0.03, 3).at(0.57, 0.70, 1.99),
        box((0.17, 0.12, 0.10), paint, 0.04, 3).at(0.94, 0.98, -0.55),
        box((0.02, 0.03, 0.16), STEEL, 0.008).at(0.885, 0.78, 0.18),
        box((0.02, 0.03, 0.16), STEEL, 0.008).at(0.885, 0.78, 1.02),
        box((0.02, 0.5, 0.014), DARK).at(0.872, 0.62, 0.32),
        box((0.02, 0.5, 0.014), DARK).at(0.872, 0.62, -0.66),
        box((0.03, 0.05, 1.8), STEEL, 0.01).at(0.875, 0.45, 0.0),
    ).both()
    rolling = wheels(0.745, r, axles, road_wheel(r, 0.22))
    return assemble(body, floor, top_part, *trim, side, rolling, size=1.95)


def truck() -> Shape:
    """A red lorry with a closed box."""
    red, cream = (0.78, 0.10, 0.09), (0.90, 0.88, 0.80)
    r, axles = 0.48, [-2.35, 1.35, 2.45]
    z = arch_stations(-3.35, -1.45, [-2.35], 0.60, 12)
    low = arched(z, 0.45, [-2.35], r, 0.60)
    nose = hull(
        z, np.interp(z, [-3.35, -3.25], [1.06, 1.12]), low, np.full(len(z), 1.55), red, 0.1, 4
    )
    top_part = cabin((1.5, -3.32, -1.48, 1.10), (2.62, -2.98, -1.55, 1.02), red, pillars=())
    cargo = box((2.4, 2.35, 4.6), cream, 0.04).at(y=2.0, z=1.05)
    bands = join(
        box((2.44, 0.35, 4.5), (0.16, 0.35, 0.66), 0.01).at(y=1.75, z=1.05),
        copies(
            box((2.43, 2.3, 0.05), (0.75, 0.73, 0.66)),
            [(0, 2.0, v) for v in np.linspace(-1.2, 3.3, 7)],
        ),
        box((0.03, 2.25, 0.02), DARK).at(y=2.0, z=3.36),
    )
    frame = box((0.9, 0.3, 6.2), DARK, 0.03).at(y=0.66, z=0.1)
    front = [
        pillow((1.5, 0.5, 0.1), DARK, 0.2, 24).at(y=1.12, z=-3.35),
        copies(
            box((1.45, 0.04, 0.06), STEEL, 0.01), [(0, y, -3.39) for y in (0.95, 1.06, 1.17, 1.28)]
        ),
        box((2.3, 0.26, 0.2), STEEL, 0.07, 3).at(y=0.52, z=-3.38),
    ]
    side = join(
        pillow((0.3, 0.24, 0.12), LIGHT, 0.6, 20).at(0.9, 0.88, -3.36),
        box((0.2, 0.4, 0.1), DARK, 0.03).at(1.3, 2.05, -3.12),
        rod((1.08, 2.1, -3.1), (1.3, 2.1, -3.12), 0.03, STEEL),
        box((0.2, 0.2, 0.06), RED_LIGHT, 0.02).at(0.95, 0.72, 3.36),
        disc(0.3, 1.0, STEEL, 24, 0.04).turned("x", 90).at(0.86, 0.70, -0.55),
        rod((0.95, 0.9, -1.36), (0.95, 2.9, -1.36), 0.07, STEEL, 16),
        box((0.03, 0.05, 0.2), STEEL, 0.01).at(1.12, 1.38, -1.8),
        box((0.06, 0.5, 0.5), RUBBER).at(1.0, 0.42, 3.1),
    ).both()
    rolling = wheels(0.98, r, axles, road_wheel(r, 0.34, spokes=8))
    return assemble(nose, top_part, cargo, bands, frame, *front, side, rolling, size=2.0)
