"""Blocks of pixels: which objects and masks can show in them, so that no pixel asks them all."""

from __future__ import annotations

import numpy as np
from numba import njit

BLOCK = 8  # pixels, on each side: also in shaders/block.vert and few.vert


def whole(size: tuple[int, int]) -> tuple[int, int]:
    """Width and height of a picture in pixels, rounded up to whole blocks."""
    return (-(-size[0] // BLOCK) * BLOCK, -(-size[1] // BLOCK) * BLOCK)


def shape(size: tuple[int, int]) -> tuple[int, int]:
    """Rows and columns of blocks that hold a picture of `size` (width, height) in pixels."""
    return (-(-size[1] // BLOCK), -(-size[0] // BLOCK))


@njit(cache=True, nogil=True)
def mark(distance, left, top, width, number, bits):  # type: ignore[no-untyped-def]
    """Set bit `number` of the blocks in which any of the (h, w) distances is within a mask's
    `width`; `left` and `top` are where they lie in the window."""
    bit = np.uint64(1) << np.uint64(number)
    for row in range(distance.shape[0]):
        for column in range(distance.shape[1]):
            if distance[row, column] <= width:
                bits[(top + row) // BLOCK, (left + column) // BLOCK] |= bit


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


@njit(cache=True)
def shown(objects, masks, part):  # type: ignore[no-untyped-def]
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
def most(slices, masks):  # type: ignore[no-untyped-def]
    """The most bits of `slices` (h, w) and of `masks` (h, w) in any block that has both."""
    found = np.zeros(2, np.int64)
    for row in range(slices.shape[0]):
        for column in range(slices.shape[1]):
            bits = slices[row, column], masks[row, column]
            if bits[0] == 0 or bits[1] == 0:
                continue
            for k in range(2):
                left, count = bits[k], 0
                while left != 0:
                    left &= left - np.uint64(1)
                    count += 1
                found[k] = max(found[k], count)
    return found


@njit(cache=True)
def lowest(bits, most):  # type: ignore[no-untyped-def]
    """(k, most) the numbers of the lowest of each one's bits (k,), then −1; and how many bits each
    has (k,), which may be more than `most`."""
    numbers, counts = np.full((len(bits), most), -1, np.int64), np.zeros(len(bits), np.int64)
    for i in range(len(bits)):
        left, number = bits[i], 0
        while left != 0:
            if left & np.uint64(1):
                if counts[i] < most:
                    numbers[i, counts[i]] = number
                counts[i] += 1
            left >>= np.uint64(1)
            number += 1
    return numbers, counts
