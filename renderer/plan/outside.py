"""What lies outside all masks: large objects are drawn opaque there, which is cheaper than to blend
all their pixels."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Ints

WORTH = 64  # pixels to save by drawing a triangle once more


@njit(cache=True)
def holes(reach: Floats, masked: Ints, size: tuple[int, int]) -> Ints:
    """(k, 4) whole pixels that the masks of `masked` (m,) can cover, by their reach (n, 4)."""
    rows, k = np.empty((len(masked), 4), np.int64), 0
    for t in masked:
        left, top = max(np.floor(reach[t, 0]), 0.0), max(np.floor(reach[t, 1]), 0.0)
        right, bottom = min(np.ceil(reach[t, 2]), size[0]), min(np.ceil(reach[t, 3]), size[1])
        if left < right and top < bottom:
            rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = left, top, right, bottom
            k += 1
    return rows[:k]


@njit(cache=True)
def wide(
    extents: Floats, blended: Ints, around: Ints, triangles: Ints, size: tuple[int, int]
) -> Ints:
    """Blended objects of few triangles (n,) that cover much of the picture outside all holes.

    Drawing them twice costs little, blending all their pixels much.
    """
    found, k = np.empty(len(blended), np.int64), 0
    if not len(around):
        return found[:0]
    left, top = around[:, 0].min(), around[:, 1].min()
    right, bottom = around[:, 2].max(), around[:, 3].max()
    for i in blended:
        x0, y0 = max(extents[i, 0], 0.0), max(extents[i, 1], 0.0)
        x1, y1 = min(extents[i, 2], size[0]), min(extents[i, 3], size[1])
        inside = max(min(x1, right) - max(x0, left), 0) * max(min(y1, bottom) - max(y0, top), 0)
        if max(x1 - x0, 0) * max(y1 - y0, 0) - inside > WORTH * triangles[i]:
            found[k] = i
            k += 1
    return found[:k]
