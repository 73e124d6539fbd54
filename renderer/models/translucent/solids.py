"""Closed solids as lists of flat, possibly concave faces, counter-clockwise seen from outside."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.renderer.arrays import Floats

Faces = list[Floats]


def prism(
    profile: Sequence[Sequence[float]] | Floats,
    axis: int,
    low: float,
    high: float,
    taper: float = 1.0,
) -> Faces:
    """A profile (k, 2) drawn out along an axis from `low` to `high`, scaled by `taper` on the way.

    The profile's coordinates are (y, z), (z, x) or (x, y) for the axis 0, 1 or 2, either way
    round. Gives k + 2 faces; the two ends may be concave. The taper, as a casting's draft has it,
    is about the middle of the profile's bounds.
    """
    flat = np.asarray(profile, float)
    ahead = np.roll(np.arange(len(flat)), -1)
    if (flat[:, 0] * flat[ahead, 1] - flat[ahead, 0] * flat[:, 1]).sum() < 0:
        flat = flat[::-1]
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2
    ends = []
    for height, scaled in (
        (low, flat),
        (high, flat if taper == 1.0 else middle + taper * (flat - middle)),
    ):
        corners = np.empty((len(flat), 3))
        corners[:, axis] = height
        corners[:, (axis + 1) % 3], corners[:, (axis + 2) % 3] = scaled.T
        ends.append(corners)
    bottom, top = ends
    sides = [np.stack([bottom[i], bottom[j], top[j], top[i]]) for i, j in enumerate(ahead)]
    return [bottom[::-1], top, *sides]


def cone(profile: Sequence[Sequence[float]], axis: int, low: float, high: float) -> Faces:
    """A profile that comes to a point above its middle: k triangles and the base."""
    bottom, _, *sides = prism(profile, axis, low, high, 0.0)
    return [bottom, *(side[:3] for side in sides)]


def box(low: Sequence[float], high: Sequence[float]) -> Faces:
    """Six rectangles between two corners."""
    (x, y, z), (a, b, c) = low, high
    return prism([(x, y), (a, y), (a, b), (x, b)], 2, z, c)


def disc(
    center: Sequence[float], radius: float, sides: int, turned: float = 0.0
) -> list[tuple[float, float]]:
    """A regular polygon as a profile; `turned` in parts of a corner's angle."""
    angles = (np.arange(sides) + turned) * 2 * np.pi / sides
    return [
        (center[0] + radius * float(np.cos(a)), center[1] + radius * float(np.sin(a)))
        for a in angles
    ]


def turned(
    faces: Faces, angle: float, about: tuple[float, float] = (0.0, 0.0), axis: int = 1
) -> Faces:
    """Faces turned, counter-clockwise about an axis through `about`.

    `about` has the coordinates a profile along that axis has (see `prism`).
    """
    u, v = (axis + 1) % 3, (axis + 2) % 3
    turn = np.eye(3)
    turn[[u, v], [u, v]] = np.cos(angle)
    turn[v, u], turn[u, v] = np.sin(angle), -np.sin(angle)
    middle = np.zeros(3)
    middle[[u, v]] = about
    return [(face - middle) @ turn.T + middle for face in faces]
