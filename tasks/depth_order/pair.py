"""Two things in a view, told apart by a mark each, one clearly nearer than the other."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Setting
from seethrough.tasks.kit.controls import changed
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.kit.world import Place, Viewer

ASPECT = 4 / 3  # of the view that has to hold both: none that a study opens is narrower
INSIDE = 0.85  # of the half view: marks lie clear of its border
APART = 0.25  # half view heights between the marks, at least
MOST_PLACES = 50
SIDES = {"orbit": 12, "walk": 8}  # to which a viewer may be turned
LIFT = 0.055  # view heights from the upper edge of a mark down to the middle of its thing


@dataclass(frozen=True, eq=False)
class Marked:
    """A place, from where it is seen, and the two things that are marked in it, A and B."""

    place: Place
    camera: Camera
    pair: tuple[int, int]

    @property
    def scene(self) -> Scene:
        """Everything that stands there."""
        return self.place.scene

    @property
    def nearer(self) -> int:
        """0 where A is nearer, 1 where B is."""
        a, b = depths(self.camera, self.scene, self.pair)
        return int(b < a)

    def marks(self) -> NDArray[np.float64]:
        """(2, 2) where the two are, in half view heights from the middle of the view, y up."""
        return self.camera.places(self.scene.centers[list(self.pair)])


def marked(rng: Generator, setting: Setting, ratio: float) -> Marked:
    """A place of the world's, and two of its targets in one of its views, at random.

    Raises NoScene where the world has no such two.
    """
    for _ in range(MOST_PLACES):
        place = setting.world.make(rng, setting.place)
        views = _views(setting.world.viewer(place, setting.place, ASPECT), setting.world.moving)
        for number in rng.permutation(len(views)):
            found = _pairs(place.scene, views[number], ratio)
            if found:
                a, b = found[int(rng.integers(len(found)))]
                pair = (a, b) if rng.random() < 0.5 else (b, a)
                return Marked(place, views[number], pair)
    raise NoScene(
        f"task.depth_order.ratio = {ratio:g}: expected two targets in one view of the world "
        f"{setting.world.name}, clearly apart in it, whose depths differ so much"
    )


@runtime_checkable
class _Turned(Viewer, Protocol):
    """A viewer that looks another way with another `yaw`."""

    yaw: float


def _views(viewer: Viewer, moving: str) -> list[Camera]:
    """The start's view turned to every side, by steps that data mode has looks for."""
    if not isinstance(viewer, _Turned):
        return [viewer.camera()]
    sides = SIDES[moving]
    yaws = (viewer.yaw + 2 * np.pi * k / sides for k in range(sides))
    return [changed(viewer, yaw=float(yaw)).camera() for yaw in yaws]


def _pairs(scene: Scene, camera: Camera, ratio: float) -> list[tuple[int, int]]:
    things = np.nonzero(scene.targets)[0]
    depth = np.array(depths(camera, scene, tuple(things.tolist())))
    at = camera.places(scene.centers[things])
    inside = (depth > camera.near) & (np.abs(at) < [INSIDE * ASPECT, INSIDE]).all(axis=1)
    found = []
    for i, j in combinations(np.nonzero(inside)[0], 2):
        far, near = max(depth[i], depth[j]), min(depth[i], depth[j])
        if far >= ratio * near and np.hypot(*(at[i] - at[j])) >= APART:
            found.append((int(things[i]), int(things[j])))
    return found


def depths(camera: Camera, scene: Scene, things: tuple[int, ...]) -> list[float]:
    """View depth of the middles of things."""
    found: list[float] = camera.depth(scene.centers[list(things)]).tolist()
    return found
