"""Where the order of objects is in doubt, which of that is sorted by pixel."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats

RAMP = 4  # from this many times the doubt allowed on, none is left


@njit(cache=True)
def union(boxes: Floats) -> float:
    """The area that (k, 4) boxes cover together: strip by strip between their sides."""
    n = len(boxes)
    xs = np.sort(np.concatenate((boxes[:, 0], boxes[:, 2])))
    rows = boxes[np.argsort(boxes[:, 1])]
    total = 0.0
    for s in range(2 * n - 1):
        left, right = xs[s], xs[s + 1]
        if right <= left:
            continue
        covered, bottom = 0.0, -np.inf
        for i in range(n):
            if rows[i, 0] <= left and rows[i, 2] >= right and rows[i, 3] > bottom:
                covered += rows[i, 3] - max(rows[i, 1], bottom)
                bottom = rows[i, 3]
        total += covered * (right - left)
    return total


def chosen(boxes: NDArray[np.float64], size: tuple[int, int], share: float) -> NDArray[np.float64]:
    """Those of (k, 4) boxes to sort by pixel: the largest, until what is left is allowed.

    That is `share` of the picture as long as all boxes together make up no more, then less and
    less: what is sorted grows with the doubt, and a frame's time with it, instead of at once.
    """
    allowed = share * size[0] * size[1]
    area = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
    if area.sum() <= allowed:  # together they are no more than that
        return boxes[:0]
    total = union(boxes)
    if total <= allowed:
        return boxes[:0]
    left = allowed - (total - allowed) / (RAMP - 1)
    rank = np.argsort(area, kind="stable")
    return boxes[rank[np.cumsum(area[rank]) > left]]
