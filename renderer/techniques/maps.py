"""Pictures of one number a pixel that the fast paths of techniques look up, made on the CPU."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Floats32, Ints

TILE = 128, 16  # columns and rows: rows as long as this are worked through several at once


def least_of_greatest(
    rows: Floats, starts: Ints, size: tuple[int, int], part: tuple[int, int, int, int]
) -> NDArray[np.float32]:
    """(h, w), 0 beside the `part` (left, top, right, bottom), else 1 / the least, over some sets,
    of the greatest of a set's linear functions at the middle of each pixel. Set k has the `rows`
    (m, 3: column, row, constant) from starts[k] (n + 1,) to starts[k + 1]. Sets that can be least
    nowhere are left out first. To 10⁻⁶ of itself."""
    left, top, right, bottom = part
    corners = np.array([[left, top, 1], [right, top, 1], [left, bottom, 1], [right, bottom, 1.0]])
    values = rows @ corners.T  # (m, 4)
    greatest = np.maximum.reduceat(values.max(axis=1), starts[:-1])
    chosen = _undominated(values, starts, np.argsort(greatest, kind="stable"))
    found = np.zeros((size[1], size[0]), np.float32)
    _least_of_greatest(rows, starts, chosen, part, found)
    return found


@njit(cache=True)
def _undominated(values: Floats, starts: Ints, order: Ints) -> Ints:
    """The sets, in order, that some pixel may have as its least: one is nowhere least if for each
    function of another, one of its own is at least as great at all four corners."""
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


@njit(cache=True)
def _least_of_greatest(
    rows: Floats, starts: Ints, chosen: Ints, part: tuple[int, int, int, int], out: Floats32
) -> None:
    across = (np.arange(TILE[0]) + 0.5).astype(np.float32)
    greatest = np.empty(TILE[0], np.float32)
    for top in range(part[1], part[3], TILE[1]):
        for left in range(part[0], part[2], TILE[0]):
            bottom, right = min(top + TILE[1], part[3]), min(left + TILE[0], part[2])
            kept, begins = _deciding(rows, starts, chosen, (left, top, right, bottom))
            for r in range(top, bottom):
                line = out[r, left:right]
                for i in range(len(begins) - 1):
                    for k in range(begins[i], begins[i + 1]):
                        base = np.float32(kept[k, 0] * left + kept[k, 1] * (r + 0.5) + kept[k, 2])
                        step = np.float32(kept[k, 0])
                        first = k == begins[i]
                        for x in range(len(line)):
                            value = base + step * across[x]
                            greatest[x] = value if first or value > greatest[x] else greatest[x]
                    for x in range(len(line)):
                        line[x] = greatest[x] if i == 0 or greatest[x] < line[x] else line[x]
                for x in range(len(line)):
                    line[x] = np.float32(1.0) / line[x]


@njit(cache=True)
def _deciding(
    rows: Floats, starts: Ints, chosen: Ints, box: tuple[int, int, int, int]
) -> tuple[Floats, Ints]:
    """The rows, and where each set of them begins, that may decide within a rectangle of the
    picture: by the bounds of each at its corners."""
    left, top, right, bottom = box
    low, bound = np.full(len(chosen), -np.inf), np.inf
    for i in range(len(chosen)):
        high = -np.inf
        for k in range(starts[chosen[i]], starts[chosen[i] + 1]):
            a, b, c = rows[k, 0], rows[k, 1], rows[k, 2]
            low[i] = max(low[i], c + min(a * left, a * right) + min(b * top, b * bottom))
            high = max(high, c + max(a * left, a * right) + max(b * top, b * bottom))
        bound = min(bound, high)
    kept, begins = np.empty((len(rows), 3)), np.zeros(len(chosen) + 1, np.int64)
    sets, count = 0, 0
    for i in range(len(chosen)):
        if low[i] > bound:
            continue
        for k in range(starts[chosen[i]], starts[chosen[i] + 1]):
            a, b, c = rows[k, 0], rows[k, 1], rows[k, 2]
            if c + max(a * left, a * right) + max(b * top, b * bottom) >= low[i]:
                kept[count] = rows[k]
                count += 1
        sets += 1
        begins[sets] = count
    return kept[:count], begins[: sets + 1]


BLOCK = 16  # pixels of a picture that are looked at together


@njit(cache=True)
def block_bounds(picture: Floats32, extents: Floats) -> tuple[Floats, Floats]:
    """The least and the greatest (rows, columns) of each block of a (h, w) picture, in the rows and
    columns of blocks that any of its parts (k, 4: left, top, right, bottom in pixels) reaches; of
    others ∞ and −∞."""
    height, width = picture.shape
    rows, columns = (height + BLOCK - 1) // BLOCK, (width + BLOCK - 1) // BLOCK
    low, high = np.full((rows, columns), np.inf), np.full((rows, columns), -np.inf)
    first, last, left, right = rows, 0, columns, 0
    for k in range(len(extents)):
        first = min(first, int(min(max(extents[k, 1] - 1, 0.0), height)) // BLOCK)
        last = max(last, int(max(min(extents[k, 3] + 1, height - 1.0), -1.0)) // BLOCK + 1)
        left = min(left, int(min(max(extents[k, 0] - 1, 0.0), width)) // BLOCK)
        right = max(right, int(max(min(extents[k, 2] + 1, width - 1.0), -1.0)) // BLOCK + 1)
    begin, end = left * BLOCK, min(right * BLOCK, width)
    for i in range(first, last):
        least = picture[i * BLOCK, begin:end].copy()
        most = least.copy()
        for r in range(i * BLOCK + 1, min(i * BLOCK + BLOCK, height)):
            row = picture[r, begin:end]
            for c in range(len(row)):
                value = row[c]
                least[c] = value if value < least[c] else least[c]
                most[c] = value if value > most[c] else most[c]
        for c in range(len(least)):
            j = left + c // BLOCK
            low[i, j], high[i, j] = min(low[i, j], least[c]), max(high[i, j], most[c])
    return low, high


@njit(cache=True)
def bounds(picture: Floats32, extents: Floats) -> Floats:
    """(k, 2) the least and the greatest of a (h, w) picture within parts of it (k, 4: left, top,
    right, bottom in pixels), or in a little more; of parts outside it −∞ and ∞."""
    height, width = picture.shape
    low, high = block_bounds(picture, extents)
    found = np.empty((len(extents), 2))
    for k in range(len(extents)):
        left, right = max(extents[k, 0] - 1, 0.0), min(extents[k, 2] + 1, width - 1.0)
        top, bottom = max(extents[k, 1] - 1, 0.0), min(extents[k, 3] + 1, height - 1.0)
        found[k, 0], found[k, 1] = -np.inf, np.inf
        if left <= right and top <= bottom:
            a, b = int(top) // BLOCK, int(bottom) // BLOCK + 1
            c, d = int(left) // BLOCK, int(right) // BLOCK + 1
            found[k, 0], found[k, 1] = low[a:b, c:d].min(), high[a:b, c:d].max()
    return found
