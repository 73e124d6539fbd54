"""Rectangles of the window put side by side into one texture."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Ints

WIDTH = 2048


@njit(cache=True)
def shelves(sizes: Ints, width: int) -> tuple[Ints, int]:
    """Corners (k, 2) of rectangles of these (k, 2) sizes in rows, tallest first, and the height.

    No rectangle may be wider than `width` or the widest of them, whichever is more.
    """
    corners = np.zeros((len(sizes), 2), np.int64)
    for k in range(len(sizes)):
        width = max(width, sizes[k, 0])
    x = y = row = 0
    for k in np.argsort(-sizes[:, 1], kind="mergesort"):
        w, h = sizes[k]
        if x + w > width:
            x, y, row = 0, y + row, 0
        corners[k, 0], corners[k, 1] = x, y
        x, row = x + w, max(row, h)
    return corners, y + row
