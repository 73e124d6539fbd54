"""What edges are smoothed with, as arrays: lines, where things are, a picture, and room for it."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Floats32, Ints

STEPS = 4096  # of a colour between 0 and 1, when it becomes a 16-bit float again


class Lines(NamedTuple):
    """Meshes' edges one after the other: ends (e, 2, 3), sides (e, 2), crease (e,), planes (f, 4),
    and where each mesh's edges and planes begin (m + 1, 2)."""

    ends: Floats
    sides: NDArray[np.int32]
    crease: Bools
    planes: Floats
    starts: Ints


class Poses(NamedTuple):
    """Of each object drawn (k): its mesh, the eye in mesh space (k, 3), turn (k, 3, 3) and move
    (k, 3): camera ← mesh; and whether it may show through others."""

    mesh: Ints
    eye: Floats
    turn: Floats
    move: Floats
    through: Bools


class View(NamedTuple):
    """Pixels for a slope of 1, the picture's middle x, y, the near plane; what makes a depth of the
    buffer's number z: a / (b − z); whether edges are smoothed, and half the width of outlines."""

    scale: float
    x: float
    y: float
    near: float
    a: float
    b: float
    smooth: bool
    half: float


Point: TypeAlias = tuple[float, float, float]
"""Right, up and depth, as the camera has it."""


class Picture(NamedTuple):
    """color (h, w, 4), 16-bit floats, and depth (h, w), all of 32 bits for 1, as the buffers hold
    them, the lowest row first; and `tables`."""

    color: NDArray[np.uint16]
    depth: NDArray[np.uint32]
    decoded: Floats32
    encoded: NDArray[np.uint16]


def tables() -> tuple[Floats32, NDArray[np.uint16]]:
    """What each 16-bit float is (65536,), and the 16-bit float of each step from 0 to 1."""
    decoded = np.arange(65536, dtype=np.uint16).view(np.float16).astype(np.float32)
    steps = (np.arange(STEPS + 1) / STEPS).astype(np.float16).view(np.uint16)
    return np.nan_to_num(decoded), steps


class Room(NamedTuple):
    """What smoothing needs besides, kept from frame to frame: the largest part that a pixel takes
    (h, w; all 0), from which neighbour (h, w), the pixels that take any and their new colours; how
    much of a pixel has ink (h, w; all 0), the pixels that have any; and how many there are of both
    kinds (2)."""

    best: Floats32
    taken: NDArray[np.int8]
    pixels: NDArray[np.int32]
    colors: NDArray[np.uint16]
    ink: Floats32
    inked: NDArray[np.int32]
    counts: Ints


def room(size: tuple[int, int]) -> Room:
    """For pictures of (width, height)."""
    width, height = size
    return Room(
        np.zeros((height, width), np.float32), np.zeros((height, width), np.int8),
        np.zeros(height * width, np.int32), np.zeros((height * width, 3), np.uint16),
        np.zeros((height, width), np.float32), np.zeros(height * width, np.int32),
        np.zeros(2, np.int64),
    )  # fmt: skip
