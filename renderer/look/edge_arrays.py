"""What edges are smoothed with, as arrays: where meshes' edges and things are, the lines that they
make on the screen, a picture, and room for it."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Floats32, Ints

TOGETHER = 512  # pixels of lines, after which those found are looked at before they are forgotten
STEPS = 4096  # of a colour between 0 and 1, when it becomes a 16-bit float again


class Edges(NamedTuple):
    """Meshes' edges one after the other: ends (e, 2, 3), sides (e, 2), crease (e,): 1 or 0, planes
    (f, 4), and where each mesh's edges and planes begin (m + 1, 2).

    Numbers without a sign: of others code would ask, edge by edge, whether they count from the end.
    """

    ends: Floats
    sides: NDArray[np.uint32]
    crease: NDArray[np.uint8]
    planes: Floats
    starts: Ints


class Poses(NamedTuple):
    """Of all objects (n): whether it is drawn (n,), mesh (n,), matrix (n, 4, 4): world ← mesh, the
    inverse (n, 3, 3) of its turn, and whether it may show through others (n,); the camera's eye
    (3,) and rotation (3, 3): world ← camera."""

    drawn: Bools
    mesh: Ints
    matrix: Floats
    inverse: Floats
    through: Bools
    eye: Floats
    rotation: Floats


class View(NamedTuple):
    """Pixels for a slope of 1, the picture's width and height, the near plane; what makes a depth
    of the buffer's number z: a / (b − z); whether edges are smoothed, and half the width of
    outlines."""

    scale: float
    width: int
    height: int
    near: float
    a: float
    b: float
    smooth: bool
    half: float


Point: TypeAlias = tuple[float, float, float]
"""Right, up and depth, as the camera has it."""


Box: TypeAlias = tuple[int, int, int, int]
"""Four numbers of pixels."""


class Lines(NamedTuple):
    """Lines on the screen, in pixels from its lower left corner.

    Each runs along columns or rows (`flat` (s,): along columns), from pixel `first` to before
    `last` (s, 2), and is of an object that may show `through` others or not (s,). numbers (s, 6):
    where it begins along, across, and there 1 / depth; by how much the latter two grow to its end,
    and the part of it that a pixel is. inked (s,): half the width of its ink across, 0 for none.
    """

    flat: Bools
    through: Bools
    span: NDArray[np.int32]
    numbers: Floats
    inked: Floats


def lines(count: int) -> Lines:
    """Room for so many lines."""
    return Lines(
        np.empty(count, np.bool_), np.empty(count, np.bool_), np.empty((count, 2), np.int32),
        np.empty((count, 6)), np.empty(count),
    )  # fmt: skip


class Picture(NamedTuple):
    """Of the part of a picture whose lower left pixel is `left`, `below`, with rows of so many
    pixels: color (p, 4), 16-bit floats, and depth (p,), all of 32 bits for 1, as the buffers hold
    them, the lowest row first; and `tables`."""

    color: NDArray[np.uint16]
    depth: NDArray[np.uint32]
    left: int
    below: int
    row: int
    decoded: Floats32
    encoded: NDArray[np.uint16]


def tables() -> tuple[Floats32, NDArray[np.uint16]]:
    """What each 16-bit float is (65536,), and the 16-bit float of each step from 0 to 1."""
    decoded = np.arange(65536, dtype=np.uint16).view(np.float16).astype(np.float32)
    steps = (np.arange(STEPS + 1) / STEPS).astype(np.float16).view(np.uint16)
    return np.nan_to_num(decoded), steps


class Room(NamedTuple):
    """What smoothing needs besides, kept from frame to frame.

    Where lines are seen, of those that are walked together, in that order (s,): which line, in
    which pixel, how far off the neighbour is that it runs nearer to, how far across, and how much
    of the line is seen if it is of what may show through others. Of pixels that take a part of a
    neighbour, in the order in which they were found (p,): where, how far off the neighbour is, the
    part, and the new colour (p, 3). slot (p,): 1 + where each pixel of the part stands in that
    order, all 0 between frames. The pixels that have any ink (p,), and what alpha each has: how
    much ink is told by the picture's own in its place, so that there is no other array to fetch.
    """

    line: NDArray[np.int32]
    at: NDArray[np.int32]
    beside: NDArray[np.int32]
    place: Floats
    seen: Floats
    slot: NDArray[np.int32]
    pixels: NDArray[np.int32]
    takes: NDArray[np.int32]
    part: Floats32
    colors: NDArray[np.uint16]
    inked: NDArray[np.int32]
    held: NDArray[np.uint16]


def room(steps: int, pixels: int) -> Room:
    """For lines of so many pixels together, in parts of a picture of no more than so many."""
    line, at, beside = np.zeros((3, steps + 1), np.int32)
    return Room(
        line, at, beside, np.zeros(steps + 1), np.zeros(steps + 1),
        np.zeros(pixels, np.int32), np.zeros(pixels, np.int32), np.zeros(pixels, np.int32),
        np.zeros(pixels, np.float32), np.zeros((pixels, 3), np.uint16),
        np.zeros(pixels + 1, np.int32), np.zeros(pixels + 1, np.uint16),
    )  # fmt: skip
