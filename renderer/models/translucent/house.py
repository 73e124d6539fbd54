"""A house of 736 polygons, closed volumes: large walls and roofs, small frames and shutters.

Our own model of the size and character of Chen1996's figure 16, whose data are lost. It was
fixed while only the BSP baseline had run on it.
"""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.translucent.solids import Faces, box, cone, disc, prism, turned

# Windows of a front: where along the wall, the sill's height, how far the shutters stand open.
EAST = [(-5.2, 0.9, 0.2), (-5.2, 3.7, 0.5), (-2.6, 3.7, 0.8), (0.9, 3.7, 1.1)]
NORTH = [(-2.9, 0.9, 0.6), (0.6, 3.7, 0.4)]
WEST = [(-4.6, 0.9, 0.9), (-1.9, 3.7, 0.3)]


def faces() -> Faces:
    """736 faces; y up, in metres."""
    windows: Faces = []
    for along, sill, opened in EAST:
        windows += _window(along, sill, opened, 0, 3.0, 1.0)
    for along, sill, opened in NORTH:
        windows += _window(along, sill, opened, 2, -6.0, -1.0)
    for along, sill, opened in WEST:
        windows += _window(along, sill, opened, 0, -4.0, -1.0)
    return [
        *_walls(),
        *_roofs(),
        *windows,
        *_porch(),
        *_tower(),
        *_garden(),
    ]


def _walls() -> Faces:
    """Plinth, walls with an L-shaped plan, and a bay."""
    plan = [(-6.0, -4.0), (-6.0, 3.0), (6.0, 3.0), (6.0, -1.0), (0.5, -1.0), (0.5, -4.0)]
    plinth = [(-6.2, -4.2), (-6.2, 3.2), (6.2, 3.2), (6.2, -1.2), (0.7, -1.2), (0.7, -4.2)]
    bay = [(3.6, 3.25), (4.0, 4.2), (5.0, 4.2), (5.4, 3.25)]
    return prism(plinth, 1, 0.0, 0.35) + prism(plan, 1, 0.4, 6.0) + prism(bay, 1, 0.4, 3.0, 0.9)


def _roofs() -> Faces:
    """Two gables with thickness, dormers, chimneys with caps and pots."""
    wing = [(-0.5, 9.4), (3.6, 6.1), (3.2, 6.1), (-0.5, 9.0), (-4.2, 6.1), (-4.6, 6.1)]
    tail = [(1.0, 8.6), (3.6, 6.1), (3.2, 6.1), (1.0, 8.2), (-1.2, 6.1), (-1.6, 6.1)]
    parts = prism(wing, 2, -6.6, 0.9) + prism(tail, 2, 1.0, 6.6)
    for z in (-4.4, -1.6):
        parts += prism(
            [(6.2, z - 0.6), (6.2, z + 0.6), (7.2, z + 0.6), (7.8, z), (7.2, z - 0.6)], 0, 3.65, 4.4
        )
    for x, z in ((-0.5, -3.5), (1.0, 4.0)):
        parts += box((x - 0.5, 9.5, z - 0.4), (x + 0.5, 10.8, z + 0.4))
        parts += box((x - 0.6, 10.85, z - 0.5), (x + 0.6, 11.0, z + 0.5))
        for shift in (-0.25, 0.25):
            parts += prism(disc((z, x + shift), 0.18, 6, 0.2), 1, 11.05, 11.6, 0.8)
    return parts


def _window(along: float, sill: float, opened: float, axis: int, wall: float, out: float) -> Faces:
    """Cross of bars, sill, lintel and two shutters before a wall: 38 faces.

    `opened` is the shutters' angle in radians; `out` the direction away from the wall.
    """
    a, b, c, d = along, along + 1.2, sill, sill + 1.5
    m, h, t = (a + b) / 2, (c + d) / 2, 0.05
    cross = [
        (m - t, c), (m + t, c), (m + t, h - t), (b, h - t), (b, h + t), (m + t, h + t),
        (m + t, d), (m - t, d), (m - t, h + t), (a, h + t), (a, h - t), (m - t, h - t),
    ]  # fmt: skip
    near, far = sorted((wall + out * 0.04, wall + out * 0.1))
    bars = prism([(y, u) for u, y in cross] if axis == 0 else cross, axis, near, far, 0.94)
    plans = [
        (_bar(a - 0.1, b + 0.1, 0.02, 0.3), c - 0.17, c - 0.03, 0.9),
        (_bar(a - 0.1, b + 0.1, 0.02, 0.2), d + 0.03, d + 0.2, 0.8),
        (_leaf(a - 0.15, -1.0, opened), c, d, 1.0),
        (_leaf(b + 0.15, 1.0, opened), c, d, 1.0),
    ]
    for plan, low, high, taper in plans:
        placed = [(u, wall + out * v) if axis == 0 else (wall + out * v, u) for u, v in plan]
        bars += prism(placed, 1, low, high, taper)
    return bars


