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
    starts = np.cumsum([0, *(len(f) for f in functions)])
    values = np.concatenate(functions) @ corners.T  # (rows, 4)
    greatest = np.maximum.reduceat(values.max(axis=1), starts[:-1])
    chosen = _undominated(values, starts, np.argsort(greatest, kind="stable"))
    kept = [functions[a] for a in chosen.tolist()]
    return _least_of_greatest(
        np.concatenate(kept), np.cumsum([0, *(len(f) for f in kept)]), width, height
    )


@njit(cache=True)
def _undominated(values: Floats, starts: Ints, order: Ints) -> Ints:
    """The sets, in order, that some pixel may have as its least: one is nowhere least if for each
    function of another, one of its own is at least as great at all corners of the picture."""
    chosen = np.empty(len(order), np.int64)
    count = 0
    for a in order:
        beaten = False
        for k in range(count):
            b = chosen[k]
            every = True
            for j in range(starts[b], starts[b + 1]):
                found = False
                for i in range(starts[a], starts[a + 1]):
                    above = True
                    for c in range(4):
                        above &= values[i, c] >= values[j, c]
                    if above:
                        found = True
                        break
                if not found:
                    every = False
                    break
            if every:
                beaten = True
                break
        if not beaten:
            chosen[count] = a
            count += 1
    return chosen[:count]


TILE = 32


@njit(cache=True)
def _least_of_greatest(rows: Floats, starts: Ints, width: int, height: int) -> Floats32:
    out = np.empty((height, width), np.float32)
    sets = len(starts) - 1
    low, high = np.empty(sets), np.empty(sets)
    kept = np.empty((len(rows), 3))
    for top in range(0, height, TILE):
        for left in range(0, width, TILE):
            bottom, right = min(top + TILE, height), min(left + TILE, width)
            # What the greatest of a set is at most and at least in the tile: at its corners.
            for s in range(sets):
                low[s], high[s] = -np.inf, -np.inf
                for k in range(starts[s], starts[s + 1]):
                    a, b, c = rows[k]
                    x0, x1, y0, y1 = a * left, a * right, b * top, b * bottom
                    low[s] = max(low[s], c + min(x0, x1) + min(y0, y1))
                    high[s] = max(high[s], c + max(x0, x1) + max(y0, y1))
            bound = high.min()
            for r in range(top, bottom):
                out[r, left:right] = np.inf
            for s in range(sets):
                if low[s] > bound:
                    continue
                count = 0
                for k in range(starts[s], starts[s + 1]):
                    a, b, c = rows[k]
                    if c + max(a * left, a * right) + max(b * top, b * bottom) >= low[s]:
                        kept[count] = rows[k]
                        count += 1
                for r in range(top, bottom):
                    for c in range(left, right):
                        greatest = -np.inf
                        for k in range(count):
                            value = kept[k, 0] * (c + 0.5) + kept[k, 1] * (r + 0.5) + kept[k, 2]
                            greatest = max(greatest, value)
                        out[r, c] = min(out[r, c], np.float32(greatest))
            for r in range(top, bottom):
                for c in range(left, right):
                    out[r, c] = np.float32(1.0) / out[r, c]
    return out
