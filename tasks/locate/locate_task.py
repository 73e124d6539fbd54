"""Find a part by its name or picture, and click it: visual search in a scene of many parts.

How well techniques let people find what is inside of something is what cut-aways and their kin are
judged by (Burns2008, Li2007); times and wrong clicks are as in Vanacken2007.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

from numpy.random import Generator

from seethrough.renderer.declared import check, key
from seethrough.renderer.events import Event
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.tasks.kit.base import Basics, Example, Outcome, Setting, View
from seethrough.tasks.kit.clicking import TAKES, Clicking, clicking
from seethrough.tasks.kit.controls import Orbit
from seethrough.tasks.kit.example import around
from seethrough.tasks.kit.hud import Element, Label, Sought, hint
from seethrough.tasks.kit.measure import CORRECT, WRONG_CLICKS, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.turning import inset
from seethrough.tasks.kit.world import Asked, Texts, Viewer
from seethrough.tasks.locate.simulate import STRATEGY
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters
from seethrough.tasks.worlds.scene.scene_place import ScenePlace
from seethrough.tasks.worlds.scene.scene_world import SceneWorld
from seethrough.tasks.worlds.scene.standing import Fixed

SHOW = ("name", "picture", "both")


@dataclass(frozen=True)
class LocateParameters:
    """What a study may say of the task."""

    show: str = key("name", "how the part is asked for", choices=SHOW)
    tries: int = key(
        0, "clicks after which a trial ends, right or wrong; 0: it ends with the right one",
        low=0, high=1000,
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)


LocateSetting: TypeAlias = Setting[SceneParameters, LocateParameters]


@dataclass(frozen=True, eq=False)
class LocateState:
    """A trial between two events. `picture` is the part alone; `wrong` clicks so far."""

    asked: Asked[ScenePlace]
    own: LocateParameters
    viewer: Viewer
    moving: str
    clicking: Clicking
    picture: Scene
    wrong: int = 0
    ended: bool = False


class Locate(Basics[LocateState, LocateSetting]):
    """Move, click; or aim with the keys w, a, s, d and press enter."""

    name, code = "locate", "L"
    source = "Vanacken2007"
    worlds = ("scene",)
    takes = TAKES
    Parameters = LocateParameters
    measures: tuple[Measure, ...] = (WRONG_CLICKS, CORRECT)
    texts: Texts = OwnTexts("seethrough.tasks.locate")
    simulate = STRATEGY

    def items(self, setting: LocateSetting) -> int:
        """How many things can be asked for."""
        return len(_items(setting))

    def make_scene(self, rng: Generator, setting: LocateSetting) -> Asked[ScenePlace]:
        """One of the items: the setting's, or a drawn one. Raises ValueError where none is."""
        items = _items(setting)
        if not items:
            raise ValueError("expected a scene with a target")
        drawn = int(rng.integers(len(items)))
        return items[drawn if setting.item is None else setting.item]

    def begin(self, made: Asked[ScenePlace], setting: LocateSetting, aspect: float) -> LocateState:
        """The first state of a trial."""
        viewer = setting.world.viewer(made.place, setting.place, aspect)
        moving = setting.place.move
        alone = made.place.scene.objects[made.thing]
        centered = alone.transform.copy()
        centered[:3, 3] = 0.0
        picture = Scene((Object(alone.mesh, centered, alone.color),))
        return LocateState(made, setting.task, viewer, moving, clicking(aspect), picture)

    def on_event(self, state: LocateState, event: Event) -> LocateState:
        """The state after `event`."""
        if state.ended:
            return state
        pointed, viewer = state.clicking.on_event(event), state.viewer.on_event(event)
        wrong, ended = state.wrong, False
        if pointed.clicks > state.clicking.clicks:
            right = pointed.thing in state.asked.place.alike(state.asked.thing)
            wrong += not right
            ended = right or pointed.clicks == state.own.tries
        return replace(state, viewer=viewer, clicking=pointed, wrong=wrong, ended=ended)

    def view(self, state: LocateState) -> View:
        """The scene, and over it what is asked for."""
        place, asked, own = state.asked.place, state.asked.thing, state.own
        hud: list[Element] = []
        label = (("what", place.labels[asked]),)
        text = "locate.pictured" if own.show == "picture" else "locate.named"
        left = 0.02
        if own.show != "name":
            hud.append(inset(state.picture, state.clicking.time or 0.0))
            left = 0.26
        values = () if own.show == "picture" else label
        things = place.alike(asked)
        hud.append(Sought(text, (left, 0.02), values=values, things=things, moving=state.moving))
        if state.moving == "fixed" and isinstance(state.viewer, Fixed):
            hud.append(_which(state.viewer, left))
        if state.wrong and not state.ended:
            hud.append(hint("locate.wrong", (state.clicking.aspect, 0.98)))
        hud += state.clicking.elements()
        return View(place.scene, state.viewer.camera(), tuple(hud), aim=state.clicking.at)

    def outcome(self, state: LocateState) -> Outcome | None:
        """What was clicked last, once it was right or there are no tries left."""
        if not state.ended:
            return None
        place, thing = state.asked.place, state.clicking.thing
        answer = place.labels[thing] if 0 <= thing < len(place.labels) else "nothing"
        right = thing in place.alike(state.asked.thing)
        truth = place.labels[state.asked.thing]
        return Outcome(answer, truth, right, more={"wrong_clicks": state.wrong})

    def example(self, state: LocateState, aspect: float) -> Example:
        """The part, from where it can be seen."""
        first = state.viewer.camera()
        if isinstance(state.viewer, Orbit):
            cameras = around(state.viewer, (state.viewer.pitch, 0.8), aspect)
        else:
            cameras = (first, *state.asked.place.cameras.values())
        return Example(state.asked.place.alike(state.asked.thing), cameras)


def _items(setting: LocateSetting) -> tuple[Asked[ScenePlace], ...]:
    """All that can be asked for. Raises ValueError in a world that does not say it."""
    if not isinstance(setting.world, SceneWorld):
        raise ValueError(f"world = {setting.world.name}, expected scene")
    return setting.world.items(setting.place)


def _which(viewer: Fixed, left: float) -> Label:
    views = str(len(viewer.cameras))
    values = (("number", str(viewer.at + 1)), ("views", views))
    return Label("scene.view", (left, 0.075), 0.028, values=values)
