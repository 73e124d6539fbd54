"""Cameras for the picture on a task's instruction page, from which the best is chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan, pi

import numpy as np

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.controls import Orbit, changed

YAWS = 8  # of an orbit


def around(orbit: Orbit, pitches: Sequence[float], aspect: float) -> tuple[Camera, ...]:
    """Cameras all around the cube, which fills a picture of that width / height."""
    half = orbit.reach / 3**0.5
    corners = half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    found = []
    for pitch in pitches:
        for k in range(YAWS):
            camera = changed(orbit, yaw=2 * pi * k / YAWS, pitch=pitch).camera()
            seen = (corners - camera.eye) @ camera.rotation
            across = np.abs(seen[:, :2]) / -seen[:, 2:] / [aspect, 1.0]
            found.append(replace(camera, fov_y=2 * atan(float(across.max()))))
    return tuple(found)
