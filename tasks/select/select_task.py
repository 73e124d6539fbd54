"""Point at a marked thing that others may hide (Vanacken2007: selecting in dense and occluded
scenes; time and errors)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.random import Generator

from seethrough.renderer.declared import check, key
from seethrough.renderer.events import Event
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Basics, Example, Outcome, Setting, View
from seethrough.tasks.kit.clicking import TAKES, Clicking, clicking, of_free_pointer
from seethrough.tasks.kit.controls import Orbit
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.kit.example import around
from seethrough.tasks.kit.hud import Element, Mark, Sought, hint
from seethrough.tasks.kit.measure import MISSES, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import (
    ANYWHERE,
    Asked,
    ItemWorld,
    Place,
    Texts,
    Viewer,
    WorldParameters,
    moving_of,
)
from seethrough.tasks.select.simulate import STRATEGY

MARKED = (0.95, 0.10, 0.75)  # a colour that nothing of ours has
MARKS = ("under", "over", "both")


@dataclass(frozen=True)
class SelectParameters:
    """What a study may say of the task."""

    mark: str = key(
        "under", "how the thing is marked: by its colour, under what the technique does, or by a "
        "ring over the view that shows through everything", choices=MARKS,
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, eq=False)
class SelectPlace:
    """A place, and the thing in it that is marked: its only target."""

    place: Place
    scene: Scene
    thing: int


SelectSetting: TypeAlias = Setting[WorldParameters, SelectParameters]


@dataclass(frozen=True, eq=False)
class SelectState:
    """A trial between two events."""

    made: SelectPlace
    own: SelectParameters
    viewer: Viewer
    moving: str
    clicking: Clicking
    hit: bool = False


class Select(Basics[SelectState, SelectSetting]):
    """Move, click; or aim with the keys w, a, s, d and press enter."""

    name, code = "select", "S"
    source = "Vanacken2007"
    worlds = ANYWHERE
    takes = TAKES
    Parameters = SelectParameters
    measures: tuple[Measure, ...] = (MISSES,)
    texts: Texts = OwnTexts("seethrough.tasks.select")
    simulate = STRATEGY

    def items(self, setting: SelectSetting) -> int | None:
        """How many things can be asked for, where a file says it."""
        world = setting.world
        return len(world.items(setting.place)) if isinstance(world, ItemWorld) else None

    def controls(self, setting: SelectSetting) -> str:
        """The pointer is free: who walks turns by dragging."""
        walks = moving_of(setting.world, setting.place) == "walk"
        return "scene.walk" if walks else setting.controls

    def make_scene(self, rng: Generator, setting: SelectSetting) -> SelectPlace:
        """A place with one of its targets marked; nothing else is a target. Raises NoScene where
        there is none."""
        asked = _asked(rng, setting)
        scene = asked.scene
        things = [replace(o, target=False) for o in scene.objects]
        old = scene.objects[asked.thing]
        under = setting.task.mark != "over"
        mesh, color = (_plain(old.mesh), MARKED) if under else (old.mesh, old.color)
        things[asked.thing] = replace(old, mesh=mesh, color=color)
        marked = Scene(tuple(things), scene.background)
        return SelectPlace(asked.place, marked, asked.thing)

    def begin(self, made: SelectPlace, setting: SelectSetting, aspect: float) -> SelectState:
        """The first state of a trial."""
        viewer = setting.world.viewer(made.place, setting.place, aspect)
        moving = moving_of(setting.world, setting.place)
        return SelectState(made, setting.task, viewer, moving, clicking(aspect))

    def on_event(self, state: SelectState, event: Event) -> SelectState:
        """The state after `event`."""
        if state.hit:
            return state
        pointed = state.clicking.on_event(event)
        hit = pointed.clicks > state.clicking.clicks and pointed.thing == state.made.thing
        viewer = state.viewer.on_event(of_free_pointer(event))
        return replace(state, viewer=viewer, clicking=pointed, hit=hit)

    def view(self, state: SelectState) -> View:
        """The scene with the marked thing, and the ring over it if the study wants one."""
        camera, made = state.viewer.camera(), state.made
        things, aspect = (made.thing,), state.clicking.aspect
        said = Sought("select.question", (0.02, 0.02), things=things, moving=state.moving)
        hud: list[Element] = [said]
        if state.own.mark != "under":
            hud += _ring(made.scene, made.thing, camera, aspect)
        if state.clicking.clicks and not state.hit:
            hud.append(hint("select.missed", (aspect, 0.98)))
        hud += state.clicking.elements()
        return View(made.scene, camera, tuple(hud), aim=state.clicking.at)

    def outcome(self, state: SelectState) -> Outcome | None:
        """How many clicks missed, once one hit."""
        if not state.hit:
            return None
        said = state.made.scene.objects[state.made.thing].kind
        return Outcome(said, said, True, more={"misses": state.clicking.clicks - 1})

    def example(self, state: SelectState, aspect: float) -> Example:
        """The marked thing."""
        cameras: tuple[Camera, ...] = (state.viewer.camera(),)
        if isinstance(state.viewer, Orbit):
            cameras = around(state.viewer, (state.viewer.pitch, 0.8), aspect)
        return Example((state.made.thing,), cameras)


def _asked(rng: Generator, setting: SelectSetting) -> Asked[Place]:
    """The setting's item, or any target of a place of the world's."""
    world = setting.world
    items: Sequence[Asked[Place]]
    if isinstance(world, ItemWorld):
        items = world.items(setting.place)
    else:
        place = world.make(rng, setting.place)
        items = tuple(Asked(place, int(i)) for i in np.nonzero(place.scene.targets)[0])
    if not items:
        raise NoScene(f"world.{world.name}: expected a target in each of its scenes, one has none")
    drawn = int(rng.integers(len(items)))
    return items[drawn if setting.item is None else setting.item]


@lru_cache(maxsize=64)
def _plain(mesh: Mesh) -> Mesh:
    """The mesh in white, so that the object's colour is what shows."""
    return replace(mesh, colors=np.ones_like(mesh.colors))


def _ring(scene: Scene, thing: int, camera: Camera, aspect: float) -> list[Element]:
    """About the thing, where it lies in the view."""
    x, y, back = ((scene.centers[thing] - camera.eye) @ camera.rotation).tolist()
    if -back <= camera.near:
        return []
    half = 2 * -back * np.tan(camera.fov_y / 2)
    at = (aspect / 2 + x / float(half), 0.5 - y / float(half))
    radius = float(np.clip(scene.radii[thing] / half, 0.02, 0.25))
    inside = -radius < at[0] < aspect + radius and -radius < at[1] < 1 + radius
    return [Mark(at, radius)] if inside else []
