"""Loops over the pixels of a look, compiled: what changed, what shows, and its sums by object.

A simulated person looks thousands of times; array by array these took most of a look's time. They
add in the same order as `numpy.bincount`: from the front layer back, row by row.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bytes, Floats, Floats32, Ints

Halves = NDArray[np.uint16]  # bits of 16-bit floats, which numba does not know


@njit(cache=True)
def changed(
    ids: Floats32, colors: Halves, last: Floats32, place: tuple[int, int, int], values: Floats
) -> tuple[Ints, Ints, Floats]:
    """What a level drew into a part (h, w) of a picture: flat pixels (k,), ids and opacities there.

    `ids` holds its object + 1, 0 for background, `last` what it held before, which becomes the
    same; `colors` (h, w, 4) RGBA, with the opacity in A, of no pixels where all is opaque; `place`
    the part's left, its top and the picture's width; `values` (65536,) the number that 16 bits of a
    half float are.
    """
    height, width = ids.shape
    opaque = len(colors) == 0
    left, top, across = place
    pixel = np.empty(height * width, np.int64)
    found = np.empty(height * width, np.int64)
    opacity = np.empty(height * width)
    k = 0
    for row in range(height):
        for column in range(width):
            number = ids[row, column]
            if number != last[row, column]:
                last[row, column] = number
                if number > 0:
                    pixel[k] = (row + top) * across + column + left
                    found[k] = np.int64(number)
                    opacity[k] = 1.0 if opaque else values[colors[row, column, 3]]
                    k += 1
    return pixel[:k], found[:k], opacity[:k]


@njit(cache=True)
def around(extents: Floats, objects: Ints, width: int, height: int) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the pixels that some objects with these extents (n, 4) can cover,
    and one beyond."""
    left, top, right, bottom = float(width), float(height), 0.0, 0.0
    for i in objects:
        left, top = min(left, extents[i, 0]), min(top, extents[i, 1])
        right, bottom = max(right, extents[i, 2]), max(bottom, extents[i, 3])
    low = int(np.floor(max(left, 0.0))) - 1, int(np.floor(max(top, 0.0))) - 1
    high = int(np.ceil(min(right, width))) + 1, int(np.ceil(min(bottom, height))) + 1
    return max(low[0], 0), max(low[1], 0), min(high[0], width), min(high[1], height)


@njit(cache=True)
def as_bytes(colors: Halves, table: Bytes) -> Bytes:
    """(h, w, 3) red, green and blue of (h, w, 4), by a byte for each of the 65536 half floats."""
    height, width = colors.shape[:2]
    picture = np.empty((height, width, 3), np.uint8)
    for row in range(height):
        for column in range(width):
            for c in range(3):
                picture[row, column, c] = table[colors[row, column, c]]
    return picture


@njit(cache=True)
def left_over(
    starts: Ints, pixel: Ints, ids: Ints, opacity: Floats, limits: tuple[int, int, float]
) -> tuple[Ints, Ints, Floats]:
    """Objects, pixels and shares of layers from back to front, from the front; layer k is what
    `starts` k to k + 1 are of the other arrays. `limits`: how many pixels and objects there are,
    and the least share that is kept."""
    pixels, objects, least = limits
    which = np.empty(len(pixel), np.int64)
    where = np.empty(len(pixel), np.int64)
    share = np.empty(len(pixel))
    left = np.ones(pixels)
    n = 0
    for k in range(len(starts) - 2, -1, -1):
        for i in range(starts[k], starts[k + 1]):
            if ids[i] > objects:
                continue
            p = pixel[i]
            alpha = min(opacity[i], 1.0)
            part = left[p] * alpha
            left[p] *= 1.0 - alpha
            if part >= least:
                which[n], where[n], share[n] = ids[i] - 1, p, part
                n += 1
    return which[:n], where[:n], share[:n]


