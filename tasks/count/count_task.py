"""T1, discovery: how many red objects are there in the abstract world? (Elmqvist2009 §VI)"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from seethrough.renderer.events import Event
from seethrough.tasks.count.simulate import STRATEGY
from seethrough.tasks.kit.base import Example, NoParameters, Outcome, Setting, View
from seethrough.tasks.kit.controls import Orbit, of_view, orbit
from seethrough.tasks.kit.entry import KEYS, NumberEntry
from seethrough.tasks.kit.example import around
from seethrough.tasks.kit.hud import Label
from seethrough.tasks.kit.measure import ABSOLUTE_ERROR, CORRECT, COUNT_ERROR, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import Cloud, cloud


@dataclass(frozen=True, eq=False)
class CountState:
    """A trial between two events."""

    cloud: Cloud
    orbit: Orbit
    entry: NumberEntry


class Count:
    """Count the red objects: drag or arrow keys orbit, digits and enter answer."""

    name, code, version = "count", "T1", "1"
    source = "Elmqvist2009 §VI"
    worlds = ("abstract",)
    Parameters = NoParameters
    measures: tuple[Measure, ...] = (COUNT_ERROR, ABSOLUTE_ERROR, CORRECT)
    title, instruction = "count.title", "count.instruction"
    takes = keys(KEYS)
    texts: Texts = OwnTexts("seethrough.tasks.count")
    simulate = STRATEGY

    def make_scene(self, rng: Generator, setting: Setting[AbstractParameters]) -> Cloud:
        """A world of its own for each trial."""
        return cloud(rng, setting.place)

    def begin(self, made: Cloud, setting: Setting[AbstractParameters], aspect: float) -> CountState:
        """The first state of a trial."""
        return CountState(made, orbit(setting.place, aspect), NumberEntry(aspect))

    def on_event(self, state: CountState, event: Event) -> CountState:
        """The state after `event`."""
        entry = state.entry.on_event(event)
        turned = state.orbit.on_event(of_view(event, entry.pressed))
        return CountState(state.cloud, turned, entry)

    def view(self, state: CountState) -> View:
        """What to show for `state`."""
        hud = (Label("count.question", (0.02, 0.02)), *state.entry.elements())
        return View(state.cloud.scene, state.orbit.camera(), hud)

    def outcome(self, state: CountState) -> Outcome | None:
        """The scored answer once confirmed: `count_error` is answer − truth."""
        if not state.entry.confirmed:
            return None
        return number_outcome(state.entry, int(state.cloud.scene.targets.sum()))

    def solution(self, state: CountState) -> None:
        """A number needs no picture."""

    def example(self, state: CountState, aspect: float) -> Example:
        """The red objects, from all sides."""
        asked = tuple(np.nonzero(state.cloud.scene.targets)[0].tolist())
        return Example(asked, around(state.orbit, (state.orbit.pitch,), aspect))


def number_outcome(entry: NumberEntry, truth: int) -> Outcome:
    """The score of a number that has been confirmed."""
    answer = int(entry.text)
    return Outcome(str(answer), str(truth), answer == truth, count_error=answer - truth)
