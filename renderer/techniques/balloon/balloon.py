"""Balloon probe (Elmqvist 2005): a ball at the pointer pushes things aside.

Things whose centre lies in the ball move to its surface, straight away from its centre, and a
thin rod leads from where they were. Targets move as well; what may not be seen through, and what is
larger than the ball, stays. Pointer, wheel and keys move the ball. Distances between things, and
what lies beside what, are no longer what they were.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from seethrough.renderer.declared import key
from seethrough.renderer.events import Event
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import base, pointing
from seethrough.renderer.techniques.base import Floats, Gesture, Shot, Shown, Texts
from seethrough.renderer.techniques.pointing import Pointing

ROD = (0.25, 0.25, 0.28)


TEXTS: Texts = {
    "en": {
        "balloon.controls": "Things near the pointer move aside. Q and E, or the wheel, bring "
        "the place where they do nearer and move it farther away.",
        "balloon.controls.walking": "Things in the middle of the view move aside. Q and E, or "
        "the wheel, bring the place where they do nearer and move it farther away.",
    },
    "de": {
        "balloon.controls": "Was nahe beim Zeiger steht, weicht zur Seite. Q und E oder das "
        "Rad holen die Stelle näher und schieben sie weiter weg.",
        "balloon.controls.walking": "Was in der Mitte des Bildes steht, weicht zur Seite. Q "
        "und E oder das Rad holen die Stelle näher und schieben sie weiter weg.",
    },
}


@dataclass(frozen=True)
class BalloonParameters(base.Parameters):
    """How large the ball is, and where at first."""

    radius: float = key(3.0, "of the ball", "world units", low=0.001, high=10_000)
    depth: float = key(
        12.0, "how far the ball is from the viewer at first", "world units", low=0.01, high=10_000
    )
    step: float = key(0.1, "by which share a key or the wheel moves it", low=0, high=1)
    trace: float = key(
        0.02, "thickness of the rods to where things were, a part of the radius; 0: none",
        low=0, high=1,
    )  # fmt: skip


class Balloon(base.Plain[BalloonParameters, Pointing]):
    """Things move; how their surfaces show does not change."""

    name = "balloon"
    title = "Balloon probe"
    instruction = "Things near the pointer move aside: Q and E move it nearer and farther."
    source = "Elmqvist2005"
    takes = frozenset({"pointer", "wheel", "key:q", "key:e"})
    texts = TEXTS
    Parameters = BalloonParameters

    def begin(self, p: BalloonParameters) -> Pointing:
        """At the middle of the view, at its first depth."""
        return Pointing(None, p.depth)

    def on_event(
        self, p: BalloonParameters, state: Pointing, event: Event, shot: Shot
    ) -> tuple[Pointing, bool]:
        """The pointer carries the ball, keys and wheel move it away."""
        return pointing.followed(state, event, p.step)

    def reach(
        self, p: BalloonParameters, state: Pointing, shot: Shot, point: Floats
    ) -> tuple[Gesture, ...]:
        """The pointer goes there, the wheel brings it as far."""
        return pointing.reaching(state, shot, point, p.step)

    def shown(self, p: BalloonParameters, state: Pointing, shot: Shot) -> Shown:
        """The scene with things moved, and rods behind the last of its objects."""
        scene = shot.scene
        middle = shot.camera.eye + state.direction(shot) * state.depth
        moves = pushed(scene, middle, p.radius)
        moved = np.nonzero(moves.any(axis=1))[0]
        if not len(moved):
            return Shown(scene)
        moves, objects = moves[moved], list(scene.objects)
        transforms = scene.transforms[moved]
        transforms[:, :3, 3] += moves
        for k, transform in zip(moved.tolist(), transforms, strict=True):
            objects[k] = replace(objects[k], transform=transform)
        if p.trace > 0:
            for transform in rods(scene.centers[moved], moves, p.trace * p.radius):
                objects.append(Object(_box(), transform, ROD, kind="rod"))
        return Shown(replace(scene, objects=tuple(objects)))


def pushed(scene: Scene, middle: Floats, radius: float) -> Floats:
    """(n, 3) how far each object moves, 0 for those that stay."""
    away = scene.centers - middle
    distance = np.linalg.norm(away, axis=1)
    moving = (distance < radius) & (scene.radii < radius) & ~scene.impenetrable
    straight = np.where(distance[:, None] > 0, away / np.maximum(distance, 1e-300)[:, None], 0.0)
    straight[distance == 0] = (0.0, 1.0, 0.0)
    found: Floats = np.where(moving[:, None], straight * (radius - distance)[:, None], 0.0)
    return found


@cache
def _box() -> geometry.Mesh:
    return geometry.box()


def rods(starts: Floats, moves: Floats, thickness: float) -> Floats:
    """(k, 4, 4) transforms that make of a cube of side 1 a rod from each point (k, 3) along its
    move (k, 3)."""
    along = moves / np.linalg.norm(moves, axis=1, keepdims=True)
    upright = np.abs(along[:, 1:2]) >= 0.9
    side = np.cross(along, np.where(upright, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    found = np.tile(np.eye(4), (len(moves), 1, 1))
    found[:, :3, 0] = side * thickness
    found[:, :3, 1] = moves
    found[:, :3, 2] = np.cross(side, along) * thickness
    found[:, :3, 3] = starts + moves / 2
    return found


TECHNIQUE = Balloon()
