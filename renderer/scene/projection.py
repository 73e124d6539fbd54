"""From world to window: pixels have their origin in the upper left corner, y down.

The centre of the pixel in column c and row r is (c + 0.5, r + 0.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.scene.camera import Camera

_EDGES = np.array(
    [(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1],
    dtype=np.int64,
)


SNAP = 1 / 64  # pixels: what 32 bits and a rasteriser's grid (1/256) move a corner by is less


@dataclass(frozen=True, eq=False)
class Boxes:
    """What objects cover on the screen, at most.

    extents (n, 4): left, top, right, bottom in pixels; slants (n, 4): the least x + y and x − y,
    and the greatest, which cut the corners of such a box; near, far (n,): view depths of the
    nearest and farthest corner; crosses (n,): whether the near plane cuts it; within (n,): whether
    any of it lies between the near and far planes; inside (n,): whether it can be in the picture.
    """

    extents: NDArray[np.float64]
    slants: NDArray[np.float64]
    near: NDArray[np.float64]
    far: NDArray[np.float64]
    crosses: NDArray[np.bool_]
    within: NDArray[np.bool_]
    inside: NDArray[np.bool_]


def to_camera(points: NDArray[np.float64], camera: Camera) -> NDArray[np.float64]:
    """(..., 3) camera coordinates of (..., 3) world points."""
    return (points - camera.eye) @ camera.rotation


def to_pixels(
    points: NDArray[np.float64], camera: Camera, size: tuple[int, int]
) -> NDArray[np.float64]:
    """(..., 2) pixels of (..., 3) camera coordinates, which must lie in front of the eye."""
    width, height = size
    scale = camera.lens(height)
    depth = -points[..., 2]
    x = 0.5 * width + scale * points[..., 0] / depth
    y = 0.5 * height - scale * points[..., 1] / depth
    return np.stack([x, y], axis=-1)


@njit(cache=True)
def clouds(
    points: Floats, spans: Ints, turns: Floats, moves: Floats, lens: Floats
) -> tuple[Floats, Ints]:
    """(p, 2) pixels of the points of k objects one after the other, and where each object's begin
    (k + 1,).

    `spans` (k, 2) are rows of `points` (m, 3) in mesh space; `turns` (k, 3, 3), `moves` (k, 3):
    camera ← mesh; `lens`: pixels for a slope of 1, the middle of the picture x, y. What does not
    lie in front of the eye comes out as any number.
    """
    n = len(spans)
    starts = np.zeros(n + 1, np.int64)
    for k in range(n):
        starts[k + 1] = starts[k] + spans[k, 1] - spans[k, 0]
    pixels = np.empty((starts[n], 2))
    for k in range(n):
        m, v, row = turns[k], moves[k], starts[k]
        for p in range(spans[k, 0], spans[k, 1]):
            x, y, z = points[p, 0], points[p, 1], points[p, 2]
            depth = -(m[2, 0] * x + m[2, 1] * y + m[2, 2] * z + v[2])
            s = lens[0] / depth if depth > 0 else 0.0
            pixels[row, 0] = lens[1] + s * (m[0, 0] * x + m[0, 1] * y + m[0, 2] * z + v[0])
            pixels[row, 1] = lens[2] - s * (m[1, 0] * x + m[1, 1] * y + m[1, 2] * z + v[1])
            row += 1
    return pixels, starts


def screen_boxes(
    corners: NDArray[np.float64],
    camera: Camera,
    size: tuple[int, int],
    around: tuple[Floats, Ints] | None = None,
) -> Boxes:
    """Extents on the screen of (n, 8, 3) world boxes, cut at the near plane.

    The corners of a box come in the order of their bits: corner k is high in x if k & 4. `around`
    are points (p, 3) that hold closer what lies in each box, and where each one's begin (n + 1,).
    """
    scale = camera.lens(size[1])
    lens = np.array([scale, size[0] / 2, size[1] / 2, camera.near])
    held, starts = around or (corners.reshape(-1, 3), 8 * np.arange(len(corners) + 1))
    extents, slants, near, far, crosses = _boxes(held, starts, camera.eye, camera.rotation, lens)
    if crosses.any():
        _add_cuts(extents, slants, crosses, corners, camera.eye, camera.rotation, lens)
    seen = _seen(extents, near, far, camera.near, camera.far, size)
    return Boxes(extents, slants, near, far, crosses, *seen)


@njit(cache=True)
def _boxes(
    points: Floats, starts: Ints, eye: Floats, rotation: Floats, lens: Floats
) -> tuple[Floats, Floats, Floats, Floats, Bools]:
    """(n, 4) extents and slants of what lies beyond the near plane, nearest and farthest depth
    (n,), and whether it cuts; of object i by rows starts[i] to starts[i + 1] of the points (p, 3).
    """
    n = len(starts) - 1
    extents, slants = np.empty((n, 4)), np.empty((n, 4))
    near, far = np.full(n, np.inf), np.full(n, -np.inf)
    crosses = np.zeros(n, np.bool_)
    for i in range(n):
        extents[i, 0] = extents[i, 1] = slants[i, 0] = slants[i, 1] = np.inf
        extents[i, 2] = extents[i, 3] = slants[i, 2] = slants[i, 3] = -np.inf
        ahead = 0
        for k in range(starts[i], starts[i + 1]):
            x, y, z = 0.0, 0.0, 0.0
            for c in range(3):
                d = points[k, c] - eye[c]
                x += d * rotation[c, 0]
                y += d * rotation[c, 1]
                z -= d * rotation[c, 2]
            near[i], far[i] = min(near[i], z), max(far[i], z)
            if z < lens[3]:
                continue
            ahead += 1
            x, y = lens[1] + lens[0] * x / z, lens[2] - lens[0] * y / z
            extents[i, 0], extents[i, 1] = min(extents[i, 0], x), min(extents[i, 1], y)
            extents[i, 2], extents[i, 3] = max(extents[i, 2], x), max(extents[i, 3], y)
            slants[i, 0], slants[i, 1] = min(slants[i, 0], x + y), min(slants[i, 1], x - y)
            slants[i, 2], slants[i, 3] = max(slants[i, 2], x + y), max(slants[i, 3], x - y)
        for side in range(4):
            slants[i, side] += -SNAP if side < 2 else SNAP
        crosses[i] = 0 < ahead < starts[i + 1] - starts[i]
    return extents, slants, near, far, crosses


@njit(cache=True)
def _seen(
    extents: Floats, near: Floats, far: Floats, first: float, last: float, size: tuple[int, int]
) -> tuple[Bools, Bools]:
    """(n,) what lies between the depths `first` and `last`, and which of that in the picture."""
    n = len(extents)
    within, inside = np.empty(n, np.bool_), np.empty(n, np.bool_)
    for i in range(n):
        within[i] = far[i] > first and near[i] < last
        inside[i] = within[i] and extents[i, 2] > 0 and extents[i, 3] > 0
        inside[i] = inside[i] and extents[i, 0] < size[0] and extents[i, 1] < size[1]
    return within, inside


@njit(cache=True)
def corners_cut(extents: Floats) -> Floats:
    """(n, 4) slants of boxes (n, 4) that nothing cuts the corners of."""
    slants = np.empty(extents.shape)
    for i in range(len(extents)):
        _cut(extents[i], slants[i])
    return slants


@njit(cache=True)
def _cut(extents: Floats, slants: Floats) -> None:
    left, top, right, bottom = extents
    if left > right:  # what lies behind the eye
        slants[:2], slants[2:] = np.inf, -np.inf
    else:
        slants[0], slants[1] = left + top, left - bottom
        slants[2], slants[3] = right + bottom, right - top


@njit(cache=True)
def _add_cuts(
    extents: Floats, slants: Floats, crosses: Bools,
    corners: Floats, eye: Floats, rotation: Floats, lens: Floats,
) -> None:  # fmt: skip
    """Widen what `crosses` by the points where the near plane cuts the edges of its box, one of
    `corners` (n, 8, 3); nothing cuts the corners of that on the screen."""
    offset, place = np.empty((8, 3)), np.empty(2)
    for i in range(len(crosses)):
        if not crosses[i]:
            continue
        for k in range(8):
            for c in range(3):
                offset[k, c] = 0.0
                for d in range(3):
                    offset[k, c] += (corners[i, k, d] - eye[d]) * rotation[d, c]
        for e in range(len(_EDGES)):
            a, b = offset[_EDGES[e, 0]], offset[_EDGES[e, 1]]
            if (-a[2] < lens[3]) == (-b[2] < lens[3]):
                continue
            t = (lens[3] + a[2]) / (a[2] - b[2])
            place[0] = lens[1] + lens[0] * (a[0] + t * (b[0] - a[0])) / lens[3]
            place[1] = lens[2] - lens[0] * (a[1] + t * (b[1] - a[1])) / lens[3]
            for c in range(2):
                extents[i, c] = min(extents[i, c], place[c])
                extents[i, 2 + c] = max(extents[i, 2 + c], place[c])
        _cut(extents[i], slants[i])


def depth_values(points: Floats, camera: Camera) -> Floats:
    """(n,) what the depth buffer holds, 0 to 1, of points (n, 3); −1 behind the eye."""
    depth = camera.depth(points)
    safe = np.where(depth > 0, depth, 1.0)
    scale = camera.far / (camera.far - camera.near)
    return np.where(depth > 0, scale * (1 - camera.near / safe), -1.0)
