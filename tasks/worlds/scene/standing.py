"""How one moves in a scene of a file: turning it, walking with the pointer free, fixed views."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import asin, atan, atan2, sin, tan

import numpy as np

from seethrough.renderer.events import Event, KeyPress
from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.clicking import of_free_pointer
from seethrough.tasks.kit.controls import MARGIN, Held, Orbit, Walk, changed
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters
from seethrough.tasks.worlds.scene.scene_place import ScenePlace

ROUND = 8  # fixed views of a file that has no cameras
BEFORE = 1.3  # radii from the middle, where one begins who walks


@dataclass(frozen=True)
class DragWalk(Walk):
    """A walker whose pointer is free: it turns while the left button is down."""

    near: float = 0.1

    def on_event(self, event: Event) -> Walk:
        """As `Walk`, but that moves without the button turn nothing."""
        return super().on_event(of_free_pointer(event))

    def camera(self) -> Camera:
        """What the walker sees: things in reach of the hands as well."""
        return replace(super().camera(), near=self.near)


@dataclass(frozen=True)
class Fixed:
    """One of some cameras at a time; the left and right arrow keys step to the one before and
    after."""

    cameras: tuple[Camera, ...]
    at: int = 0
    held: Held = field(default_factory=Held)

    def on_event(self, event: Event) -> Fixed:
        """The view after `event`."""
        step = 0
        if isinstance(event, KeyPress):
            step = (event.key == "right") - (event.key == "left")
        at = (self.at + step) % len(self.cameras)
        return changed(self, at=at, held=self.held.after(event))

    def camera(self) -> Camera:
        """What is seen."""
        return self.cameras[self.at]


def standing(place: ScenePlace, p: SceneParameters, aspect: float) -> Orbit | Walk | Fixed:
    """Where one begins: at the place's camera of that name, where there is one."""
    start = place.cameras.get(place.start)
    if p.move == "walk":
        return _walking(place, p, start or next(iter(place.cameras.values()), None))
    around = _orbit(place, p, aspect, start)
    if p.move == "orbit":
        return around
    cameras = tuple(place.cameras.values())
    if not cameras:
        steps = (2 * np.pi * k / ROUND for k in range(ROUND))
        cameras = tuple(changed(around, yaw=float(yaw)).camera() for yaw in steps)
    return Fixed(cameras, list(place.cameras).index(place.start) if start is not None else 0)


def _orbit(place: ScenePlace, p: SceneParameters, aspect: float, start: Camera | None) -> Orbit:
    """All of it lies in the view; one begins on the side of the camera, where there is one."""
    half = min(p.fov_y / 2, atan(tan(p.fov_y / 2) * aspect))
    distance = MARGIN * place.radius / sin(half)
    yaw, pitch = 0.0, p.start_pitch
    if start is not None and (length := float(np.linalg.norm(start.eye))) > 0:
        x, y, z = (start.eye / length).tolist()
        yaw, pitch = atan2(x, z), asin(max(-1.0, min(1.0, y)))
    return Orbit(yaw, pitch, distance, place.radius, p.fov_y, p.drag_gain, p.key_rate)


def _walking(place: ScenePlace, p: SceneParameters, start: Camera | None) -> DragWalk:
    corners = place.scene.corners.reshape(-1, 3)
    (low, high), middle = (corners.min(axis=0), corners.max(axis=0)), corners.mean(axis=0)
    reach = float(np.linalg.norm(high - low))
    x, z, yaw = float(middle[0]), float(high[2] + (BEFORE - 1) * reach / 2), 0.0
    if start is not None:
        (x, _, z), back = start.eye.tolist(), start.rotation[:, 2]
        yaw = atan2(back[0], back[2])
    floor = float(np.clip(0.0, low[1], high[1]))  # the file's own ground, where it has one
    far = 4 * reach
    return DragWalk(
        x, z, yaw, floor + p.eye_height, far, p.fov_y, p.speed, p.drag_gain, p.key_rate,
        near=min(0.1, 0.01 * reach),
    )  # fmt: skip
