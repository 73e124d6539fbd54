"""T4, discovery and relation: how many of the thing shown are in the building? (004 §VI)"""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from seethrough.tasks.count.count_task import number_outcome
from seethrough.tasks.kit.base import Example, Outcome, View
from seethrough.tasks.kit.entry import NumberEntry
from seethrough.tasks.kit.events import Event, KeyPress
from seethrough.tasks.kit.example import before
from seethrough.tasks.kit.hud import Label
from seethrough.tasks.kit.visit import Visit, visit
from seethrough.tasks.parameters import BuildingParameters
from seethrough.tasks.worlds.building.building import Building, count_building

QUESTION = Label("count_in_building.question", (0.26, 0.02))


@dataclass(frozen=True, eq=False)
class CountInBuildingState:
    """A trial between two events."""

    visit: Visit
    entry: NumberEntry

    @property
    def building(self) -> Building:
        """Where the trial is played."""
        return self.visit.building


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
        return CountInBuildingState(visit(building, parameters), NumberEntry(aspect))

    def on_event(self, state: CountInBuildingState, event: Event) -> CountInBuildingState:
        """The state after `event`: digits are typed, for the pointer turns the walker."""
        entry = state.entry.on_event(event) if isinstance(event, KeyPress) else state.entry
        moved = state.visit.on_event(event)
        if moved is state.visit and entry is state.entry:
            return state
        return CountInBuildingState(moved, entry)

    def view(self, state: CountInBuildingState) -> View:
        """What to show for `state`."""
        return state.visit.view(QUESTION, state.entry.field(), *state.entry.notes())

    def outcome(self, state: CountInBuildingState) -> Outcome | None:
        """The scored answer once confirmed: `count_error` is answer − truth."""
        if not state.entry.confirmed:
            return None
        return number_outcome(state.entry, len(state.building.asked_objects))

    def solution(self, state: CountInBuildingState) -> None:
        """A number needs no picture."""

    def example(self, state: CountInBuildingState, aspect: float) -> Example:
        """Things of the kind asked for."""
        return Example(tuple(state.building.asked_objects), before(state.visit))
