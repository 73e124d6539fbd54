"""Pictures of one number a pixel that the fast paths of techniques look up, made on the CPU."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Floats32, Ints


def least_of_greatest(
    functions: Sequence[NDArray[np.float64]], size: tuple[int, int]
) -> NDArray[np.float32]:
    """(h, w) 1 / the least, over some sets, of the greatest of a set's linear functions (k, 3:
    column, row, constant) at the middle of each pixel. Sets that can be least nowhere are left
    out first."""
    width, height = size
    corners = np.array([[0, 0, 1], [width, 0, 1], [0, height, 1], [width, height, 1.0]])
    values = [corners @ f.T for f in functions]  # (4, k) each
    chosen: list[int] = []
    # A set is nowhere least if one of another's is at least each of its own at all corners.
    for a in np.argsort([v.max() for v in values], kind="stable"):
        if not any(_above(values[a], values[b]) for b in chosen):
            chosen.append(int(a))
    starts = np.cumsum([0, *(len(functions[a]) for a in chosen)])
    rows = np.concatenate([functions[a] for a in chosen])
    return _least_of_greatest(rows, starts, width, height)


def _above(a: NDArray[np.float64], b: NDArray[np.float64]) -> bool:
    """Whether for each of b's functions one of a's is at least as great at all corners."""
    return bool((a[:, :, None] >= b[:, None, :]).all(axis=0).any(axis=0).all())


@njit(cache=True)
def _least_of_greatest(rows: Floats, starts: Ints, width: int, height: int) -> Floats32:
    out = np.empty((height, width), np.float32)
    for r in range(height):
        least = np.full(width, np.inf)
        greatest = np.empty(width)
        for s in range(len(starts) - 1):
            greatest[:] = -np.inf
            for k in range(starts[s], starts[s + 1]):
                slope = rows[k, 0]
                level = rows[k, 1] * (r + 0.5) + rows[k, 2] + 0.5 * slope
                for c in range(width):
                    greatest[c] = max(greatest[c], level + slope * c)
            for c in range(width):
                least[c] = min(least[c], greatest[c])
        for c in range(width):
            out[r, c] = 1.0 / least[c]
    return out
