"""Small orthographic pictures of a mesh in numpy: what its outline is, which side shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renderer.geometry import Mesh


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """covered (size, size) bool, row 0 on top; facing (size, size) bool: where covered, whether
    the nearest surface turns its front to the viewer."""

    covered: NDArray[np.bool_]
    facing: NDArray[np.bool_]


def view_axes(yaw: float, pitch: float) -> NDArray[np.float64]:
    """(3, 3) rows: right, up and towards the viewer, who is `yaw` right of −z and `pitch` up."""
    s, c, sp, cp = np.sin(yaw), np.cos(yaw), np.sin(pitch), np.cos(pitch)
    return np.array([[-c, 0, -s], [-s * sp, cp, c * sp], [s * cp, sp, -c * cp]])


def outline(
    mesh: Mesh,
    yaw: float,
    pitch: float,
    size: int = 64,
    frame: NDArray[np.float64] | None = None,
) -> Outline:
    """The mesh from infinity, at pixel centres.

    `frame` (2, 2) is the lowest and highest corner of the square shown, in units of the view's
    right and up axes; by default the square about the mesh's own picture.
    """
    seen = mesh.vertices @ view_axes(yaw, pitch).T
    if frame is None:
        frame = square(seen[:, :2])
    xy = (seen[:, :2] - frame[0]) / (frame[1, 0] - frame[0, 0]) * size - 0.5
    depth = np.full(size * size, -np.inf)
    front = np.zeros(size * size, bool)
    for batch in np.array_split(mesh.triangles, max(1, len(mesh.triangles) // 4000)):
        _draw(xy[batch], seen[batch][..., 2], size, depth, front)
    covered = np.isfinite(depth).reshape(size, size)[::-1]
    return Outline(covered, front.reshape(size, size)[::-1])


def square(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2, 2) corners of the smallest square about the bounds of points (n, 2)."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = max((high - low).max() / 2, 1e-12)
    return np.stack([(low + high) / 2 - half, (low + high) / 2 + half])


def _draw(
    p: NDArray[np.float64],
    z: NDArray[np.float64],
    size: int,
    depth: NDArray[np.float64],
    front: NDArray[np.bool_],
) -> None:
    """Add triangles (m, 3, 2), pixel coordinates, with depths z (m, 3), to a picture."""
    low = np.clip(np.ceil(p.min(axis=1)), 0, size).astype(int)
    high = np.clip(np.floor(p.max(axis=1)) + 1, 0, size).astype(int)
    area = _cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    extent = np.maximum(high - low, 0)
    count = extent.prod(axis=1) * (area != 0)
    which = np.repeat(np.arange(len(p)), count)
    k = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    at = low[which] + np.stack([k % extent[which, 0], k // np.maximum(extent[which, 0], 1)], axis=1)
    corner = p[which]
    share = np.stack(
        [_cross(corner[:, (i + 2) % 3] - corner[:, (i + 1) % 3], at - corner[:, (i + 1) % 3])
         for i in range(3)], axis=1,
    ) / area[which, None]  # fmt: skip
    inside = (share >= 0).all(axis=1)
    which, at, share = which[inside], at[inside], share[inside]
    near = (share * z[which]).sum(axis=1)
    pixel = at[:, 1] * size + at[:, 0]
    order = np.argsort(near, kind="stable")
    nearer = order[near[order] > depth[pixel[order]]]
    depth[pixel[nearer]] = near[nearer]
    front[pixel[nearer]] = area[which[nearer]] > 0


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
