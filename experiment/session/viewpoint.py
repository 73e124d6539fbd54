"""Where the picture on an instruction page is taken from: where it shows most of what is asked for.

Chosen on the CPU, from the exact surfaces at low resolution, so that every machine has the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.reference.pixel_fragments import fragments
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Example

SIZE = (64, 48)  # of the pictures in which pixels are counted


def best(scene: Scene, example: Example) -> Camera:
    """The camera that shows the most things asked for, and the most of each: the sum of the roots
    of their visible pixels. The first of equal ones."""
    asked = list(example.asked)
    scores = [np.sqrt(shown(scene, camera)[asked]).sum() for camera in example.cameras]
    return example.cameras[int(np.argmax(scores))]


def shown(scene: Scene, camera: Camera, size: tuple[int, int] = SIZE) -> NDArray[np.int64]:
    """(n,) pixels in which each object of the scene is the nearest surface."""
    near = np.nonzero(_in_view(scene, camera, size[0] / size[1]))[0]
    part = Scene(tuple(scene.objects[i] for i in near))
    counts = np.zeros(len(scene.objects), dtype=np.int64)
    if len(near):
        depth = fragments(part, camera, size).depth
        first = depth.argmin(axis=0)[np.isfinite(depth.min(axis=0))]
        counts[near] = np.bincount(first, minlength=len(near))
    return counts


def _in_view(scene: Scene, camera: Camera, aspect: float) -> NDArray[np.bool_]:
    """(n,) which objects' spheres reach into the view: others cost time and show nothing."""
    seen = (scene.centers - camera.eye) @ camera.rotation
    depth, radii = -seen[:, 2], scene.radii
    inside = (depth + radii > camera.near) & (depth - radii < camera.far)
    up = np.tan(camera.fov_y / 2)
    for across, slope in ((seen[:, 0], up * aspect), (seen[:, 1], up)):
        inside &= (np.abs(across) - slope * depth) / np.hypot(1, slope) < radii
    return inside
