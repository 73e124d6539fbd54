"""T3, discovery: find the one thing that occurs once, and mark its place on the plan (Elmqvist2009
§VI)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.declared import check, key
from seethrough.renderer.events import Event, KeyPress
from seethrough.tasks.kit.base import Example, Outcome, Setting, View
from seethrough.tasks.kit.hud import FloorPlan, Label, Point
from seethrough.tasks.kit.measure import CORRECT, DISTANCE, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.unique.simulate import STRATEGY
from seethrough.tasks.worlds.building.building import Building, unique_building
from seethrough.tasks.worlds.building.building_parameters import METRES, BuildingParameters
from seethrough.tasks.worlds.building.floor import room_at
from seethrough.tasks.worlds.building.plan_mark import PlanMark
from seethrough.tasks.worlds.building.visit import Visit, before, visit

SEARCH = Label("unique.search", (0.26, 0.02))


@dataclass(frozen=True)
class UniqueParameters:
    """What a study may say of the task; the paper's plan shows neither."""

    start_mark: bool = key(False, "whether the floor plan shows where one began")
    you_were_here: bool = key(
        False, "whether the floor plan shows where one was when the search ended"
    )

    def __post_init__(self) -> None:
        check(self)


UniqueSetting: TypeAlias = Setting[BuildingParameters, UniqueParameters]


@dataclass(frozen=True, eq=False)
class UniqueState:
    """A trial between two events; `found` once the participant has ended the search."""

    visit: Visit
    plan: PlanMark
    own: UniqueParameters
    found: bool = False

    @property
    def building(self) -> Building:
        """Where the trial is played."""
        return self.visit.building


class Unique:
    """Find it: the pointer turns, arrow keys walk, space or enter ends the search; then mark it."""

    name, code, version = "unique", "T3", "1"
    source = "Elmqvist2009 §VI"
    worlds = ("building",)
    Parameters = UniqueParameters
    measures: tuple[Measure, ...] = (DISTANCE, CORRECT)
    title, instruction = "unique.title", "unique.instruction"
    takes = keys(("space", "enter"))
    texts: Texts = OwnTexts("seethrough.tasks.unique")
    simulate = STRATEGY

    def make_scene(self, rng: Generator, setting: UniqueSetting) -> Building:
        """One of the study's buildings: the same for everybody, so from the study's seed."""
        return unique_building(rng, setting.place)

    def begin(self, made: Building, setting: UniqueSetting, aspect: float) -> UniqueState:
        """The first state of a trial."""
        begun = visit(made, setting.place)
        start = (begun.walk.x, begun.walk.z) if setting.task.start_mark else None
        plan = PlanMark(aspect, setting.place.side, start=start)
        return UniqueState(begun, plan, setting.task)

    def on_event(self, state: UniqueState, event: Event) -> UniqueState:
        """The state after `event`."""
        if state.found:
            return replace(state, plan=state.plan.on_event(event))
        found = isinstance(event, KeyPress) and event.key in ("space", "enter")
        moved = state.visit.on_event(event)
        if moved is state.visit and not found:
            return state
        plan = state.plan
        if found and state.own.you_were_here:
            plan = replace(plan, here=_here(moved))
        return replace(state, visit=moved, plan=plan, found=found)

    def view(self, state: UniqueState) -> View:
        """What to show for `state`: the building, then its plan over it."""
        if not state.found:
            return state.visit.view(SEARCH)
        tone = "hint" if state.plan.hint else "plain"
        text = state.plan.hint or "unique.mark"
        mark = Label(text, (state.plan.aspect / 2, 0.03), align="center", tone=tone)
        plan = state.plan.elements(state.building)
        return state.visit.view(mark, *plan, captured=False)

    def outcome(self, state: UniqueState) -> Outcome | None:
        """Once confirmed: `distance` from the mark, and as `correct`, whether the room is right."""
        if not state.plan.confirmed or state.plan.mark is None:
            return None
        b, place = state.building, _place(state.building)
        mark = np.array(state.plan.mark)
        rooms = [room_at(b.floor, at[0], at[1], b.parameters) for at in (mark, place)]
        return Outcome(
            answer=f"{mark[0]:.3f},{mark[1]:.3f}",
            truth=f"{place[0]:.3f},{place[1]:.3f}",
            correct=rooms[0] == rooms[1],
            distance=float(np.hypot(*(mark - place))),
        )

    def feedback(self, outcome: Outcome) -> tuple[str, dict[str, str | float]]:
        """How far from the place the mark is."""
        text = "feedback.distance" if outcome.correct else "feedback.other_room"
        assert outcome.distance is not None
        return text, {"distance": METRES * outcome.distance}

    def solution(self, state: UniqueState) -> FloorPlan | None:
        """The plan with the mark and the thing's true place."""
        x, z = _place(state.building).tolist()
        return state.plan.plan(state.building, (x, z))

    def example(self, state: UniqueState, aspect: float) -> Example:
        """The thing itself."""
        return Example(tuple(state.building.asked_objects), before(state.visit))


def _here(visit: Visit) -> tuple[Point, Point]:
    """Where the walker is (x, z), and the point one unit ahead."""
    camera = visit.walk.camera()
    x, _, z = camera.eye.tolist()
    ahead, _, away = camera.forward.tolist()
    return (x, z), (x + ahead, z + away)


def _place(building: Building) -> NDArray[np.float64]:
    """(2,) world x and z of the thing asked for."""
    place: NDArray[np.float64] = building.scene.transforms[building.asked_objects[0], [0, 2], 3]
    return place
