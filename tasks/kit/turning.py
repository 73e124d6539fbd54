"""A thing alone, turning in the upper left corner of the view (Elmqvist2009 §VI)."""

from __future__ import annotations

from functools import partial
from math import sin

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.controls import turned
from seethrough.tasks.kit.hud import Inset, Rect

PLACE = Rect(0.02, 0.02, 0.22, 0.22)
FOV_Y = 0.7
PITCH = -0.35
TURN_RATE = 0.8  # radians a second: once round in eight seconds


def inset(picture: Scene, time: float) -> Inset:
    """A scene of one thing, at `time`."""
    return Inset(picture, partial(_camera, picture, time), PLACE)


def _camera(picture: Scene, time: float) -> Camera:
    """Turned by then; the thing fits the frame whichever way it is turned."""
    rotation = turned(TURN_RATE * time, PITCH)
    distance = 1.1 * float(picture.radii[0]) / sin(FOV_Y / 2)
    eye = picture.centers[0] + rotation[:, 2] * distance
    return Camera(eye, rotation, FOV_Y, 0.05 * distance, 2 * distance)
