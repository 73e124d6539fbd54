"""On which side of a plane does a point lie? Exactly, or within the papers' tolerance.

A plane is kept as three corners of its *source* polygon, never as coefficients of a fragment:
fragments have rounded corners, and their own planes wander off (csg.js issue 11; a first version
of our BSP never ended on 8,000 triangles for that reason).

The determinant is evaluated in floating point, with the error bound of the first stage (A) of
ORIENT3D: Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
predicates", Discrete & Computational Geometry 18 (1997); `o3derrboundA` in its predicates.c.
Where the bound leaves the sign open, libigl's adaptive `orient3d` decides.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.polygons import Polygons, newell

# (7 + 56 eps) eps with eps = 2^-53: ORIENT3D's bound A, relative to the permanent.
ERROR_BOUND = (7.0 + 56.0 * 2.0**-53) * 2.0**-53
# What cut points and turned polygons lose to rounding, relative to their coordinates.
ROUNDING = 8 * 2.0**-52
FRONT, BACK, ON, UNDECIDED = 1, -1, 0, 2


def plane_corners(polygons: Polygons) -> Floats:
    """(m, 3, 3) three corners that span each polygon's plane best, turning as the polygon does.

    Of a polygon with more than three corners: the first, and the two that with it span the
    largest triangle. A polygon without area keeps three corners on one line.
    """
    first = polygons.starts[:-1]
    triples = np.stack([first, first + 1, first + 2], axis=1)
    larger = np.flatnonzero(polygons.counts > 3)
    normals = newell(polygons.take(larger)) if len(larger) else np.empty((0, 3))
    for index, normal in zip(larger, normals, strict=True):
        corners = polygons.corners(index)
        local = corners - corners[0]
        spans = np.cross(local[:, None], local[None]) @ normal
        i, j = np.unravel_index(np.argmax(spans), spans.shape)
        if spans[i, j] > 0:
            triples[index] = first[index] + np.array([0, i, j])
    return np.ascontiguousarray(polygons.vertices[triples])


def plane_rows(corners: Floats) -> Floats:
    """(m, 10) what the filter needs of planes (m, 3, 3): c, normal, its permanent, its length."""
    c = corners[:, 2]
    u, v = corners[:, 0] - c, corners[:, 1] - c
    forward = u[:, [1, 2, 0]] * v[:, [2, 0, 1]]
    backward = u[:, [2, 0, 1]] * v[:, [1, 2, 0]]
    normal = forward - backward
    length = np.linalg.norm(normal, axis=1)
    rows = np.concatenate([c, normal, np.abs(forward) + np.abs(backward), length[:, None]], axis=1)
    return np.ascontiguousarray(rows)


@numba.njit(inline="always")
def distance_row(plane: Floats, x: float, y: float, z: float) -> float:
    """Determinant of a point and a row of `plane_rows`: its distance times the normal's length."""
    return (x - plane[0]) * plane[3] + (y - plane[1]) * plane[4] + (z - plane[2]) * plane[5]


@numba.njit(inline="always")
def filtered_side(plane: Floats, x: float, y: float, z: float, slack: float) -> int:
    """FRONT, BACK or UNDECIDED; ON only within a positive `slack` (a distance, world units)."""
    dx, dy, dz = x - plane[0], y - plane[1], z - plane[2]
    determinant = dx * plane[3] + dy * plane[4] + dz * plane[5]
    bound = ERROR_BOUND * (abs(dx) * plane[6] + abs(dy) * plane[7] + abs(dz) * plane[8])
    height, reach = abs(determinant), slack * plane[9]
    if height > bound and height > reach:
        return 1 if determinant > 0.0 else -1
    if slack > 0.0 and height + bound <= reach:
        return 0
    return 2


@numba.njit(inline="always")
def loop_heights(plane: Floats, rows: Floats, first: int, end: int) -> tuple[float, float, float]:
    """Least and greatest determinant of the rows first to end, and their largest coordinate."""
    low, high, far = np.inf, -np.inf, 0.0
    for v in range(first, end):
        x, y, z = rows[v, 0], rows[v, 1], rows[v, 2]
        height = distance_row(plane, x, y, z)
        low, high = min(low, height), max(high, height)
        far = max(far, abs(x), abs(y), abs(z))
    return low, high, far


@numba.njit(inline="always")
def loop_limit(plane: Floats, far: float, slack: float) -> float:
    """Beyond this determinant a corner is off the plane, cut points with their rounding too.

    A coarser bound than `filtered_side`'s, the same for all corners within `far` of the origin:
    what it leaves open is for the finer one.
    """
    away = far + max(abs(plane[0]), abs(plane[1]), abs(plane[2]))
    permanent = plane[6] + plane[7] + plane[8]
    return away * (ERROR_BOUND * permanent + ROUNDING * plane[9]) + slack * plane[9]


def exact_sides(corners: Floats, points: Floats) -> NDArray[np.int8]:
    """(n,) FRONT, BACK or ON of points (n, 3) against planes (n, 3, 3): exact for any float64.

    Exact unless a product of three coordinates under- or overflows (below 1e-100, above 1e90).
    """
    a, b, c = (np.ascontiguousarray(corners[:, i]) for i in range(3))
    # Few programs come this far, and loading it takes every one of them a quarter of a second.
    from igl import predicates as igl_predicates

    # libigl counts a point above the counter-clockwise side as negative.
    return (-igl_predicates.orient3d(a, b, c, np.ascontiguousarray(points))).astype(np.int8)


