"""A draw order from relations between pairs, and what to do about circles."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from seethrough.renderer.arrays import Bools, Floats, Ints, Whole

# (p,) how much of the view the first and the second objects (p,) of pairs share.
Shared = Callable[[Whole, Whole], Floats]
# Circles of more objects than this are not untied one relation at a time.
LARGE = 64


def draw_order(
    relations: Whole, corners: Floats, point: Floats, shared: Shared
) -> tuple[Whole, Whole, tuple[tuple[int, ...], ...], tuple[tuple[int, int], ...]]:
    """Objects from back to front, their layers, the circles, and the relations given up.

    `relations` (b, b): 1 where i is in front of j, 2 where j is in front of i (i < j). `shared`
    gives how much of the view pairs share.
    """
    cycles: list[tuple[int, ...]] = []
    broken: list[tuple[int, int]] = []
    while True:
        objects, layers, left = _peel(relations)
        if not left.any():
            return objects, layers, tuple(cycles), tuple(broken)
        # Objects in front of a circle are left over too: only what is in one is reported.
        first = not cycles
        for circle in _circles(relations, left):
            if first:
                cycles.append(circle)
            for back, front in _given_up(relations, circle, corners, point, shared):
                relations[min(back, front), max(back, front)] = 0
                broken.append((back, front))


@numba.njit(cache=True)
def _peel(relations: Whole) -> tuple[Ints, Ints, Bools]:
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


def _circles(relations: Whole, left: NDArray[np.bool_]) -> list[tuple[int, ...]]:
    """Strongly connected sets of two or more objects."""
    i, j = np.nonzero(relations)
    first = relations[i, j] == 1
    graph = csr_array(
        (np.ones(len(i)), (np.where(first, j, i), np.where(first, i, j))), shape=relations.shape
    )
    _, labels = connected_components(graph, directed=True, connection="strong")
    members = [np.flatnonzero((labels == k) & left) for k in np.unique(labels[left])]
    return [tuple(int(m) for m in group) for group in members if len(group) > 1]


def _given_up(
    relations: Whole,
    circle: tuple[int, ...],
    corners: Floats,
    point: Floats,
    shared: Shared,
) -> list[tuple[int, int]]:
    """(behind, front) of what a circle must lose: the pair that shares least of the view.

    A large circle loses all that the order of its nearest corners contradicts.
    """
    members = np.array(circle)
    i, j = (members[k] for k in np.nonzero(relations[np.ix_(members, members)]))
    back = np.where(relations[i, j] == 1, j, i)
    front = i + j - back
    if len(circle) <= LARGE:
        least = int(np.argmin(shared(i, j)))
        return [(int(back[least]), int(front[least]))]
    away = corners - point[:3]
    near = (away**2).sum(axis=2).min(axis=1) if point[3] else (-corners @ point[:3]).min(axis=1)
    wrong = (near[front] > near[back]) | ((near[front] == near[back]) & (front > back))
    return list(zip(back[wrong].tolist(), front[wrong].tolist(), strict=True))
