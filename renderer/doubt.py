"""Where the order of objects is in doubt, which of that is sorted by pixel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer import blocks

RAMP = 4  # from this many times the doubt allowed on, none is left


def union(boxes: NDArray[np.float64], size: tuple[int, int]) -> int:
    """Pixels that (k, 4) boxes cover together, to two pixels at their borders."""
    fine = boxes * (blocks.BLOCK / 2)
    shape = (size[1] // 2 + 1, size[0] // 2 + 1)
    none = np.zeros(len(boxes), np.int64)
    return int((blocks.covered(fine, none, shape) != 0).sum()) * 4


def chosen(boxes: NDArray[np.float64], size: tuple[int, int], share: float) -> NDArray[np.float64]:
    """Those of (k, 4) boxes to sort by pixel: the largest, until what is left is allowed.

    That is `share` of the picture as long as all boxes together make up no more, then less and
    less: what is sorted grows with the doubt, and a frame's time with it, instead of at once.
    """
    allowed, total = share * size[0] * size[1], union(boxes, size)
    if total <= allowed:
        return boxes[:0]
    left = allowed - (total - allowed) / (RAMP - 1)
    area = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
    rank = np.argsort(area, kind="stable")
    return boxes[rank[np.cumsum(area[rank]) > left]]
