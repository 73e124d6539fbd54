"""Rectangles of masks that are looked up, and where in one texture each finds its picture."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Floats32, Ints
from seethrough.renderer.gpu.device.tiles import WIDTH, shelves
from seethrough.renderer.plan.blocks import BLOCK

VERTEX = 7  # place x, y; offset x, y; kind; an edge's length, semi-axes, or the way to the tile

_CORNERS = np.array([[0, 1], [2, 1], [2, 3], [0, 1], [2, 3], [0, 3]])


@njit(cache=True)
def tiled(reach: Floats, pictured: Ints, size: tuple[int, int]) -> tuple[Ints, Ints, int, Bools]:
    """Tiles (n, 4), shifts (n, 2) and the texture's height (MaskGeometry) for the blocks that the
    masks of `pictured` (k,) can cover by their reach (n, 4), and whether that is nothing (k,)."""
    tile, shift = np.zeros((len(reach), 4), np.int64), np.zeros((len(reach), 2), np.int64)
    low, extent = np.empty((len(pictured), 2), np.int64), np.empty((len(pictured), 2), np.int64)
    empty = np.empty(len(pictured), np.bool_)
    for k in range(len(pictured)):
        for axis in range(2):
            begin, end = reach[pictured[k], axis], reach[pictured[k], 2 + axis]
            # What lies behind the eye reaches from ∞ to −∞.
            first = min(max(np.floor(begin / BLOCK) * BLOCK, 0.0), size[axis])
            # As blocks.covered has it: a reach that ends with a block touches the next one.
            last = min(max((np.floor(end / BLOCK) + 1) * BLOCK, 0.0), size[axis])
            low[k, axis], extent[k, axis] = int(first), max(int(last) - int(first), 0)
        empty[k] = extent[k, 0] == 0 or extent[k, 1] == 0
    corners, height = shelves(extent, WIDTH)
    for k in range(len(pictured)):
        t = pictured[k]
        tile[t, 0], tile[t, 1] = corners[k, 0], corners[k, 1]
        tile[t, 2], tile[t, 3] = corners[k, 0] + extent[k, 0], corners[k, 1] + extent[k, 1]
        shift[t, 0] = corners[k, 0] - low[k, 0]
        shift[t, 1] = corners[k, 1] - (size[1] - low[k, 1] - extent[k, 1])
    return tile, shift, height, empty


@njit(cache=True)
def rectangles(
    reach: Floats, pictured: Ints, empty: Bools, shift: Ints, size: tuple[int, int]
) -> Floats32:
    """(6 k, 7) two triangles over what each mask can cover, that look up its tile; of those that
    are not empty the first is said to be number 0."""
    rows, number = np.zeros((6 * len(pictured), VERTEX), np.float32), -1
    box = np.empty(4)
    for k in range(len(pictured)):
        t = pictured[k]
        number += not empty[k]
        for side in range(4):
            end = min(max(reach[t, side], 0.0), size[side % 2])
            box[side] = np.floor(end) if side < 2 else np.ceil(end)
        for c in range(6):
            row = rows[6 * k + c]
            row[0], row[1] = box[_CORNERS[c, 0]], box[_CORNERS[c, 1]]
            row[4], row[5], row[6] = number, shift[t, 0], shift[t, 1]
    return rows
