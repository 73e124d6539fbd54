"""T4, discovery and relation: how many of the thing shown are in the building? (Elmqvist2009
§VI)"""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from seethrough.renderer.events import Event, KeyPress
from seethrough.tasks.count.count_task import number_outcome
from seethrough.tasks.count_in_building.simulate import STRATEGY
from seethrough.tasks.kit.base import Example, NoParameters, Outcome, Setting, View
from seethrough.tasks.kit.entry import KEYS, NumberEntry
from seethrough.tasks.kit.hud import Label
from seethrough.tasks.kit.measure import ABSOLUTE_ERROR, CORRECT, COUNT_ERROR, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.building.building import Building, count_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.building.visit import Visit, before, visit

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

    name, code, version = "count_in_building", "T4", "1"
    source = "Elmqvist2009 §VI"
    worlds = ("building",)
    Parameters = NoParameters
    measures: tuple[Measure, ...] = (COUNT_ERROR, ABSOLUTE_ERROR, CORRECT)
    title, instruction = "count_in_building.title", "count_in_building.instruction"
    takes = keys(KEYS)
    texts: Texts = OwnTexts("seethrough.tasks.count_in_building")
    simulate = STRATEGY

    def make_scene(self, rng: Generator, setting: Setting[BuildingParameters]) -> Building:
        """One of the study's buildings: the same for everybody, so from the study's seed."""
        return count_building(rng, setting.place)

    def begin(
        self, made: Building, setting: Setting[BuildingParameters], aspect: float
    ) -> CountInBuildingState:
        """The first state of a trial."""
        return CountInBuildingState(visit(made, setting.place), NumberEntry(aspect))

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
