"""Visibility tables: what can be seen from a lattice of viewpoints, so that nothing is drawn twice.

A table belongs to one scene drawn with one technique. A look is answered for the nearest viewpoint
of the lattice: exact where the participant stands on it, sampled elsewhere. A viewpoint that no
table holds yet is drawn once, at the lattice's own pose, so that a table's content does not depend
on who came first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import asin, atan2, floor, inf, pi

import numpy as np

from seethrough.experiment.people.runs.looks import KeptLooks, Key
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.controls import turned
from seethrough.tasks.kit.skills.places import AHEAD, CELL, DIRECTIONS, STRIDES

YAWS = 12  # of the orbit's lattice: every 30°
PITCHES = (-1.25, -0.8, -0.35, 0.0, 0.35, 0.8, 1.25)

POSES, HEADINGS = 4, 24  # of a scene's lattice: poses a unit, and to how many sides

# Of each heading, the viewpoints from one cell to the next: the third word of their keys, and how
# far in x and z they lie from the first cell's middle, in cells.
PASSED = [
    [(heading + part * DIRECTIONS, part / parts * x, part / parts * z) for part in range(parts)]
    for heading, (parts, (x, z)) in enumerate(zip(STRIDES, AHEAD, strict=True))
]

Draw = Callable[[Scene, Camera], Visibility]


def orbit_key(camera: Camera) -> Key:
    """The nearest lattice viewpoint of an orbit: number of its yaw, number of its pitch."""
    r = camera.rotation
    yaw = atan2(-r[2, 0], r[0, 0])
    pitch = asin(min(1.0, max(-1.0, r[1, 2])))
    return (round(yaw / (2 * pi / YAWS)) % YAWS, _nearest_pitch(pitch))


def _nearest_pitch(pitch: float) -> int:
    return min(range(len(PITCHES)), key=lambda k: abs(PITCHES[k] - pitch))


def orbit_camera(camera: Camera, key: Key) -> Camera:
    """The lattice's camera at `key`, at the distance and with the lens of `camera`."""
    rotation = turned(key[0] * 2 * pi / YAWS, -PITCHES[key[1]])
    distance = float(np.linalg.norm(camera.eye))
    return Camera(rotation[:, 2] * distance, rotation, camera.fov_y, camera.near, camera.far)


def views_of(heights: Sequence[float], camera: Camera) -> list[Camera]:
    """The lattice viewpoints of an orbit that lie so high, in radians, and where it begins."""
    keys = [(yaw, _nearest_pitch(h)) for h in heights for yaw in range(YAWS)]
    return [camera, *(orbit_camera(camera, key) for key in keys)]


def walk_key(camera: Camera) -> Key:
    """The nearest lattice viewpoint of a walk: cell in x, cell in z, heading.

    Headings from 8 on are passed on the way to the next cell: 8 and more after the first of the
    equal parts that a step in that heading is walked in (`STRIDES`), 16 and more after the second.
    """
    yaw = atan2(-camera.rotation.item(2, 0), camera.rotation.item(0, 0))
    heading = round(yaw / (2 * pi / DIRECTIONS)) % DIRECTIONS
    x, _, z = camera.eye.tolist()
    x, z = x / CELL, z / CELL
    key, nearest = (0, 0, 0), inf
    for number, across, along in PASSED[heading]:
        i, j = floor(x - across), floor(z - along)
        way = abs(i + 0.5 + across - x) + abs(j + 0.5 + along - z)
        if way < nearest:
            key, nearest = (i, j, number), way
    return key


def walk_camera(camera: Camera, key: Key) -> Camera:
    """The lattice's camera at `key`, at the height and with the lens of `camera`."""
    part, heading = divmod(key[2], DIRECTIONS)
    across, along = AHEAD[heading]
    share = part / STRIDES[heading]
    x, z = key[0] + 0.5 + share * across, key[1] + 0.5 + share * along
    eye = np.array([x * CELL, camera.eye[1], z * CELL])
    rotation = turned(heading * 2 * pi / DIRECTIONS)
    return Camera(eye, rotation, camera.fov_y, camera.near, camera.far)


def pose_key(camera: Camera) -> Key:
    """The nearest pose of a scene that one walks in or steps through: place in quarters of a unit,
    heading in 24ths of a turn, pitch in 24ths of half a turn."""
    r = camera.rotation
    yaw, pitch = atan2(-r[2, 0], r[0, 0]), asin(min(1.0, max(-1.0, r[1, 2])))
    x, y, z = (round(v * POSES) for v in camera.eye.tolist())
    step = 2 * pi / HEADINGS
    return (x, y, z, round(yaw / step) % HEADINGS, round(pitch / step))


def pose_camera(camera: Camera, key: Key) -> Camera:
    """The lattice's camera at `key`, with the lens of `camera`."""
    step = 2 * pi / HEADINGS
    eye = np.array(key[:3]) / POSES
    rotation = turned(key[3] * step, -key[4] * step)
    return Camera(eye, rotation, camera.fov_y, camera.near, camera.far)


LATTICES: dict[str, tuple[Callable[[Camera], Key], Callable[[Camera, Key], Camera]]] = {
    "orbit": (orbit_key, orbit_camera),
    "walk": (walk_key, walk_camera),
    "poses": (pose_key, pose_camera),
}


class TableEyes:
    """Looks up, or draws and keeps, what is seen of a scene of so many objects.

    Raises KeyError if it can't draw.
    """

    def __init__(
        self, looks: KeptLooks, name: str, objects: int, moving: str, draw: Draw | None = None
    ) -> None:
        self.looks, self.name, self.objects = looks, name, objects
        self.draw = draw
        self._key, self._camera = LATTICES[moving]

    def nearest(self, camera: Camera) -> Camera:
        """The lattice's camera that answers for `camera`."""
        return self._camera(camera, self._key(camera))

    def look(self, scene: Scene, camera: Camera) -> Visibility:
        """What is visible from the lattice viewpoint nearest to `camera`."""
        key = self._key(camera)
        try:
            return self.looks.get(self.name, self.objects, key)
        except KeyError:
            if self.draw is None:
                raise
        self.looks.put(self.name, key, self.draw(scene, self._camera(camera, key)))
        return self.looks.get(self.name, self.objects, key)


def moved(
    seen: Visibility, scene: Scene, lattice: Camera, camera: Camera, aspect: float
) -> Visibility:
    """A look from the lattice's camera with each thing where another one near it shows it, in a
    view so wide for its height: what is clicked is what lies there, not where the lattice has it.
    What only the lattice's view holds is not seen."""
    shift = (camera.places(scene.centers) - lattice.places(scene.centers)) * [0.5, -0.5]
    place = seen.position + shift  # view units: half-heights of a camera, y down
    ahead = np.minimum(lattice.depth(scene.centers), camera.depth(scene.centers)) > 0
    inside = ahead & (place >= 0).all(axis=1) & (place <= [aspect, 1.0]).all(axis=1)
    return Visibility(
        np.where(inside, seen.pixels, 0),
        np.where(inside, seen.weight, 0.0),
        np.where(inside[:, None], place, np.nan),
        np.where(inside, seen.contrast, 0.0),
        np.where(inside, seen.area, 0.0),
    )
