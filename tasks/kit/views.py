"""Cameras from which scenes are judged, and how far there is to go: what worlds say of themselves
is made of these."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera, look_at

VIEWS = 6
RISES = (0.0, 0.6, -0.6)  # radians above the middle, in turn
HEADINGS = 4


def round_the_middle(first: Camera) -> list[Camera]:
    """From around the origin at the first camera's distance: level, above and below in turn."""
    distance = float(np.linalg.norm(first.eye))
    cameras = []
    for k in range(VIEWS):
        turn, rise = 2 * np.pi * k / VIEWS, RISES[k % len(RISES)]
        flat = np.cos(rise)
        eye = distance * np.array([flat * np.sin(turn), np.sin(rise), flat * np.cos(turn)])
        fov_y, near, far = first.fov_y, first.near, first.far
        cameras.append(look_at(eye, np.zeros(3), fov_y=fov_y, near=near, far=far))
    return cameras


def headings(first: Camera, places: Sequence[NDArray[np.float64]]) -> list[Camera]:
    """To four sides from each of the places (3,), through the first camera's lens."""
    cameras = []
    for eye in places:
        for k in range(HEADINGS):
            turn = 2 * np.pi * k / HEADINGS
            ahead = eye + np.array([np.sin(turn), 0.0, -np.cos(turn)])
            fov_y, near, far = first.fov_y, first.near, first.far
            cameras.append(look_at(eye, ahead, fov_y=fov_y, near=near, far=far))
    return cameras


def nearest_next(first: Camera, asked: NDArray[np.float64]) -> float:
    """From the camera past every place asked for (n, 3), always to the nearest one next, straight
    and on the level."""
    left = list(asked[:, [0, 2]])
    way = [first.eye[[0, 2]]]
    while left:
        nearest = min(range(len(left)), key=lambda i: float(np.linalg.norm(left[i] - way[-1])))
        way.append(left.pop(nearest))
    return float(sum(np.linalg.norm(b - a) for a, b in pairwise(way)))