@njit(cache=True)
def measured(
    which: Ints, pixel: Ints, share: Floats, picture: Bytes, objects: int
) -> tuple[Ints, Floats, Floats, Floats, Floats]:
    """A Visibility's arrays, from objects, flat pixels and shares (k,) of a (h, w, 3) picture."""
    height, width = picture.shape[:2]
    count, sums, box = _tallied(which, pixel, share, picture, objects)
    weight, position = np.zeros(objects), np.full((objects, 2), np.nan)
    contrast, area = np.zeros(objects), np.zeros(objects)
    total = _sums_to(picture)
    for n in range(objects):
        if count[n]:
            weight[n] = sums[n, 0] / count[n]
            position[n, 0] = sums[n, 1] / sums[n, 0] / height
            position[n, 1] = sums[n, 2] / sums[n, 0] / height
            contrast[n] = _contrast(sums[n], box[n], total)
            area[n] = sums[n, 0] / (width * height)
    return count, weight, position, contrast, area


@njit(cache=True)
def _tallied(
    which: Ints, pixel: Ints, share: Floats, picture: Bytes, objects: int
) -> tuple[Ints, Floats, Ints]:
    """Of each object how many pixels show it (n,); sums of share, share · (x, y) of the pixel's
    middle in pixels, and share · colour (n, 6); first and last row and column (n, 4: top, left,
    bottom, right), −1 at the end of what nothing shows."""
    width = picture.shape[1]
    shade = np.arange(256) / 255.0
    count = np.zeros(objects, np.int64)
    sums = np.zeros((objects, 6))
    box = np.empty((objects, 4), np.int64)
    box[:, :2], box[:, 2:] = np.iinfo(np.int64).max, -1
    row, start, last = 0, 0, -1
    shown, top, left, bottom, right = 0, 0, 0, 0, 0
    a, x, y, r, g, b = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(which)):
        n, part = which[i], share[i]
        if n != last:  # neighbours are mostly of one object: their sums stay in registers
            if last >= 0:
                count[last] = shown
                sums[last] = a, x, y, r, g, b
                box[last] = top, left, bottom, right
            shown, last = count[n], n
            a, x, y, r, g, b = sums[n]
            top, left, bottom, right = box[n]
        if not 0 <= pixel[i] - start < width:  # most follow in a row, and dividing takes long
            row = pixel[i] // width
            start = row * width
        column = pixel[i] - start
        shown += 1
        a += part
        x += part * (column + 0.5)
        y += part * (row + 0.5)
        r += part * shade[picture[row, column, 0]]
        g += part * shade[picture[row, column, 1]]
        b += part * shade[picture[row, column, 2]]
        top, left = min(top, row), min(left, column)
        bottom, right = max(bottom, row), max(right, column)
    if last >= 0:
        count[last] = shown
        sums[last] = a, x, y, r, g, b
        box[last] = top, left, bottom, right
    return count, sums, box


@njit(cache=True)
def _sums_to(picture: Bytes) -> Ints:
    """(h + 1, w + 1, 3) sums of all that lies above and to the left in a (h, w, 3) picture: whole
    numbers, so that nothing rounds."""
    height, width = picture.shape[:2]
    total = np.zeros((height + 1, width + 1, 3), np.int64)
    for row in range(height):
        red, green, blue = 0, 0, 0
        for column in range(width):
            red += picture[row, column, 0]
            green += picture[row, column, 1]
            blue += picture[row, column, 2]
            total[row + 1, column + 1, 0] = total[row, column + 1, 0] + red
            total[row + 1, column + 1, 1] = total[row, column + 1, 1] + green
            total[row + 1, column + 1, 2] = total[row, column + 1, 2] + blue
    return total


@njit(cache=True)
def _contrast(own: Floats, box: Ints, total: Ints) -> float:
    """Distance of an object's mean colour from the rest of its box, half as large again. `own`,
    `box`: what _tallied has of it, `total` the picture's _sums_to."""
    height, width = len(total) - 1, total.shape[1] - 1
    down, across = max(2, (box[2] - box[0]) // 4), max(2, (box[3] - box[1]) // 4)
    top, left = max(box[0] - down, 0), max(box[1] - across, 0)
    bottom, right = min(box[2] + down + 1, height), min(box[3] + across + 1, width)
    area = (bottom - top) * (right - left)
    if area <= own[0] + 0.5:
        return 0.0
    rest, apart = max(area - own[0], 1e-9), 0.0
    for c in range(3):
        around = total[bottom, right, c] - total[top, right, c]
        around += total[top, left, c] - total[bottom, left, c]
        surround = min(max((around / 255.0 - own[3 + c]) / rest, 0.0), 1.0)
        apart += (own[3 + c] / own[0] - surround) ** 2
    return np.sqrt(apart) / np.sqrt(3.0)
