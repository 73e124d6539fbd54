"""T2, relation: which letter do the red cones form? (Elmqvist2009 §VI)"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from numpy.random import Generator

from seethrough.renderer.events import Event, KeyPress, PointerPress, PointerRelease
from seethrough.tasks.kit.base import Example, NoParameters, Outcome, Setting, View
from seethrough.tasks.kit.controls import Orbit, changed, of_view, orbit
from seethrough.tasks.kit.example import around
from seethrough.tasks.kit.hud import Button, Element, Label, Rect, hint
from seethrough.tasks.kit.letters import LETTERS
from seethrough.tasks.kit.measure import CORRECT, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.pattern.simulate import STRATEGY
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import Cloud, cloud

SIZE, GAP, EDGE = 0.07, 0.012, 0.02
HIGHER = (1.0,)  # radians of pitch, for the instruction's picture
NAMED = (("letters", ", ".join(sorted(LETTERS))),)


@dataclass(frozen=True, eq=False)
class PatternState:
    """A trial between two events."""

    cloud: Cloud
    orbit: Orbit
    aspect: float
    chosen: str | None = None
    confirmed: bool = False
    pressed: bool = False
    hint: str = ""


class Pattern:
    """Name the letter: drag or arrow keys orbit; letter keys or buttons choose, enter answers."""

    name, code, version = "pattern", "T2", "1"
    source = "Elmqvist2009 §VI"
    worlds = ("abstract",)
    Parameters = NoParameters
    measures: tuple[Measure, ...] = (CORRECT,)
    title, instruction = "pattern.title", "pattern.instruction"
    takes = keys((*(letter.lower() for letter in sorted(LETTERS)), "enter"))
    texts: Texts = OwnTexts("seethrough.tasks.pattern")
    simulate = STRATEGY

    def make_scene(self, rng: Generator, setting: Setting[AbstractParameters]) -> Cloud:
        """A world of its own for each trial, each letter equally likely."""
        letter = sorted(LETTERS)[int(rng.integers(len(LETTERS)))]
        return cloud(rng, setting.place, letter)

    def begin(
        self, made: Cloud, setting: Setting[AbstractParameters], aspect: float
    ) -> PatternState:
        """The first state of a trial."""
        return PatternState(made, orbit(setting.place, aspect), aspect)

    def on_event(self, state: PatternState, event: Event) -> PatternState:
        """The state after `event`."""
        if isinstance(event, PointerPress):
            places = buttons(state.aspect).items()
            hit = next((t for t, rect in places if rect.contains(event.x, event.y)), None)
            state = changed(_chosen(state, hit), pressed=True) if hit else state
        elif isinstance(event, PointerRelease):
            state = changed(state, pressed=False)
        elif isinstance(event, KeyPress):
            state = _chosen(state, event.key)
        return changed(state, orbit=state.orbit.on_event(of_view(event, state.pressed)))

    def view(self, state: PatternState) -> View:
        """What to show for `state`."""
        hud: list[Element] = [Label("pattern.question", (0.02, 0.02))]
        for text, rect in buttons(state.aspect).items():
            label = "button.confirm" if text == "enter" else text
            hud.append(Button(label, rect, chosen=text == state.chosen))
        if state.hint:
            top = min(rect.y for rect in buttons(state.aspect).values())
            hud.append(hint(state.hint, (state.aspect, top), NAMED))
        return View(state.cloud.scene, state.orbit.camera(), tuple(hud))

    def outcome(self, state: PatternState) -> Outcome | None:
        """Right or wrong, once confirmed."""
        if not state.confirmed or state.chosen is None:
            return None
        return Outcome(state.chosen, state.cloud.letter, state.chosen == state.cloud.letter)

    def solution(self, state: PatternState) -> None:
        """A letter needs no picture."""

    def example(self, state: PatternState, aspect: float) -> Example:
        """The letter's cones, from all sides and from higher up: they lie flat."""
        things = state.cloud.scene.objects
        asked = tuple(i for i, o in enumerate(things) if o.target and o.kind == "cone")
        return Example(asked, around(state.orbit, (state.orbit.pitch, *HIGHER), aspect))


@lru_cache(maxsize=8)
def buttons(aspect: float) -> dict[str, Rect]:
    """The letters and enter, three to a row in the lower right corner of the view."""
    texts = (*sorted(LETTERS), "enter")
    step = SIZE + GAP
    left, top = aspect - EDGE + GAP - 3 * step, 1 - EDGE + GAP - 2 * step
    return {
        text: Rect(left + i % 3 * step, top + i // 3 * step, SIZE, SIZE)
        for i, text in enumerate(texts)
    }


def _chosen(state: PatternState, key: str) -> PatternState:
    """A letter can be changed until enter confirms it; nothing chosen can't be confirmed."""
    if state.confirmed:
        return state
    if key == "enter":
        missing = state.chosen is None
        return changed(state, confirmed=not missing, hint="hint.letter" if missing else "")
    if key.upper() in LETTERS:
        return changed(state, chosen=key.upper(), hint="")
    return changed(state, hint="hint.letters") if len(key) == 1 else state
