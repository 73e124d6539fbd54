"""Rectangles of the window put side by side into one texture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

WIDTH = 2048


def shelves(sizes: NDArray[np.int64], width: int = WIDTH) -> tuple[NDArray[np.int64], int]:
    """Corners (k, 2) of rectangles of these (k, 2) sizes in rows, tallest first, and the height.

    No rectangle may be wider than `width` or the widest of them, whichever is more.
    """
    corners = np.zeros((len(sizes), 2), np.int64)
    width = max(width, int(sizes[:, 0].max(initial=0)))
    x = y = row = 0
    for k in np.argsort(-sizes[:, 1], kind="stable").tolist():
        w, h = int(sizes[k, 0]), int(sizes[k, 1])
        if x + w > width:
            x, y, row = 0, y + row, 0
        corners[k] = x, y
        x, row = x + w, max(row, h)
    return corners, y + row
