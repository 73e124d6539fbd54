"""Small orthographic pictures of a mesh in numpy: what its outline is, which side shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.geometry import Mesh


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
    for batch in np.array_split(mesh.triangles, -(-len(mesh.triangles) // 20_000)):
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
    # Twice the signed area of the triangle, and of those a point at (x, y) makes with each side:
    # the latter are slope · x + offset, and all have the sign of the former inside.
    opposite, after = p[:, [1, 2, 0]], p[:, [2, 0, 1]]
    side = after - opposite
    area = side[:, 2, 0] * side[:, 0, 1] - side[:, 2, 1] * side[:, 0, 0]
    flip = np.sign(area)[:, None]
    which, y = _spans(p[..., 1].min(axis=1), p[..., 1].max(axis=1), size, area != 0)
    slope = (-side[..., 1] * flip)[which]
    ox, oy = opposite[which, :, 0], opposite[which, :, 1]
    offset = side[which, :, 0] * (y[:, None] - oy) + side[which, :, 1] * ox
    offset *= flip[which]
    with np.errstate(divide="ignore", invalid="ignore"):
        bound = -offset / slope
    low = np.where(slope > 0, bound, -np.inf).max(axis=1)
    high = np.where(slope < 0, bound, np.inf).min(axis=1)
    beside = ((slope == 0) & (offset < 0)).any(axis=1)
    row, x = _spans(low, high, size, ~beside)
    which, y = which[row], y[row]
    share = (slope[row] * x[:, None] + offset[row]) / np.abs(area[which])[:, None]
    near = (share * z[which]).sum(axis=1)
    pixel = y * size + x
    order = np.argsort(near, kind="stable")
    nearer = order[near[order] > depth[pixel[order]]]
    depth[pixel[nearer]] = near[nearer]
    front[pixel[nearer]] = area[which[nearer]] > 0


def _spans(
    low: NDArray[np.float64], high: NDArray[np.float64], size: int, used: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The whole numbers in [0, size) of each used interval: its index and the number."""
    first = np.ceil(np.clip(low, -0.5, size)).astype(int)
    last = np.floor(np.clip(high, -1, size - 1)).astype(int)
    count = np.where(used, np.maximum(last - first + 1, 0), 0)
    which = np.repeat(np.arange(len(first)), count)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count) + first[which]
