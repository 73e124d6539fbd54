"""A draw order from relations between pairs, and what to do about circles."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from renderer.ordering.polygons import Floats, Integers


def draw_order(
    relations: NDArray[np.int8], corners: Floats, point: Floats
) -> tuple[Integers, Integers, tuple[tuple[int, ...], ...], tuple[tuple[int, int], ...]]:
    """Objects from back to front, their layers, the circles, and the relations given up.

    `relations` (b, b): 1 where i is in front of j, 2 where j is in front of i (i < j).
    """
    cycles: list[tuple[int, ...]] = []
    broken: list[tuple[int, int]] = []
    while True:
        objects, layers, left = _peel(relations)
        if not left.any():
            return objects, layers, tuple(cycles), tuple(broken)
        # Objects behind a circle are left over too: only what is in one is reported.
        for circle in _circles(relations, left):
            if not broken:
                cycles.append(circle)
            back, front = _least_overlap(relations, circle, corners, point)
            relations[min(back, front), max(back, front)] = 0
            broken.append((back, front))


@numba.njit(cache=True)
def _peel(relations):
    """Draw what has nothing left behind it, again and again.

    Returns the objects in order, the layer of each (one more than the highest behind it), and
    which could not be drawn.
    """
    n = len(relations)
    behind = np.zeros(n, np.int64)
    for i in range(n):
        for j in range(i + 1, n):
            if relations[i, j] == 1:
                behind[i] += 1
            elif relations[i, j] == 2:
                behind[j] += 1
    objects = np.empty(n, np.int64)
    layers = np.zeros(n, np.int64)
    left = np.ones(n, np.bool_)
    filled = 0
    for i in range(n):
        if behind[i] == 0:
            objects[filled] = i
            filled += 1
    done = 0
    while done < filled:
        back = objects[done]
        done += 1
        left[back] = False
        for other in range(n):
            low, high = min(back, other), max(back, other)
            if relations[low, high] == (2 if low == back else 1):
                layers[other] = max(layers[other], layers[back] + 1)
                behind[other] -= 1
                if behind[other] == 0:
                    objects[filled] = other
                    filled += 1
    return objects[:filled], layers, left


def _circles(relations: NDArray[np.int8], left: NDArray[np.bool_]) -> list[tuple[int, ...]]:
    """Strongly connected sets of two or more objects."""
    i, j = np.nonzero(relations)
    first = relations[i, j] == 1
    graph = csr_array(
        (np.ones(len(i)), (np.where(first, j, i), np.where(first, i, j))), shape=relations.shape
    )
    _, labels = connected_components(graph, directed=True, connection="strong")
    members = [np.flatnonzero((labels == k) & left) for k in np.unique(labels[left])]
    return [tuple(int(m) for m in group) for group in members if len(group) > 1]


def _least_overlap(
    relations: NDArray[np.int8], circle: tuple[int, ...], corners: Floats, point: Floats
) -> tuple[int, int]:
    """(behind, front) of the relation in a circle whose contours share least."""
    best = None
    for a, i in enumerate(circle):
        for j in circle[a + 1 :]:
            if relations[i, j]:
                shared = overlap_area(corners[i], corners[j], point)
                if best is None or shared < best[0]:
                    best = (shared, (j, i) if relations[i, j] == 1 else (i, j))
    return best[1]


def overlap_area(first: Floats, second: Floats, point: Floats) -> float:
    """Area that two boxes' (8, 3) pictures share, on the plane across the way to their middle."""
    middle = (first.mean(axis=0) + second.mean(axis=0)) / 2
    way = middle - point[:3] if point[3] else -point[:3]
    way = way / np.linalg.norm(way)
    side = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
    side /= np.linalg.norm(side)
    frame = np.stack([side, np.cross(way, side)], axis=1)
    flat = []
    for corners in (first, second):
        away = corners - point[:3] * point[3]
        depth = away @ way if point[3] else np.ones(8)
        flat.append(away @ frame / np.maximum(depth, 1e-9)[:, None])
    try:
        halfspaces = np.concatenate([ConvexHull(p).equations for p in flat])
        inside = _inner_point(halfspaces)
        if inside is None:
            return 0.0
        return float(ConvexHull(HalfspaceIntersection(halfspaces, inside).intersections).volume)
    except QhullError:
        return 0.0


def _inner_point(halfspaces: Floats) -> Floats | None:
    """A point well inside halfspaces (n, 3), or None: the centre of the largest circle."""
    from scipy.optimize import linprog

    found = linprog(
        [0, 0, -1],
        A_ub=np.column_stack([halfspaces[:, :2], np.ones(len(halfspaces))]),
        b_ub=-halfspaces[:, 2],
        bounds=[(None, None), (None, None), (0, None)],
    )
    return found.x[:2] if found.success and found.x[2] > 1e-12 else None
