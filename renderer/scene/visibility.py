"""What can be seen of each object in a picture: how much, how strongly, where, how well set off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.tallies import left_over, measured

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
    layers: Sequence[Drawn], pixels: int, objects: int | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Objects, pixels (flat) and shares from layers drawn from back to front into so many pixels.

    Only shares of at least `SEEN` are kept, and only of the first `objects` (None: of all).
    """
    starts = np.cumsum([0, *(len(where) for where, _, _ in layers)])
    where = np.concatenate([layer[0] for layer in layers])
    ids = np.concatenate([layer[1] for layer in layers], dtype=np.int64, casting="unsafe")
    opacity = np.concatenate([layer[2] for layer in layers], dtype=np.float64)
    most = np.iinfo(np.int64).max if objects is None else objects
    return left_over(starts, where, ids, opacity, (pixels, most, SEEN))


def visibility(layers: Sequence[Drawn], picture: NDArray[np.uint8], objects: int) -> Visibility:
    """Measure the first `objects` objects in a (h, w, 3) picture made of `layers`."""
    found = shares(layers, picture.shape[0] * picture.shape[1], objects)
    return Visibility(*measured(*found, picture, objects))


def visibility_of_shares(
    layers: Sequence[tuple[NDArray[np.int64], NDArray[np.floating]]],
    picture: NDArray[np.uint8],
    objects: int,
) -> Visibility:
    """The same from layers of object + 1 and its share of the pixel (h, w), in any order."""
    which, pixel = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    shown = [np.zeros(0, np.float64)]
    for ids, share in layers:
        where = np.nonzero((ids.ravel() > 0) & (share.ravel() >= SEEN))[0]
        which.append(ids.ravel()[where] - 1)
        pixel.append(where)
        shown.append(share.ravel()[where].astype(np.float64))
    found = (np.concatenate(which), np.concatenate(pixel), np.concatenate(shown))
    return Visibility(*measured(*found, picture, objects))
