"""T3, discovery: find the one thing that occurs once, and mark its place on the plan (004 §VI)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from renderer.scene import Scene
from tasks.base import Outcome, View
from tasks.building import Building, unique_building
from tasks.controls import Walk, walk
from tasks.current_target import inset, target_picture
from tasks.events import Event, KeyPress
from tasks.floor import room_at
from tasks.hud import Label
from tasks.parameters import BuildingParameters
from tasks.plan_mark import PlanMark


@dataclass(frozen=True, eq=False)
class UniqueState:
    """A trial between two events; `found` once the participant has ended the search."""

    building: Building
    walk: Walk
    plan: PlanMark
    picture: Scene
    found: bool = False


class Unique:
    """Find it: the pointer turns, arrow keys walk, space or enter ends the search; then mark it."""

    name = "unique"
    scenario = "walkthrough"

    def make_scene(self, rng: Generator, parameters: BuildingParameters) -> Building:
        """One of the study's buildings: the same for everybody, so from the study's seed."""
        return unique_building(rng, parameters)

    def begin(
        self,
        rng: Generator,
        parameters: BuildingParameters,
        aspect: float,
        scene: Building | None = None,
    ) -> UniqueState:
        """The first state of a trial."""
        building = self.make_scene(rng, parameters) if scene is None else scene
        return UniqueState(
            building,
            walk(parameters, building.start),
            PlanMark(aspect, parameters.side),
            target_picture(building),
        )

    def on_event(self, state: UniqueState, event: Event) -> UniqueState:
        """The state after `event`."""
        if state.found:
            return replace(state, plan=state.plan.on_event(event))
        found = isinstance(event, KeyPress) and event.key in ("space", "enter")
        walked = state.walk.on_event(event)
        return UniqueState(state.building, walked, state.plan, state.picture, found)

    def view(self, state: UniqueState) -> View:
        """What to show for `state`: the building, then its plan over it."""
        camera = state.walk.camera()
        picture = inset(state.picture, state.walk.held.time or 0.0)
        if not state.found:
            search = (Label("unique.search", (0.26, 0.02)), picture)
            return View(state.building.scene, camera, search, captured=True)
        middle = (state.plan.aspect / 2, 0.03)
        hud = (
            Label("unique.mark", middle, align="center"),
            picture,
            *state.plan.elements(state.building),
        )
        return View(state.building.scene, camera, hud)

    def outcome(self, state: UniqueState) -> Outcome | None:
        """Once confirmed: `distance` from the mark, and as `correct`, whether the room is right."""
        if not state.plan.confirmed or state.plan.mark is None:
            return None
        b = state.building
        index = b.asked_objects[0]
        place = b.scene.transforms[index, [0, 2], 3]
        mark = np.array(state.plan.mark)
        rooms = [room_at(b.floor, at[0], at[1], b.parameters) for at in (mark, place)]
        return Outcome(
            answer=f"{mark[0]:.3f},{mark[1]:.3f}",
            truth=f"{place[0]:.3f},{place[1]:.3f}",
            correct=rooms[0] == rooms[1],
            distance=float(np.hypot(*(mark - place))),
        )
