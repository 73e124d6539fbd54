"""Access: read a digit that other things stand before (Elmqvist2009's third kind of task,
§III-A)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.random import Generator

from seethrough.renderer.declared import check, key
from seethrough.renderer.events import Event
from seethrough.tasks.kit.base import Basics, Example, Outcome, Setting, View
from seethrough.tasks.kit.controls import Orbit, of_view, orbit
from seethrough.tasks.kit.entry import KEYS, NumberEntry
from seethrough.tasks.kit.example import around
from seethrough.tasks.kit.hud import Label
from seethrough.tasks.kit.measure import CORRECT, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.read.sign import SignPlace, sign_place
from seethrough.tasks.read.simulate import STRATEGY
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters

FACING = 0.8  # cosine between the sign's front and the way to the eye, for an instruction's picture


@dataclass(frozen=True)
class ReadParameters:
    """What a study may say of the task."""

    height: float = key(16.0, "height of the sign", "world units", low=0.5, high=1000)

    def __post_init__(self) -> None:
        check(self)


ReadSetting: TypeAlias = Setting[AbstractParameters, ReadParameters]


@dataclass(frozen=True, eq=False)
class ReadState:
    """A trial between two events."""

    place: SignPlace
    orbit: Orbit
    entry: NumberEntry


class Read(Basics[ReadState, ReadSetting]):
    """Drag or arrow keys orbit, a digit and enter answer."""

    name, code = "read", "R"
    source = "Elmqvist2009 §III-A"
    worlds = ("abstract",)
    Parameters = ReadParameters
    measures: tuple[Measure, ...] = (CORRECT,)
    takes = keys(KEYS)
    texts: Texts = OwnTexts("seethrough.tasks.read")
    simulate = STRATEGY

    def make_scene(self, rng: Generator, setting: ReadSetting) -> SignPlace:
        """A world with a sign."""
        return sign_place(rng, setting.place, setting.task.height)

    def begin(self, made: SignPlace, setting: ReadSetting, aspect: float) -> ReadState:
        """The first state of a trial."""
        return ReadState(made, orbit(setting.place, aspect), NumberEntry(aspect))

    def on_event(self, state: ReadState, event: Event) -> ReadState:
        """The state after `event`."""
        entry = state.entry.on_event(event)
        return ReadState(state.place, state.orbit.on_event(of_view(event, entry.pressed)), entry)

    def view(self, state: ReadState) -> View:
        """What to show for `state`."""
        hud = (Label("read.question", (0.02, 0.02)), *state.entry.elements())
        return View(state.place.scene, state.orbit.camera(), hud)

    def outcome(self, state: ReadState) -> Outcome | None:
        """Whether it is the digit on the sign, once confirmed."""
        if not state.entry.confirmed:
            return None
        answer, truth = str(int(state.entry.text)), str(state.place.digit)
        return Outcome(answer, truth, answer == truth)

    def example(self, state: ReadState, aspect: float) -> Example:
        """The sign, from before it."""
        cameras = around(state.orbit, (state.orbit.pitch,), aspect)
        ahead = [c.eye @ state.place.normal / np.linalg.norm(c.eye) for c in cameras]
        best = max(ahead)
        chosen = (c for c, a in zip(cameras, ahead, strict=True) if a >= min(FACING, best))
        return Example((state.place.sign,), tuple(chosen))
