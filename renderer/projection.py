"""From world to window: pixels have their origin in the upper left corner, y down.

The centre of the pixel in column c and row r is (c + 0.5, r + 0.5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renderer.camera import Camera

_EDGES = np.array(
    [(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1],
    dtype=np.int64,
)


@dataclass(frozen=True, eq=False)
class Boxes:
    """What objects cover on the screen, at most.

    extents (n, 4): left, top, right, bottom in pixels; near, far (n,): view depths of the nearest
    and farthest corner; crosses (n,): whether the near plane cuts the box; within (n,): whether
    any of it lies between the near and far planes; inside (n,): whether it can be in the picture.
    """

    extents: NDArray[np.float64]
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
    scale = 0.5 * height / np.tan(camera.fov_y / 2)
    depth = -points[..., 2]
    x = 0.5 * width + scale * points[..., 0] / depth
    y = 0.5 * height - scale * points[..., 1] / depth
    return np.stack([x, y], axis=-1)


def screen_boxes(corners: NDArray[np.float64], camera: Camera, size: tuple[int, int]) -> Boxes:
    """Extents on the screen of (n, 8, 3) world boxes, cut at the near plane.

    The corners of a box come in the order of their bits: corner k is high in x if k & 4.
    """
    points = to_camera(corners, camera)
    depth = -points[..., 2]
    ahead = depth >= camera.near
    safe = points.copy()
    safe[..., 2] = np.minimum(points[..., 2], -camera.near)
    flat = to_pixels(safe, camera, size)
    low = np.where(ahead[..., None], flat, np.inf).min(axis=1, initial=np.inf)
    high = np.where(ahead[..., None], flat, -np.inf).max(axis=1, initial=-np.inf)
    crosses = ahead.any(axis=1) & ~ahead.all(axis=1)
    if crosses.any():
        _add_cuts(low, high, np.nonzero(crosses)[0], points, depth, camera, size)
    near, far = depth.min(axis=1, initial=np.inf), depth.max(axis=1, initial=-np.inf)
    within = (far > camera.near) & (near < camera.far)
    inside = within & (high > 0).all(axis=1) & (low < np.array(size)).all(axis=1)
    return Boxes(np.concatenate([low, high], axis=1), near, far, crosses, within, inside)


def _add_cuts(
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    depth: NDArray[np.float64],
    camera: Camera,
    size: tuple[int, int],
) -> None:
    """Widen the extents by the points where the near plane cuts the boxes' edges."""
    a, b = points[rows][:, _EDGES[:, 0]], points[rows][:, _EDGES[:, 1]]
    da, db = depth[rows][:, _EDGES[:, 0]], depth[rows][:, _EDGES[:, 1]]
    cut = (da < camera.near) != (db < camera.near)
    t = np.where(cut, (camera.near - da) / np.where(cut, db - da, 1.0), 0.0)
    cuts = a + t[..., None] * (b - a)
    cuts[..., 2] = -camera.near
    flat = to_pixels(cuts, camera, size)
    low[rows] = np.minimum(low[rows], np.where(cut[..., None], flat, np.inf).min(axis=1))
    high[rows] = np.maximum(high[rows], np.where(cut[..., None], flat, -np.inf).max(axis=1))
