"""Parts that several vehicles share: wheels, flat plates, lofted hulls, wings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Color, Shape, join
from seethrough.renderer.models.forms.surfaces import (
    box,
    circle,
    copies,
    disc,
    lathe,
    ring,
    rod,
    rounded,
    spun,
    tube,
)

RUBBER: Color = (0.09, 0.09, 0.10)
STEEL: Color = (0.72, 0.73, 0.76)
GLASS: Color = (0.20, 0.30, 0.38)


def tyre(radius: float, width: float, depth: float, sides: int = 32, steps: int = 3) -> Shape:
    """A tyre about the x axis, its tread `depth` above the rim."""
    flat = rounded(depth, width, 0.42 * min(depth, width), steps)
    return ring(np.add(flat, (radius - depth / 2, 0)), RUBBER, sides, sharp=180).turned("z", 90)


def road_wheel(radius: float, width: float, rim: Color = STEEL, spokes: int = 5) -> Shape:
    """A car's wheel about the x axis, its outer face at +x."""
    inner = 0.68 * radius
    dish = lathe(
        [(0, -0.3 * width), (inner, -0.42 * width), (inner * 1.02, 0.42 * width),
         (inner * 0.93, 0.44 * width), (inner * 0.86, 0.20 * width), (0, 0.16 * width)],
        (0.25, 0.25, 0.27), 32, sharp=30,
    ).painted(rim, lambda p: np.hypot(p[:, 0], p[:, 2]) > inner * 0.87)  # fmt: skip
    bar = box((0.2 * radius, 0.16 * width, 0.60 * radius), rim, 0.02 * radius, 1).at(
        y=0.28 * width, z=0.3 * radius
    )
    hub = disc(0.19 * radius, 0.2 * width, rim, 16, 0.03 * radius).at(y=0.32 * width)
    arms = spun(bar.turned("z", -90), spokes)
    return join(tyre(radius, width, 0.33 * radius), join(dish, hub).turned("z", -90), arms)


def plate(corners: ArrayLike, thickness: float, color: Color) -> Shape:
    """A flat four-cornered plate, corners (4, 3) counter-clockwise seen from its front."""
    p = np.asarray(corners, float)
    normal = np.cross(p[1] - p[0], p[3] - p[0])
    step = normal / np.linalg.norm(normal) * thickness / 2
    return tube([p - step, p + step], color, sharp=30)


def hull(
    z: ArrayLike, half_width: ArrayLike, bottom: ArrayLike, top: ArrayLike,
    color: Color, radius: float = 0.06, steps: int = 4, flare: float = 0.0,
) -> Shape:  # fmt: skip
    """A body along +z of rounded sections; its sides lean in by `flare` of their width upwards."""
    rings = []
    for zi, w, low, high in np.broadcast(z, half_width, bottom, top):
        flat = rounded(2 * w, high - low, min(radius, 0.48 * (high - low), 0.48 * 2 * w), steps)
        flat[:, 0] *= 1 - flare * (flat[:, 1] / (high - low)) - flare / 2
        rings.append(np.column_stack([np.add(flat, (0, (low + high) / 2)), np.full(len(flat), zi)]))
    return tube(rings, color)


def arched(z: Floats, sill: float, axles: Sequence[float], axle_y: float, radius: float) -> Floats:
    """Height of a car's underside at the places z: the sill, with a round arch over each axle."""
    height = np.full(len(z), sill)
    for axle in axles:
        room = radius**2 - (z - axle) ** 2
        height = np.maximum(
            height, axle_y + np.sqrt(np.maximum(room, 0)) * (room > 0) - (room <= 0)
        )
    return height


def arch_stations(
    start: float, end: float, axles: Sequence[float], radius: float, n: int
) -> Floats:
    """Places along a body: n even ones, and close ones where the wheel arches bend."""
    bends = [a + radius * s for a in axles for s in (-1.0001, -0.9999, 0.9999, 1.0001)]
    arcs = [a + radius * np.cos(t) for a in axles for t in np.linspace(0, np.pi, 15)[1:-1]]
    even = np.linspace(start, end, n)
    clear = np.all([np.abs(even - a) > radius * 1.05 for a in axles], axis=0)
    return np.sort(np.concatenate([even[clear], bends, arcs]))


def wing(
    root: Sequence[float], root_chord: float, tip: Sequence[float], tip_chord: float,
    thick: float, color: Color, steps: int = 12, sides: int = 20,
) -> Shape:  # fmt: skip
    """A wing from the leading edge at the root to that at the tip, chords along +z.

    `thick` is the thickness as a share of the chord. The tip lies to the right (+x) of the root.
    """
    angle = circle(sides)
    along = 0.5 - 0.5 * angle[:, 0]
    foil = np.stack(
        [angle[:, 1] * np.sqrt(along + 1e-3) * (1.05 - along) * 1.6 * thick / 2, along], 1
    )
    t = np.linspace(0, 1, steps)[:, None]
    edge = np.asarray(root, float) * (1 - t) + np.asarray(tip, float) * t
    chord = root_chord * (1 - t) + tip_chord * t
    rings = np.repeat(edge[:, None], sides, axis=1)
    rings[..., 1] += chord * foil[:, 0]
    rings[..., 2] += chord * foil[:, 1]
    return tube(rings, color, sharp=60)


def spoked_wheel(radius: float, depth: float, width: float, spokes: int, hub: float) -> Shape:
    """A bicycle's wheel about the x axis: tyre, rim and thin spokes crossed to both hub flanges."""
    tread = tyre(radius, width, depth, 40, 2)
    inner = radius - depth
    flat = rounded(0.5 * depth, width * 0.8, 0.1 * depth, 1)
    rim = ring(np.add(flat, (inner, 0)), STEEL, 40).turned("z", 90)
    wires = [_spoke(2 * np.pi * i / spokes, i, hub, radius, inner) for i in range(4)]
    axle = disc(0.05 * radius, 2.6 * hub, STEEL, 12).turned("z", 90)
    flange = disc(0.075 * radius, 0.3 * hub, STEEL, 12).turned("z", 90)
    return join(
        tread,
        rim,
        spun(join(*wires), spokes // 4),
        axle,
        copies(flange, [(hub, 0, 0), (-hub, 0, 0)]),
    )


def _spoke(angle: float, i: int, hub: float, radius: float, inner: float) -> Shape:
    """The i-th of four spokes: flanges alternate, pairs cross."""
    leave = angle + (0.5 if i < 2 else -0.5)
    start = (hub if i % 2 else -hub, 0.04 * radius * np.cos(leave), 0.04 * radius * np.sin(leave))
    end = (0, inner * np.cos(angle), inner * np.sin(angle))
    return rod(start, end, 0.006 * radius, STEEL, 4)