def _bar(low: float, high: float, near: float, far: float) -> list[tuple[float, float]]:
    """A rectangle of (along the wall, out from the wall)."""
    return [(low, near), (high, near), (high, far), (low, far)]


def _leaf(hinge: float, turn: float, opened: float) -> list[tuple[float, float]]:
    """A shutter's plan: hinged beside the window, swung out from the wall."""
    along, out = float(np.cos(opened)), float(np.sin(opened))
    corners = [(0.0, 0.03), (0.55, 0.03), (0.55, 0.09), (0.0, 0.09)]
    return [(hinge + turn * (u * along - v * out), 0.0 + u * out + v * along) for u, v in corners]


def _porch() -> Faces:
    """Door, steps, four columns on bases, and a little roof."""
    steps = [
        (5.9, 0.0), (5.9, 0.14), (5.5, 0.14), (5.5, 0.28), (5.1, 0.28), (5.1, 0.4), (3.3, 0.4),
        (3.3, 0.0),
    ]  # fmt: skip
    roof = [(3.15, -2.5), (3.15, 0.1), (3.2, 0.1), (3.42, -1.2), (3.2, -2.5)]
    parts = box((3.02, 0.45, -1.8), (3.12, 2.7, -0.6)) + prism(steps, 2, -2.4, 0.0)
    for x in (3.6, 4.8):
        for z in (-2.2, -0.2):
            base = box((x - 0.16, 0.42, z - 0.16), (x + 0.16, 0.7, z + 0.16))
            parts += turned(base, 0.5, (z, x))
            parts += prism(disc((z, x), 0.12, 8, 0.5), 1, 0.72, 3.1, 0.8)
    return parts + prism(roof, 0, 3.22, 5.1)


def _tower() -> Faces:
    """A round tower open to one side, its winding stair, its pointed roof, and two arches."""
    angles = np.linspace(0.25, 2 * np.pi - 0.25, 13) + 2.4
    ring = [(1.9 * np.cos(a), 1.9 * np.sin(a)) for a in angles]
    ring += [(1.6 * np.cos(a), 1.6 * np.sin(a)) for a in angles[::-1]]
    middle = np.array([3.4, -3.6])
    wall = [(float(z) + middle[0], float(x) + middle[1]) for z, x in ring]
    parts = prism(wall, 1, 0.0, 3.6, 0.95) + prism(wall, 1, 3.7, 7.4, 0.95)
    for i in range(26):
        a, b = 0.6 * i, 0.6 * i + 0.7
        step = [(0.15, 0.0), (1.35, 0.0), (1.35 * np.cos(b - a), 1.35 * np.sin(b - a))]
        placed = [
            (
                float(u * np.cos(a) - v * np.sin(a)) + middle[0],
                float(u * np.sin(a) + v * np.cos(a)) + middle[1],
            )
            for u, v in step
        ]
        parts += prism(placed, 1, 0.3 + 0.26 * i, 0.45 + 0.26 * i, 0.85)
    parts += cone(disc((middle[0], middle[1]), 2.3, 12, 0.3), 1, 7.5, 10.4)
    arc = [(1.1 * np.cos(a), 2.0 + 1.1 * np.sin(a)) for a in np.linspace(0, np.pi, 7)]
    arch = [(1.1, 0.0), *arc, (-1.1, 0.0), (-1.5, 0.0), (-1.5, 3.5), (1.5, 3.5), (1.5, 0.0)]
    for z in (8.0, -9.0):
        one = prism([(float(x) + 1.0, float(y)) for x, y in arch], 2, z, z + 0.6, 0.97)
        parts += turned(one, 0.2, (z, 1.0))
    return parts


def _garden() -> Faces:
    """A tub."""
    return prism(disc((7.2, 4.6), 0.5, 6, 0.15), 1, 0.0, 0.7, 1.3)
