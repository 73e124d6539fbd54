"""Corners of rooms, darker than the walls: light that slabs keep from one another.

A wall has too few vertices to be darkened by. Where another slab or a floor comes near, it is cut
along lines at some distances from that one; each vertex then loses light to the slabs near by, the
more the nearer they are and the farther they stand out before its surface. It follows from where
slabs stand, and not from what a technique does with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.look.floor import KIND
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object

FEW = 200  # vertices: what has more is a model, with hollows of its own (occlusion.py)
STRAIGHT = 0.999  # the cosine of its normals with its axes, at least
THIN = 0.25  # of a slab's middle side its thinnest one has at most
REACH = 0.35  # of a slab's middle side: how near another one has to be
LEVELS = (0.0, 0.2, 0.45, 1.0)  # of the reach: where a slab is cut
DEEP = 0.5  # of the light that one slab takes where it touches another
CLOSE = 0.05  # of the reach: cuts so near to one another are one


@dataclass(frozen=True, eq=False)
class _Slab:
    """A thing's box in its mesh's axes, in world units: `sides` (3,) what an axis is stretched by,
    `low`, `high` (3,) its bounds so stretched; `reach` is 0 for what takes no light of its own."""

    thing: Object
    sides: Floats
    low: Floats
    high: Floats
    reach: float


def cornered(things: Sequence[Object], strength: float) -> tuple[Object, ...]:
    """The things, with slabs that are darker where they meet others; the rest as they are."""
    slabs = [_slab(thing) for thing in things]
    others = [slab for slab in slabs if slab is not None]
    return tuple(
        thing if slab is None or slab.reach == 0 else _darker(slab, others, strength)
        for thing, slab in zip(things, slabs, strict=True)
    )


def _slab(thing: Object) -> _Slab | None:
    """A thing as a slab, or None if it is none."""
    if thing.target or not 0 < len(thing.mesh.vertices) < FEW:
        return None
    sides = np.linalg.norm(thing.transform[:3, :3], axis=0)
    low, high = thing.mesh.bounds * sides
    thin, middle, _ = np.sort(high - low).tolist()
    straight = np.abs(thing.mesh.normals).max(axis=1).min() > STRAIGHT
    if thin > THIN * middle or not straight:
        return None
    reach = 0.0 if thing.kind == KIND else REACH * middle
    return _Slab(thing, sides, low, high, reach)


def _near(slab: _Slab, others: Sequence[_Slab]) -> Floats:
    """(k, 2, 3) boxes of the other slabs within reach, along the slab's own axes."""
    into = np.linalg.inv(slab.thing.transform)
    found = []
    for other in others:
        if other is slab:
            continue
        bounds = other.thing.mesh.bounds
        corners = np.array([[bounds[k >> a & 1, a] for a in range(3)] for k in range(8)])
        matrix = into @ other.thing.transform
        own = (corners @ matrix[:3, :3].T + matrix[:3, 3]) * slab.sides
        low, high = own.min(axis=0), own.max(axis=0)
        gap = np.maximum(np.maximum(low - slab.high, slab.low - high), 0)
        if np.linalg.norm(gap) < slab.reach:
            found.append([low, high])
    return np.array(found).reshape(-1, 2, 3)


def _darker(slab: _Slab, others: Sequence[_Slab], strength: float) -> Object:
    """The slab cut, and darkened where others are near."""
    near = _near(slab, others)
    if not len(near):
        return slab.thing
    places = [(k, place / slab.sides[k]) for k in range(3) for place in _places(slab, near, k)]
    mesh = cut(slab.thing.mesh, places)
    normals = mesh.normals / slab.sides
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    lost = shade(mesh.vertices * slab.sides, normals, near, slab.reach)
    colors = mesh.colors * (1 - strength * lost)[:, None]
    return replace(slab.thing, mesh=replace(mesh, colors=colors))


def _places(slab: _Slab, near: Floats, axis: int) -> list[float]:
    """Where to cut along an axis, in world units."""
    steps = np.array(LEVELS) * slab.reach
    every = np.sort(
        np.concatenate([(near[:, 0, axis, None] - steps).ravel(),
                        (near[:, 1, axis, None] + steps).ravel()])
    )  # fmt: skip
    least, found = CLOSE * slab.reach, list[float]()
    last = slab.low[axis]
    for place in every.tolist():
        if place > last + least and place < slab.high[axis] - least:
            found.append(place)
            last = place
    return found


def shade(points: Floats, normals: Floats, near: Floats, reach: float) -> Floats:
    """(n,) how much of its light each of (n, 3) points of a surface loses to boxes (k, 2, 3)."""
    left = np.ones(len(points))
    for low, high in near:
        gap = np.maximum(np.maximum(low - points, points - high), 0)
        part = np.clip(1 - np.linalg.norm(gap, axis=1) / reach, 0, 1) ** 2
        ahead = np.where(normals > 0, high, low) - points  # the corner that stands out farthest
        out = np.clip((ahead * normals).sum(axis=1) / (reach / 2), 0, 1)
        left *= 1 - DEEP * part * out
    return 1 - left


def cut(mesh: Mesh, cuts: Sequence[tuple[int, float]]) -> Mesh:
    """The same surface with no triangle on both sides of any of the planes (axis, place)."""
    points = list(np.concatenate([mesh.vertices, mesh.normals, mesh.colors], axis=1))
    polygons = mesh.triangles.tolist()
    for axis, place in cuts:
        side = [float(point[axis]) - place for point in points]
        polygons = _halves(polygons, side, points, axis, place)
    triangles = [
        [polygon[0], polygon[k], polygon[k + 1]]
        for polygon in polygons
        for k in range(1, len(polygon) - 1)
    ]
    vertices, normals, colors = np.split(np.array(points), [3, 6], axis=1)
    return Mesh(vertices, normals, colors, np.array(triangles, dtype=np.int32), mesh.convex)


def _halves(
    polygons: list[list[int]], side: list[float], points: list[Floats], axis: int, place: float
) -> list[list[int]]:
    """Convex polygons cut where `side` of their vertices changes its sign; new points are added."""
    made, found = dict[tuple[int, int], int](), list[list[int]]()
    for polygon in polygons:
        signs = [side[a] for a in polygon]
        if min(signs) >= 0 or max(signs) <= 0:
            found.append(polygon)
            continue
        halves: tuple[list[int], list[int]] = ([], [])
        for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
            if side[a] >= 0:
                halves[0].append(a)
            if side[a] <= 0:
                halves[1].append(a)
            if side[a] * side[b] < 0:
                key = (min(a, b), max(a, b))
                if key not in made:
                    t = side[key[0]] / (side[key[0]] - side[key[1]])
                    point = points[key[0]] + t * (points[key[1]] - points[key[0]])
                    point[axis] = place  # so that what meets there still does
                    made[key] = len(points)
                    points.append(point)
                for half in halves:
                    half.append(made[key])
        found += halves
    return found
