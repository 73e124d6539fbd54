"""All points of a scene put where their objects stand: compiled, as few commands need it."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Ints


@njit(cache=True)
def all_moved(points: Floats, first: Ints, starts: Ints, matrices: Floats) -> Floats:
    """(starts[n], 3) points of n objects one after the other, each by its matrix (n, 4, 4): object
    i's are starts[i + 1] - starts[i] rows of `points` (p, 3), from row first[i] on."""
    out = np.empty((starts[-1], 3))
    for i in range(len(first)):
        matrix, row = matrices[i], first[i]
        for k in range(starts[i], starts[i + 1]):
            for axis in range(3):
                out[k, axis] = matrix[axis, 3]
                for c in range(3):
                    out[k, axis] += matrix[axis, c] * points[row, c]
            row += 1
    return out
