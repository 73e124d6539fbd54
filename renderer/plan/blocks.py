"""Blocks of pixels: which objects and masks can show in them, so that no pixel asks them all."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bits, Bools, Floats, Ints, Real, Whole

NONE = 0xFFFFFFFF  # a word for no cell, or no target
BLOCK = 8  # pixels, on each side: also in shaders/block.vert and few.vert


def whole(size: tuple[int, int]) -> tuple[int, int]:
    """Width and height of a picture in pixels, rounded up to whole blocks."""
    return (-(-size[0] // BLOCK) * BLOCK, -(-size[1] // BLOCK) * BLOCK)


def shape(size: tuple[int, int]) -> tuple[int, int]:
    """Rows and columns of blocks that hold a picture of `size` (width, height) in pixels."""
    return (-(-size[1] // BLOCK), -(-size[0] // BLOCK))


@njit(cache=True, nogil=True)
def mark(distance: Real, left: int, top: int, width: float, number: int, bits: Bits) -> None:
    """Set bit `number` of the blocks in which any of the (h, w) distances is within a mask's
    `width`; `left` and `top` are where they lie in the window."""
    bit, (rows, columns) = np.uint64(1) << np.uint64(number), distance.shape
    for row in range(rows):
        line, begin = (top + row) // BLOCK, 0
        while begin < columns:  # block by block: most are known by their first rows
            block = (left + begin) // BLOCK
            end = min(columns, (block + 1) * BLOCK - left)
            if bits[line, block] & bit == 0:
                for column in range(begin, end):
                    if distance[row, column] <= width:
                        bits[line, block] |= bit
                        break
            begin = end


@njit(cache=True)
def covered(boxes: Floats, numbers: Ints, shape: tuple[int, int]) -> Bits:
    """(shape) bits: of each block, the `numbers` (n,) of the boxes (n, 4), in pixels, that touch
    it. Numbers lie below 64."""
    bits = np.zeros(shape, np.uint64)
    for i in range(len(boxes)):
        left, top = max(boxes[i, 0] // BLOCK, 0.0), max(boxes[i, 1] // BLOCK, 0.0)
        right = min(np.floor(boxes[i, 2] / BLOCK) + 1, float(shape[1]))
        bottom = min(np.floor(boxes[i, 3] / BLOCK) + 1, float(shape[0]))
        bit = np.uint64(1) << np.uint64(numbers[i])
        for row in range(int(top), int(max(bottom, 0.0))):
            for column in range(int(left), int(max(right, 0.0))):
                bits[row, column] |= bit
    return bits


@njit(cache=True)
def runs(objects: Bits, masks: Bits, part: Ints) -> tuple[Ints, Bits]:
    """(k, 4) left, top, right, bottom in pixels of the rectangles into which a part falls, and
    (k, 2) the bits of `objects` and of `masks` that its blocks share; none without objects."""
    left, top, right, bottom = part[0] // BLOCK, part[1] // BLOCK, part[2], part[3]
    right, bottom = (right + BLOCK - 1) // BLOCK, (bottom + BLOCK - 1) // BLOCK
    most = (bottom - top) * (right - left)
    found, bits = np.empty((most, 4), np.int64), np.empty((most, 2), np.uint64)
    above = np.full(objects.shape[1] + 1, -1, np.int64)  # the rectangle that begins in a column
    k = 0
    for row in range(top, bottom):
        column = left
        while column < right:
            begin, a, b = column, objects[row, column], masks[row, column]
            while column < right and objects[row, column] == a and masks[row, column] == b:
                column += 1
            old = above[begin]
            for c in range(begin, column):
                above[c] = -1
            if a == 0:
                continue
            if old >= 0 and found[old, 2] == column and bits[old, 0] == a and bits[old, 1] == b:
                found[old, 3] = row + 1
            else:
                old = k
                found[k, 0], found[k, 1], found[k, 2], found[k, 3] = begin, row, column, row + 1
                bits[k, 0], bits[k, 1] = a, b
                k += 1
            above[begin] = old
    return found[:k] * BLOCK, bits[:k]


@njit(cache=True)
def shown(objects: Bits, masks: Bits, part: Ints) -> tuple[Ints, Bits]:
    """(k, 2) left and top in pixels of each of a part's blocks that holds an object, and (k, 2) the
    bits of `objects` and of `masks` in it."""
    left, top = part[0] // BLOCK, part[1] // BLOCK
    right = min((part[2] + BLOCK - 1) // BLOCK, objects.shape[1])
    bottom = min((part[3] + BLOCK - 1) // BLOCK, objects.shape[0])
    most = max(bottom - top, 0) * max(right - left, 0)
    found, bits = np.empty((most, 2), np.int64), np.empty((most, 2), np.uint64)
    k = 0
    for row in range(top, bottom):
        for column in range(left, right):
            if objects[row, column] != 0:
                found[k, 0], found[k, 1] = BLOCK * column, BLOCK * row
                bits[k, 0], bits[k, 1] = objects[row, column], masks[row, column]
                k += 1
    return found[:k], bits[:k]


@njit(cache=True)
def _count(bits: np.uint64) -> int:
    count = 0
    while bits != 0:
        bits &= bits - np.uint64(1)
        count += 1
    return count


@njit(cache=True)
def most(slices: Bits, masks: Bits) -> Ints:
    """The most bits of `slices` (h, w) and of `masks` (h, w) in any block that has both."""
    found = np.zeros(2, np.int64)
    for row in range(slices.shape[0]):
        for column in range(slices.shape[1]):
            if slices[row, column] != 0 and masks[row, column] != 0:
                found[0] = max(found[0], _count(slices[row, column]))
                found[1] = max(found[1], _count(masks[row, column]))
    return found


@njit(cache=True)
def grouped(
    found: Ints,
    which: Bits,
    corners: Whole,
    words: Whole,
    slices: Ints,
    masks: Ints,
    every: bool,
    together: int = 0,
) -> tuple[NDArray[np.uint32], Ints, Bools]:
    """Blocks (k, 2) with their bits (k, 2), as `shown` gives them, grouped by how many bits they
    have of both kinds: the least of `slices` and of `masks` (ascending) that is enough. No more
    than `together` blocks are one group, of what is enough for all.

    Returns for each block that has not too many, and a mask unless `every` is wanted, a row of
    words: left and top as float32; for each of its slices the word in `corners` (s,), then as many
    as the last of `slices` says in all; and three times the same for masks, from a column of
    `words` (m + 1, 3), whose last row is for none. Then the first row of each group and their
    number, and of which blocks there were too many (k,).
    """
    groups, most = len(slices) * len(masks), (slices[-1], masks[-1])
    group, over = np.full(len(found), -1), np.zeros(len(found), np.bool_)
    starts = np.zeros(groups + 1, np.int64)
    least = np.zeros(2, np.int64)
    for i in range(len(found)):
        n, m = _count(which[i, 0]), _count(which[i, 1])
        over[i] = n > most[0] or m > most[1]
        if not over[i] and (every or m > 0):
            least[0] = max(least[0], np.searchsorted(slices, n))
            least[1] = max(least[1], np.searchsorted(masks, m))
    if len(found) > together:
        least[:] = 0
    for i in range(len(found)):
        n, m = _count(which[i, 0]), _count(which[i, 1])
        if not over[i] and (every or m > 0):
            kind = max(np.searchsorted(slices, n), least[0]) * len(masks)
            group[i] = kind + max(np.searchsorted(masks, m), least[1])
            starts[group[i] + 1] += 1
    starts = np.cumsum(starts)
    rows = np.empty((starts[-1], 2 + most[0] + 3 * most[1]), np.uint32)
    places, free = rows.view(np.float32), starts.copy()
    for i in range(len(found)):
        if group[i] < 0:
            continue
        r = free[group[i]]
        free[group[i]] += 1
        places[r, 0], places[r, 1] = found[i, 0], found[i, 1]
        rows[r, 2 : 2 + most[0]] = NONE
        at, number, left = 2, 0, which[i, 0]
        while left != 0:
            if left & np.uint64(1):
                rows[r, at] = corners[number]
                at += 1
            left >>= np.uint64(1)
            number += 1
        at, number, left = 2 + most[0], 0, which[i, 1]
        for row in range(3):
            rows[r, at + row * most[1] : at + (row + 1) * most[1]] = words[-1, row]
        while left != 0:
            if left & np.uint64(1):
                for row in range(3):
                    rows[r, at + row * most[1]] = words[number, row]
                at += 1
            left >>= np.uint64(1)
            number += 1
    return rows, starts, over
