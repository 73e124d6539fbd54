"""Which blocks of pixels the triangles of an object can touch: less than what its box does.

Along a diagonal, or about a wheel, most of a box is empty, and every block that an object is said
to be in costs a look at its picture at every pixel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bits, Floats, Ints, Real
from seethrough.renderer.plan.blocks import BLOCK
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Scene

SLACK = 1.0  # pixels: what 32 bits on the GPU may round to


@dataclass(frozen=True, eq=False)
class Triangles:
    """The triangles of all meshes of a scene: points (p, 3) about their mesh's centre, corners
    (t, 3) as rows of these, and where each object's begin and end in both (n, 2, 2)."""

    points: NDArray[np.float64]
    corners: NDArray[np.int64]
    spans: NDArray[np.int64]


def triangles(scene: Scene) -> Triangles:
    """All of a scene, each mesh once; what scenes of the same meshes share is made once."""
    meshes = tuple(dict.fromkeys(thing.mesh for thing in scene.objects))
    points, corners, spans = _joined(meshes)
    place = {mesh: k for k, mesh in enumerate(meshes)}
    mine = [place[thing.mesh] for thing in scene.objects]
    return Triangles(points, corners, spans[mine])


@lru_cache(maxsize=8)
def _joined(meshes: tuple[Mesh, ...]) -> tuple[Floats, Ints, Ints]:
    """Points and corners of all meshes, and where each one's begin and end."""
    points = [mesh.vertices - mesh.center for mesh in meshes]
    ends = np.cumsum([[0, 0], *((len(m.vertices), len(m.triangles)) for m in meshes)], axis=0)
    corners = [m.triangles + np.int64(p) for m, p in zip(meshes, ends[:, 0], strict=False)]
    spans = np.stack([ends[:-1], ends[1:]], axis=2)
    none = np.zeros((0, 3))
    return np.concatenate([none, *points]), np.concatenate([none.astype(int), *corners]), spans


def lens(camera: Camera, size: tuple[int, int]) -> NDArray[np.float64]:
    """(4,) pixels for a slope of 1, the middle of the picture, and where the near plane is."""
    return np.array([camera.lens(size[1]), size[0] / 2, size[1] / 2, camera.near])


@njit(cache=True, nogil=True)
def cut_by_near_plane(
    points: Floats, span: Ints, turn: Floats, move: Floats, lens: Floats, seen: Real
) -> bool:
    """Whether a point of an object lies nearer than the near plane; if none does, `seen` (p, 3) has
    column, row and view depth of each in the span (first, end) of `points` (p, 3)."""
    for p in range(span[0], span[1]):
        x, y, z = points[p, 0], points[p, 1], points[p, 2]
        depth = -(turn[2, 0] * x + turn[2, 1] * y + turn[2, 2] * z + move[2])
        if depth < lens[3]:
            return True
        s = lens[0] / depth
        seen[p, 0] = lens[1] + s * (turn[0, 0] * x + turn[0, 1] * y + turn[0, 2] * z + move[0])
        seen[p, 1] = lens[2] - s * (turn[1, 0] * x + turn[1, 1] * y + turn[1, 2] * z + move[1])
        seen[p, 2] = depth
    return False


@njit(cache=True, nogil=True)
def cover(
    points: Floats,
    corners: Ints,
    spans: Ints,
    numbers: Ints,
    turns: Floats,
    moves: Floats,
    lens: Floats,
    boxes: Floats,
    part: Ints,
    bits: Bits,
) -> None:
    """Set in `bits` (h, w), of each block of a part (left, top, right, bottom in pixels), bit
    `numbers` (k,) of each object whose triangles can touch it, and its box (k, 4) does; of one that
    the near plane cuts, wherever its box does. No block beside the boxes, for what lies there was
    not made empty.

    `spans` (k, 2, 2) as in Triangles; `turns` (k, 3, 3) and `moves` (k, 3): camera ← mesh.
    """
    first_row, first_column = part[1] // BLOCK, part[0] // BLOCK
    rows = min((part[3] + BLOCK - 1) // BLOCK, bits.shape[0])
    columns = min((part[2] + BLOCK - 1) // BLOCK, bits.shape[1])
    flat = np.empty((len(points), 3), np.float32)
    for k in range(len(numbers)):
        bit = np.uint64(1) << np.uint64(numbers[k])
        cut = cut_by_near_plane(points, spans[k, 0], turns[k], moves[k], lens, flat)
        begin, end = spans[k, 1, 0], spans[k, 1, 1]
        if cut:
            begin, end = 0, 1
        for t in range(begin, end):
            if cut:
                left, top, right, bottom = boxes[k]
            else:
                a, b, c = flat[corners[t, 0]], flat[corners[t, 1]], flat[corners[t, 2]]
                left, right = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
                top, bottom = min(a[1], b[1], c[1]), max(a[1], b[1], c[1])
                left, top = max(left - SLACK, boxes[k, 0]), max(top - SLACK, boxes[k, 1])
                right, bottom = min(right + SLACK, boxes[k, 2]), min(bottom + SLACK, boxes[k, 3])
            if right < part[0] or left >= part[2] or bottom < part[1] or top >= part[3]:
                continue
            low_x = max(int(max(left, 0.0)) // BLOCK, first_column)
            low_y = max(int(max(top, 0.0)) // BLOCK, first_row)
            high_x = min(int(min(right, 1e6)) // BLOCK + 1, columns)
            high_y = min(int(min(bottom, 1e6)) // BLOCK + 1, rows)
            for row in range(low_y, high_y):
                for column in range(low_x, high_x):
                    bits[row, column] |= bit
