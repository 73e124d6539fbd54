"""T4, discovery and relation: how many of the thing shown are in the building? (004 §VI)"""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from renderer.scene import Scene
from tasks.base import Outcome, View
from tasks.building import Building, count_building
from tasks.controls import Walk, walk
from tasks.count import number_outcome
from tasks.current_target import inset, target_picture
from tasks.entry import NumberEntry
from tasks.events import Event, PointerPress, PointerRelease
from tasks.hud import Label
from tasks.parameters import BuildingParameters


@dataclass(frozen=True, eq=False)
class CountInBuildingState:
    """A trial between two events."""

    building: Building
    walk: Walk
    entry: NumberEntry
    picture: Scene


class CountInBuilding:
    """Count one type: the pointer turns, arrow keys walk, digits and enter answer."""

    name = "count_in_building"
    scenario = "walkthrough"

    def make_scene(self, rng: Generator, parameters: BuildingParameters) -> Building:
        """One of the study's buildings: the same for everybody, so from the study's seed."""
        return count_building(rng, parameters)

    def begin(
        self,
        rng: Generator,
        parameters: BuildingParameters,
        aspect: float,
        scene: Building | None = None,
    ) -> CountInBuildingState:
        """The first state of a trial."""
        building = self.make_scene(rng, parameters) if scene is None else scene
        return CountInBuildingState(
            building,
            walk(parameters, building.start),
            NumberEntry(aspect),
            target_picture(building),
        )

    def on_event(self, state: CountInBuildingState, event: Event) -> CountInBuildingState:
        """The state after `event`. The pointer is captured: it turns, and clicks nothing."""
        pointer = isinstance(event, PointerPress | PointerRelease)
        entry = state.entry if pointer else state.entry.on_event(event)
        return CountInBuildingState(
            state.building, state.walk.on_event(event), entry, state.picture
        )

    def view(self, state: CountInBuildingState) -> View:
        """What to show for `state`."""
        hud = (
            Label("count_in_building.question", (0.26, 0.02)),
            inset(state.picture, state.walk.held.time or 0.0),
            state.entry.field(),
        )
        return View(state.building.scene, state.walk.camera(), hud, captured=True)

    def outcome(self, state: CountInBuildingState) -> Outcome | None:
        """The scored answer once confirmed: `count_error` is answer − truth."""
        return number_outcome(state.entry, len(state.building.asked_objects))
