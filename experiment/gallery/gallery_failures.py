"""Where each technique fails: a scene, what is measured in it, and how bad it gets.

No technique is right for every scene. What is shown here is not a fault of its painter: the exact
picture has it as well, and tests/images/test_technique_failures.py holds its measure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from seethrough.renderer.reference.reference import ExactPicture, exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import changed, named
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

RED, GREY, BLUE, GREEN = (0.9, 0.2, 0.1), (0.7, 0.7, 0.65), (0.2, 0.5, 0.9), (0.3, 0.75, 0.35)
CAMERA = look_at(np.array([0.0, 0.6, 9.0]), np.zeros(3), fov_y=0.5, near=1, far=60)
SIZE = (120, 90)

# (the exact picture, that of each target alone, the standard one) → what is bad about it
Measure = Callable[[ExactPicture, ExactPicture, ExactPicture], float]


@dataclass(frozen=True, eq=False)
class Failure:
    """A technique (its parameters) in a scene, in words, and the measure of what goes wrong: it is
    `worse` than the bound that a good picture keeps to. `left`: how much of a wall before a target
    hides it with default parameters, at most, the pointer at it: its opacity where it is not
    removed."""

    words: str
    parameters: Parameters
    scene: Scene
    measure: Measure
    bound: float
    left: float = 0.02
    camera: Camera = CAMERA

    def measured(self) -> float:
        """The measure, on the exact pictures."""
        return self.measure(
            exact(self.scene, self.camera, self.parameters, SIZE),
            self._alone(),
            exact(self.scene, self.camera, Standard(), SIZE),
        )

    def _alone(self) -> ExactPicture:
        """Each target as if nothing else were there, not even other targets."""
        targets = [o for o in self.scene.objects if o.target]
        every = Scene(tuple(targets), self.scene.background)
        together = exact(every, self.camera, Standard(), SIZE)
        for k, target in enumerate(targets):
            alone = Scene((target,), self.scene.background)
            together.weights[k] = exact(alone, self.camera, Standard(), SIZE).weights[0]
        return together


def hidden(k: int) -> Measure:
    """The part of the k-th target (the last objects are targets) that nobody can see."""

    def measure(picture: ExactPicture, alone: ExactPicture, plain: ExactPicture) -> float:
        count = len(alone.weights)
        shown = picture.weights[len(picture.weights) - count + k].sum()
        return float(1 - shown / max(alone.weights[k].sum(), 1e-9))

    return measure


def gone(k: int) -> Measure:
    """The part of what the standard picture shows of the k-th object that no longer shows."""

    def measure(picture: ExactPicture, alone: ExactPicture, plain: ExactPicture) -> float:
        there = plain.weights[k] > 0
        return float(1 - picture.weights[k][there].sum() / max(there.sum(), 1))

    return measure


def void(k: int) -> Measure:
    """The part of what the standard picture shows of the k-th object where nothing is left at all:
    neither it, nor a wall where it is cut, nor what is behind it."""

    def measure(picture: ExactPicture, alone: ExactPicture, plain: ExactPicture) -> float:
        there = plain.weights[k] > 0
        return float((picture.weights.sum(axis=0)[there] == 0).mean())

    return measure


def _wall(z: float = 2.0, target: bool = False, impenetrable: bool = False) -> Object:
    place = transforms.translation(0, 0, z)
    return Object(geometry.box(7, 5, 0.2), place, GREY, target=target, impenetrable=impenetrable)


def _ball(x: float, z: float, radius: float = 0.8) -> Object:
    place = transforms.placed((x, 0, z), None, radius)
    return Object(geometry.sphere(1.0, 2), place, RED, target=True)


def _panes(count: int) -> list[Object]:
    return [
        Object(geometry.box(5, 4, 0.05), transforms.translation(0, 0, 3 - 0.3 * k), BLUE)
        for k in range(count)
    ]


def _bars(rows: int) -> list[Object]:
    bar = geometry.box(0.12, 5, 0.12)
    return [
        Object(bar, transforms.translation(0.2 * k - 1.5 + 0.05 * row, 0, 3 - 0.3 * row), GREY)
        for row in range(rows)
        for k in range(16)
    ]


def _open() -> Object:
    shell = geometry.sphere(1.0, 3)
    facing = shell.vertices[shell.triangles].mean(axis=1)[:, 2] > 0
    half = replace(shell, triangles=shell.triangles[facing], convex=False)
    return Object(half, transforms.placed((0, 0, 0), None, 2.4), GREEN)


def failures() -> dict[str, Failure]:
    """By the technique's name."""
    at = transforms.translation
    one, far = (_wall(), _ball(0, -2)), (_ball(0, 0.0), _ball(0, -3, 0.5))
    crate = Object(geometry.box(1.6, 1.6, 1.6), at(0, 0, 2), GREEN, kind="crate")
    row = [Object(geometry.box(0.5, 0.5, 0.5), at(0.9 * k - 1.8, 0, 0), BLUE) for k in range(5)]
    lens = named("lens")
    every = (
        Failure("What is behind a wall is not there", Standard(), Scene(one), hidden(0), 0.99, 1.0),
        Failure(
            "Eight panes leave little of the target, each as clear as it may be",
            DynamicTransparency(),
            Scene((*_panes(8), _ball(0, -2))),
            hidden(0),
            0.9,
            left=0.35,
        ),
        Failure(
            "Through twelve layers nothing can be seen",
            named("constant"),
            Scene((*_panes(12), _ball(0, -2))),
            hidden(0),
            0.95,
            left=0.35,
        ),
        Failure(
            "What hides the target has no tag",
            named("see_through"),
            Scene((crate, _ball(0, -2, 0.4))),
            hidden(0),
            0.99,
            left=0.35,
        ),
        Failure(
            "An open mesh has no inside: the cut shows a hole, not a wall",
            named("cutaway"),
            Scene((_open(), _ball(0, 0, 0.5))),
            void(0),
            0.3,
        ),
        Failure(
            "A wide angle takes the context away with the occluder",
            changed(named("adaptive_cutaway"), angle=70.0),
            Scene(one),
            gone_of_wall,
            0.8,
        ),
        Failure(
            "Targets in line: the hole before the far one ends at the near one",
            named("breakaway"),
            Scene((_wall(), *far)),
            hidden(1),
            0.99,
        ),
        Failure(
            "The lens ends before the wall, at the wrong depth",
            changed(lens, depth=4.0),
            Scene(one),
            hidden(0),
            0.99,
        ),
        Failure(
            "Nobody has dug: the technique ignores targets",
            named("dig"),
            Scene(one),
            hidden(0),
            0.99,
        ),
        Failure(
            "Several layers before a target are sparse one by one, and hide it together",
            named("importance"),
            Scene((*_panes(8), _ball(0, -2))),
            hidden(0),
            0.85,
            left=0.3,
        ),
        Failure(
            "The target is elsewhere: only what the pointer is at turns transparent",
            named("fade"),
            Scene((_wall(), _ball(2.2, -2, 0.6))),
            hidden(0),
            0.99,
            left=0.35,
        ),
        Failure(
            "A flat wall that faces the viewer vanishes",
            named("view_dependent"),
            Scene(one),
            gone(0),
            0.85,
            left=0.2,
        ),
        Failure(
            "Lines of many layers clutter what is behind them",
            named("blueprint"),
            Scene((*_bars(4), _ball(0, -2))),
            hidden(0),
            0.7,
            left=0.12,
        ),
        Failure(
            "What stood side by side is torn apart",
            changed(named("balloon"), radius=2.5, depth=9.0),
            Scene((*row,)),
            moved,
            0.2,
            left=1.0,
        ),
    )
    return {failure.parameters.technique.name: failure for failure in every}


def gone_of_wall(picture: ExactPicture, alone: ExactPicture, plain: ExactPicture) -> float:
    """The part of the picture's middle row in which the first object no longer shows."""
    middle = picture.weights[0][SIZE[1] // 2]
    return float((middle < 0.5).mean())


def moved(picture: ExactPicture, alone: ExactPicture, plain: ExactPicture) -> float:
    """How far the second object's centre has moved on the screen, in heights of the view, from
    where it stands in the row."""
    rows, columns = np.nonzero(picture.weights[1] > 0.5)
    scale = CAMERA.lens(SIZE[1]) / 9.0
    stood = SIZE[0] / 2 - 0.9 * scale
    return float(abs(columns.mean() + 0.5 - stood) / SIZE[1]) if len(rows) else 1.0
