"""Blocks of pixels: which objects and masks can show in them, so that no pixel asks them all."""

from __future__ import annotations

import numpy as np
from numba import njit

BLOCK = 8  # pixels, on each side


@njit(cache=True, nogil=True)
def mark(distance, left, top, width, blocks):  # type: ignore[no-untyped-def]
    """Set the blocks in which any of the (h, w) distances is within a mask's `width`; `left` and
    `top` are where they lie in the window."""
    for row in range(distance.shape[0]):
        for column in range(distance.shape[1]):
            if distance[row, column] <= width:
                blocks[(top + row) // BLOCK, (left + column) // BLOCK] = True


@njit(cache=True)
def covered(boxes, numbers, shape):  # type: ignore[no-untyped-def]
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
def runs(objects, masks, part):  # type: ignore[no-untyped-def]
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
