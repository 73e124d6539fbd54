"""Oriented bounding boxes: fitting them, their contours, and what separates two (Kang2008)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.polygons.polygons import Polygons

# Corner k lies at +1 along axis i where bit i of k is set. Face 2 i looks along +axis i, face
# 2 i + 1 along -axis i; bit f of a code says that face f is visible.
CORNERS = np.array([[1.0 if k >> i & 1 else -1.0 for i in range(3)] for k in range(8)])
# Most frames an object's box is tried in: one for each direction its polygons face.
FRAMES = 24


@dataclass(frozen=True, eq=False, slots=True)
class Boxes:
    """Oriented boxes: `centers` (b, 3), `axes` (b, 3, 3) unit rows, `halves` (b, 3) half sizes."""

    centers: Floats
    axes: Floats
    halves: Floats

    def corners(self) -> Floats:
        """(b, 8, 3) corners in the order of `CORNERS`."""
        reach = CORNERS[None] * self.halves[:, None]
        return self.centers[:, None] + np.einsum("bci,bij->bcj", reach, self.axes)


def _faces() -> list[list[int]]:
    """Corners of each face, counter-clockwise seen from outside."""
    faces = []
    for axis in range(3):
        u, v = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        loop = [0, u, u | v, v]
        faces += [[k | 1 << axis for k in loop], loop[::-1]]
    return faces


def contour_table() -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(64, 6) corners on the contour for each six-bit face code, and (64,) how many.

    The contour is made of the edges of which one face is visible and the other is not. A code
    with no face (the eye inside) or with opposite faces cannot be, and has no contour.
    """
    table, sizes = np.zeros((64, 6), np.int64), np.zeros(64, np.int64)
    for code in range(1, 64):
        if any(code >> 2 * axis & 3 == 3 for axis in range(3)):
            continue
        edges = {}
        for face, loop in enumerate(_faces()):
            if code >> face & 1:
                edges.update(dict.fromkeys(zip(loop, loop[1:] + loop[:1], strict=True), 1))
        outline = {a: b for a, b in edges if (b, a) not in edges}
        at, loop = min(outline), []
        while at not in loop:
            loop.append(at)
            at = outline[at]
        table[code, : len(loop)], sizes[code] = loop, len(loop)
    return table, sizes


def fit(polygons: Polygons) -> Boxes:
    """The smallest box about each object, among the frames that its polygons suggest.

    A frame is a polygon's normal and longest edge. A box, a panel and any prism get their exact
    box so; others one that is good, not always the least.
    """
    labels = np.unique(polygons.objects)
    found = [_fit_one(polygons.take(np.flatnonzero(polygons.objects == k))) for k in labels]
    centers, axes, halves = (np.array(part) for part in zip(*found, strict=True))
    return Boxes(centers.reshape(-1, 3), axes.reshape(-1, 3, 3), halves.reshape(-1, 3))


def _fit_one(polygons: Polygons) -> tuple[Floats, Floats, Floats]:
    frames = [np.eye(3)]
    step = max(1, len(polygons) // FRAMES)
    for index in range(0, len(polygons), step):
        corners = polygons.corners(index)
        edges = np.roll(corners, -1, axis=0) - corners
        along = edges[np.argmax((edges**2).sum(axis=1))]
        normal = np.cross(edges[0], edges[1])
        across = np.cross(normal, along)
        lengths = [np.linalg.norm(v) for v in (along, across, normal)]
        if min(lengths) > 0:
            frames.append(
                np.stack([v / n for v, n in zip((along, across, normal), lengths, strict=True)])
            )
    best = _about(polygons.vertices, frames[0])
    for frame in frames[1:]:
        other = _about(polygons.vertices, frame)
        if other[0] < best[0] * (1 - 1e-9):
            best = other
    return best[1:]


def _about(points: Floats, frame: Floats) -> tuple[float, Floats, Floats, Floats]:
    """A box's size, centre, axes and half lengths, about points (n, 3) in a frame."""
    local = points @ frame.T
    low, high = local.min(axis=0), local.max(axis=0)
    # Area decides, since a panel's volume is zero in many frames.
    u, v, w = high - low
    return u * v + v * w + w * u, (low + high) / 2 @ frame, frame, (high - low) / 2
