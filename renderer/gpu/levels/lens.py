"""The camera as a frame's shaders have it."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.scene.camera import Camera


def clip_from_offset(camera: Camera, size: tuple[int, int]) -> bytes:
    """clip ← (world − eye), for GLSL."""
    turn = np.eye(4)
    turn[:3, :3] = camera.rotation.T
    return (camera.projection(size[0] / size[1]) @ turn).T.astype("f4").tobytes()


def tight(camera: Camera, frame: FramePlan) -> Camera:
    """The camera with its depth range closed in on what is drawn: more bits for each unit."""
    nearest, farthest = frame.depths
    near, far = max(camera.near, nearest * (1 - 1e-6)), min(camera.far, farthest * (1 + 1e-6))
    if near >= far:
        return camera
    return Camera(camera.eye, camera.rotation, camera.fov_y, near, far)
