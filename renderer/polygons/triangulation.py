"""Polygons as triangles to draw: fans where convex, clipped ears where not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.polygons import Polygons, newell


def triangulate(polygons: Polygons, normals: Floats) -> tuple[NDArray[np.int32], Whole]:
    """(t, 3) corner rows of all triangles, polygon by polygon, and (m + 1,) where each begins.

    `normals` (m, 3) are those of the source planes. A polygon of c corners gives c - 2 triangles.
    """
    counts = polygons.counts
    bounds = np.concatenate([[0], np.cumsum(counts - 2)])
    owner = np.repeat(np.arange(len(polygons)), counts - 2)
    step = np.arange(bounds[-1]) - bounds[owner]
    first = polygons.starts[owner]
    triangles = np.stack([first, first + step + 1, first + step + 2], axis=1)
    for index in np.flatnonzero(~_convex(polygons, normals)):
        ears = clip_ears(_flat(polygons.corners(index), normals[index]))
        triangles[bounds[index] : bounds[index + 1]] = polygons.starts[index] + ears
    return triangles.astype(np.int32), bounds


def _convex(polygons: Polygons, normals: Floats) -> NDArray[np.bool_]:
    """(m,) whether a fan from the first corner stays inside: every corner turns left."""
    convex = polygons.counts == 3
    larger = np.flatnonzero(~convex)
    if not len(larger):
        return convex
    some = polygons.take(larger)
    first = some.starts[:-1]
    ahead = np.arange(1, len(some.vertices) + 1)
    ahead[some.starts[1:] - 1] = first
    edge = some.vertices[ahead] - some.vertices
    turn = np.cross(edge, edge[ahead])
    left = (turn * np.repeat(normals[larger], some.counts, axis=0)).sum(axis=1) >= 0.0
    # A loop that winds twice (a hole on a bridge) can turn left all along: ask for its area too.
    fan = np.linalg.norm(newell(some), axis=1)
    span = np.linalg.norm(
        np.cross(some.vertices - np.repeat(some.vertices[first], some.counts, 0), edge), axis=1
    )
    convex[larger] = np.logical_and.reduceat(left, first) & (
        np.add.reduceat(span, first) <= fan * (1 + 1e-9)
    )
    return convex


def _flat(corners: Floats, normal: Floats) -> Floats:
    """(c, 2) corners projected along the axis nearest to the normal, turning left."""
    axis = int(np.argmax(np.abs(normal)))
    kept = [(axis + 1) % 3, (axis + 2) % 3]
    return corners[:, kept] if normal[axis] > 0 else corners[:, kept[::-1]]


def clip_ears(corners: Floats) -> NDArray[np.int64]:
    """(c - 2, 3) triangles of a left-turning loop (c, 2), bridged holes allowed.

    Ear clipping; signed areas add up to the loop's whatever rounding does, because every step
    takes one corner off.
    """
    left = list(range(len(corners)))
    triangles = []
    while len(left) > 3:
        position = _ear(corners, left)
        size = len(left)
        triangles.append((left[position - 1], left[position], left[(position + 1) % size]))
        del left[position]
    return np.array([*triangles, tuple(left)])


def _ear(corners: Floats, left: list[int]) -> int:
    """Position of the corner to clip: the widest ear, else the flattest corner."""
    points = corners[left]
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    turn = _cross(points - before, after - points)
    lengths = [np.linalg.norm(d, axis=1) for d in (points - before, after - points, before - after)]
    height = turn / np.maximum(np.max(lengths, axis=0), 1e-300)
    for position in np.argsort(-height, kind="stable"):
        if turn[position] <= 0:
            break
        if not _covers(before[position], points[position], after[position], points):
            return int(position)
    return int(np.argmin(np.abs(turn)))


def _covers(a: Floats, b: Floats, c: Floats, points: Floats) -> bool:
    """Whether a point other than the three corners lies in the closed triangle."""
    inside = (
        (_cross(b - a, points - a) >= 0)
        & (_cross(c - b, points - b) >= 0)
        & (_cross(a - c, points - c) >= 0)
    )
    for corner in (a, b, c):
        inside &= (points != corner).any(axis=1)
    return bool(inside.any())


def _cross(u: Floats, v: Floats) -> Floats:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
