"""How much of the view two boxes share: the overlap of their contours, as an angle or an area."""

from __future__ import annotations

import numba
import numpy as np

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.boxes.box_relations import contour, face_code


@numba.njit(cache=True)
def shared_views(
    centers: Floats,
    axes: Floats,
    halves: Floats,
    corners: Floats,
    point: Floats,
    table: Whole,
    sizes: Whole,
    first: Whole,
    second: Whole,
) -> Floats:
    """(p,) what the contours of pairs of boxes share, seen from a homogeneous point (4,).

    From an eye: a solid angle in steradians, so it does not depend on where the camera looks; a
    box around the eye fills all of it. Along a view vector: an area in square world units. One
    contour is clipped by the planes through the other's edges and the eye (Sutherland and
    Hodgman, "Reentrant polygon clipping", 1974).
    """
    result = np.empty(len(first))
    rays, edges = np.empty((6, 3)), np.empty((6, 4))
    polygon, other = np.empty((16, 3)), np.empty((16, 3))
    for p in range(len(first)):
        i, j = first[p], second[p]
        code = face_code(centers[i], axes[i], halves[i], point)
        count = sizes[code]
        if count:
            contour(corners[i], table[code], count, point, rays, edges)
            _copy(rays, count, polygon)
        code = face_code(centers[j], axes[j], halves[j], point)
        length = sizes[code]
        if length:
            contour(corners[j], table[code], length, point, rays, edges)
        if count == 0 and length == 0:
            result[p] = 4.0 * np.pi
            continue
        if count == 0:
            count = length
            _copy(rays, count, polygon)
        else:
            for e in range(length):
                if edges[e, 3] > -np.inf:
                    count = _clip(polygon, count, edges[e], other)
                    _copy(other, count, polygon)
        result[p] = _area(polygon, count, point) if point[3] == 0.0 else _angle(polygon, count)
    return result


@numba.njit()
def _copy(loop: Floats, count: int, out: Floats) -> None:
    # Element by element: numba takes seconds to compile the assignment of rows.
    for c in range(count):
        for k in range(3):
            out[c, k] = loop[c, k]


@numba.njit()
def _clip(polygon: Floats, count: int, edge: Floats, out: Floats) -> int:
    """The part of a loop of rays on the inner side of an edge's plane."""
    made = 0
    for c in range(count):
        a, b = polygon[c], polygon[(c + 1) % count]
        height = edge[0] * a[0] + edge[1] * a[1] + edge[2] * a[2] - edge[3]
        following = edge[0] * b[0] + edge[1] * b[1] + edge[2] * b[2] - edge[3]
        if height >= 0.0:
            for k in range(3):
                out[made, k] = a[k]
            made += 1
        if (height > 0.0 and following < 0.0) or (height < 0.0 and following > 0.0):
            t = height / (height - following)
            for k in range(3):
                out[made, k] = a[k] + t * (b[k] - a[k])
            made += 1
    return made


@numba.njit()
def _triple(a: Floats, b: Floats, c: Floats) -> float:
    """Determinant of three rows."""
    total = a[0] * (b[1] * c[2] - b[2] * c[1])
    total += a[1] * (b[2] * c[0] - b[0] * c[2])
    return total + a[2] * (b[0] * c[1] - b[1] * c[0])


@numba.njit()
def _dot(a: Floats, b: Floats) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@numba.njit()
def _area(polygon: Floats, count: int, point: Floats) -> float:
    """Of a loop of corners, seen along the view vector."""
    total = 0.0
    for c in range(count):
        total += _triple(point, polygon[c], polygon[(c + 1) % count])
    return abs(total) / (2.0 * np.sqrt(point[0] ** 2 + point[1] ** 2 + point[2] ** 2))


@numba.njit()
def _angle(polygon: Floats, count: int) -> float:
    """Of a loop of rays: Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983."""
    total = 0.0
    for i in range(2, count):
        a, b, c = polygon[0], polygon[i - 1], polygon[i]
        la, lb, lc = np.sqrt(_dot(a, a)), np.sqrt(_dot(b, b)), np.sqrt(_dot(c, c))
        level = la * lb * lc + _dot(a, b) * lc + _dot(a, c) * lb + _dot(b, c) * la
        total += 2.0 * np.arctan2(_triple(a, b, c), level)
    return abs(total)
