"""The camera as a frame's shaders have it."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.arrays import Floats
from seethrough.renderer.plan.planner import FramePlan
from seethrough.renderer.scene.camera import Camera


def clip_from_offset(camera: Camera, size: tuple[int, int]) -> bytes:
    """clip ← (world − eye), for GLSL."""
    turn = np.eye(4)
    turn[:3, :3] = camera.rotation.T
    return (camera.projection(size[0] / size[1]) @ turn).T.astype("f4").tobytes()


def tight(camera: Camera, frame: FramePlan) -> Camera:
    """The camera with its depth range closed in on what is drawn: more bits for each unit."""
    seen = np.nonzero(frame.boxes.inside)[0]
    if not len(seen):
        return camera
    near = max(camera.near, float(frame.boxes.near[seen].min()) * (1 - 1e-6))
    far = min(camera.far, float(frame.boxes.far[seen].max()) * (1 + 1e-6))
    if near >= far:
        return camera
    return Camera(camera.eye, camera.rotation, camera.fov_y, near, far)


def depth_values(camera: Camera, points: Floats) -> Floats:
    """(n,) what the depth buffer holds, 0 to 1, of points (n, 3); −1 behind the eye."""
    depth = camera.depth(points)
    safe = np.where(depth > 0, depth, 1.0)
    return np.where(depth > 0, camera.far / (camera.far - camera.near) * (1 - camera.near / safe), -1.0)