def has_area(corners: Floats) -> NDArray[np.bool_]:
    """(m,) whether planes (m, 3, 3) are planes at all: exact, by the three axis projections."""
    rows = plane_rows(corners)
    spread = np.any(np.abs(rows[:, 3:6]) > 2 * ERROR_BOUND * rows[:, 6:9], axis=1)
    doubtful = np.flatnonzero(~spread)
    for axis in range(3):
        # Flattened along an axis, the corners turn iff a point above their plane is off it.
        flat = corners[doubtful]
        flat[:, :, axis] = 0.0
        above = np.zeros((len(flat), 3))
        above[:, axis] = 1.0
        spread[doubtful] |= exact_sides(flat, above) != ON
    return spread


def sides(corners: Floats, points: Floats, slack: Floats | float = 0.0) -> NDArray[np.int8]:
    """(n,) sides of points (n, 3) against planes (n, 3, 3).

    Points within `slack`, (n,) or one distance, of a plane count as on it.
    """
    rows = plane_rows(corners)
    reach = np.broadcast_to(np.asarray(slack, float), len(points)) * rows[:, 9]
    height = np.abs(((points - rows[:, :3]) * rows[:, 3:6]).sum(axis=1))
    result = exact_sides(corners, points)
    result[(height <= reach) & (reach > 0)] = ON
    return result


def point_slacks(points: Floats) -> Floats:
    """(n,) what rounding cut points (n, 3) costs: distances."""
    return ROUNDING * np.abs(points).max(axis=1)


def thickness(polygons: Polygons, corners: Floats) -> Floats:
    """(m,) how far off its plane a polygon's own corners may lie: 0 where they lie in it exactly.

    A polygon of four corners that was turned or scaled is no longer exactly flat, and a neighbour
    that shares its fourth corner would count as cut by it.
    """
    result = np.zeros(len(polygons))
    larger = np.flatnonzero(polygons.counts > 3)
    if len(larger):
        some = polygons.take(larger)
        own = np.repeat(corners[larger], some.counts, axis=0)
        uneven = np.logical_or.reduceat(exact_sides(own, some.vertices) != ON, some.starts[:-1])
        scale = np.maximum.reduceat(np.abs(some.vertices).max(axis=1), some.starts[:-1])
        result[larger] = np.where(uneven, ROUNDING * scale, 0.0)
    return result


def paper_sides(
    corners: Floats, points: Floats, tolerance: float = 1e-3, dtype: type[np.floating] = np.float32
) -> NDArray[np.int8]:
    """The side test as LabBSP2010 writes it: (x - p) · n against a fixed threshold.

    Kept as the negative control: in float32 at coordinates of 10⁶ a polygon's own corners fail
    it. `corners` (n, 3, 3), `points` (n, 3).
    """
    planes, at = corners.astype(dtype), points.astype(dtype)
    normal = np.cross(planes[:, 1] - planes[:, 0], planes[:, 2] - planes[:, 0]).astype(dtype)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    unit = normal / np.where(length > 0, length, dtype(1))
    offset = (unit * planes[:, 0]).sum(axis=1, dtype=dtype)
    distance = (unit * at).sum(axis=1, dtype=dtype) - offset
    return np.where(np.abs(distance) <= tolerance, 0, np.sign(distance)).astype(np.int8)


def plane_ids(polygons: Polygons, corners: Floats, slack: Floats) -> Whole:
    """(m,) a number for each distinct plane, whichever way a polygon faces.

    Two polygons share a number only if every corner of one lies in the other's plane: exactly,
    or within the larger of their `slack` (m,), see `thickness`.
    Candidates are found by rounded coefficients, so two coplanar polygons may still end up with
    different numbers when rounding parts them: that costs tests, never an order. A polygon
    without area is alone in its plane.
    """
    ids = np.arange(len(polygons))
    waiting = np.flatnonzero(has_area(corners))
    _, group = np.unique(_rounded_planes(corners), return_inverse=True)
    while len(waiting):
        _, where, counts = np.unique(group[waiting], return_index=True, return_counts=True)
        chief = np.zeros(len(group), np.int64)
        chief[group[waiting[where]]] = waiting[where]
        shared = np.zeros(len(group), bool)
        shared[group[waiting[where]]] = counts > 1
        waiting = waiting[shared[group[waiting]]]
        leader = chief[group[waiting]]
        rows = polygons.take(waiting)
        thick = np.repeat(np.maximum(slack[leader], slack[waiting]), rows.counts)
        on = sides(corners[np.repeat(leader, rows.counts)], rows.vertices, thick) == ON
        same = leader == waiting
        if len(waiting):
            same |= np.logical_and.reduceat(on, rows.starts[:-1])
        ids[waiting[same]] = leader[same]
        waiting = waiting[~same]
    return ids


def _rounded_planes(corners: Floats) -> Whole:
    """(m,) hashes of coefficients rounded to six digits, facing one way."""
    normal = plane_rows(corners)[:, 3:6]
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    unit = normal / np.where(length > 0, length, 1.0)
    offset = (unit * corners[:, 0]).sum(axis=1)
    scale = max(float(np.abs(corners).max(initial=0.0)), 1e-300)
    keys = np.round(np.column_stack([unit, offset / scale]) * 1e6).astype(np.int64)
    lead = keys[np.arange(len(keys)), np.argmax(np.abs(keys[:, :3]) > 5e5, axis=1)]
    keys = np.where(lead[:, None] < 0, -keys, keys)
    return keys @ np.array([1, 1_000_003, 1_000_033_000_099, 998_244_353_000_007])
