"""What can be seen of each object in a picture: how much, how strongly, where, how well set off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bytes, Floats, Ints, Real

# An object with less than this share of a pixel is not seen there: 1 in 64 changes a display's
# colour by at most 4 of 255 steps, about the smallest difference people notice side by side.
SEEN = 1.0 / 64.0


# What a layer drew: pixels (k,), counted row by row from the top, the object + 1 that shows there
# (k,), and the opacity with which it was drawn (k,).
Drawn = tuple[NDArray[np.int64], NDArray[np.integer], NDArray[np.floating]]


@dataclass(frozen=True, eq=False)
class Visibility:
    """Arrays of length n, one entry for each object of the scene.

    pixels: how many pixels of the picture show the object with a share of at least 1/64 (0:
    nobody can see it); weight: its mean share w of those pixels, 1 where it shows opaquely;
    position (n, 2): their centre in view units, weighted by the share, NaN if unseen; contrast:
    distance in RGB, 0 to 1, between the mean colour the pixels show and that of their surround;
    area: the sum of the shares as a part of the picture.
    """

    pixels: NDArray[np.int64]
    weight: NDArray[np.float64]
    position: NDArray[np.float64]
    contrast: NDArray[np.float64]
    area: NDArray[np.float64]

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(n,) whether anything of the object can be seen."""
        return self.pixels > 0


def better(a: Visibility, b: Visibility) -> Visibility:
    """Of each object what one of two looks showed more of: what is known after both."""
    more = b.area > a.area
    return Visibility(
        np.where(more, b.pixels, a.pixels),
        np.where(more, b.weight, a.weight),
        np.where(more[:, None], b.position, a.position),
        np.where(more, b.contrast, a.contrast),
        np.where(more, b.area, a.area),
    )


def shares(
    layers: Sequence[Drawn], pixels: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Objects, pixels (flat) and shares from layers drawn from back to front into so many pixels.

    Only shares of at least `SEEN` are kept.
    """
    left = np.ones(pixels)
    found = []
    for where, ids, alpha in reversed(layers):
        opacity = np.minimum(alpha.astype(float), 1.0)
        share = left[where] * opacity
        left[where] *= 1.0 - opacity
        seen = share >= SEEN
        found.append((ids[seen] - 1, where[seen], share[seen]))
    parts = [np.concatenate([f[k] for f in found]) for k in range(3)]
    return parts[0].astype(np.int64), parts[1], parts[2]


def visibility(layers: Sequence[Drawn], picture: NDArray[np.uint8], objects: int) -> Visibility:
    """Measure n = `objects` objects in a (h, w, 3) picture made of `layers`."""
    found = shares(layers, picture.shape[0] * picture.shape[1])
    return _measured(*found, picture, objects)


def visibility_of_shares(
    layers: Sequence[tuple[NDArray[np.int64], NDArray[np.floating]]],
    picture: NDArray[np.uint8],
    objects: int,
) -> Visibility:
    """The same from layers of object + 1 and its share of the pixel (h, w), in any order."""
    found = []
    for ids, share in layers:
        where = np.nonzero((ids.ravel() > 0) & (share.ravel() >= SEEN))[0]
        found.append((ids.ravel()[where] - 1, where, share.ravel()[where].astype(float)))
    found.append((np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0)))
    which, pixel, share = (np.concatenate([f[k] for f in found]) for k in range(3))
    return _measured(which, pixel, share, picture, objects)


def _measured(which: Ints, pixel: Ints, share: Real, picture: Bytes, objects: int) -> Visibility:
    height, width = picture.shape[:2]
    row, column = np.divmod(pixel, width)
    count = np.bincount(which, minlength=objects)
    total = np.bincount(which, share, objects).astype(float, copy=False)
    with np.errstate(invalid="ignore"):
        x = np.bincount(which, share * (column + 0.5), objects) / total / height
        y = np.bincount(which, share * (row + 0.5), objects) / total / height
        weight = np.where(count > 0, total / np.maximum(count, 1), 0.0)
    colors = picture.reshape(-1, 3)[pixel] / 255.0
    own: Floats = np.stack([np.bincount(which, share * colors[:, k], objects) for k in range(3)], 1)
    contrast = _contrast(which, row, column, own, total, picture)
    return Visibility(count, weight, np.stack([x, y], axis=1), contrast, total / (width * height))


def _contrast(
    which: Ints, row: Ints, column: Ints, own: Floats, total: Floats, picture: Bytes
) -> Floats:
    """(n,) distance of an object's mean colour from the rest of its box, half as large again."""
    height, width = picture.shape[:2]
    n = len(total)
    low = np.full((n, 2), np.iinfo(np.int64).max)
    high = np.full((n, 2), -1)
    for k, values in enumerate((row, column)):
        np.minimum.at(low[:, k], which, values)
        np.maximum.at(high[:, k], which, values)
    seen = high[:, 0] >= 0
    margin = np.maximum(2, (high - low) // 4)[seen]
    low = np.maximum(low[seen] - margin, 0)
    high = np.minimum(high[seen] + margin + 1, [height, width])
    box = _sums(picture, low, high) / 255.0
    area = (high - low).prod(axis=1)
    rest = np.maximum(area - total[seen], 1e-9)[:, None]
    surround = np.clip((box - own[seen]) / rest, 0, 1)
    apart = np.linalg.norm(own[seen] / total[seen, None] - surround, axis=1) / np.sqrt(3)
    contrast = np.zeros(n)
    contrast[seen] = np.where(area > total[seen] + 0.5, apart, 0.0)
    return contrast


@njit(cache=True)
def _sums(picture: Bytes, low: Ints, high: Ints) -> Floats:
    """(k, 3) sums of a (h, w, 3) picture over boxes from `low` to `high` (k, 2: row, column)."""
    height, width = picture.shape[:2]
    # Of all that lies above and to the left: whole numbers, so that nothing rounds.
    total = np.zeros((height + 1, width + 1, 3), np.int64)
    for row in range(height):
        so_far = np.zeros(3, np.int64)
        for column in range(width):
            for c in range(3):
                so_far[c] += picture[row, column, c]
                total[row + 1, column + 1, c] = total[row, column + 1, c] + so_far[c]
    sums = np.empty((len(low), 3))
    for k in range(len(low)):
        top, left, bottom, right = low[k, 0], low[k, 1], high[k, 0], high[k, 1]
        for c in range(3):
            across = total[bottom, right, c] - total[top, right, c]
            sums[k, c] = across + total[top, left, c] - total[bottom, left, c]
    return sums
