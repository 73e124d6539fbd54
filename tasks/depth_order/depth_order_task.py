"""Which of two marked things is nearer: the paper's static depth test as a task (Elmqvist2009
§VI-G)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeAlias

from numpy.random import Generator

from seethrough.renderer.declared import check, key
from seethrough.renderer.events import Event, KeyPress, PointerPress
from seethrough.tasks.depth_order.pair import LIFT, Marked, marked
from seethrough.tasks.depth_order.simulate import STRATEGY
from seethrough.tasks.kit.base import Basics, Example, Outcome, Setting, View
from seethrough.tasks.kit.hud import Button, Label, Rect
from seethrough.tasks.kit.measure import CORRECT, Measure
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import ANYWHERE, Texts, WorldParameters, keys

MARKS = ("A", "B")
SIZE, GAP, EDGE = 0.08, 0.015, 0.02


@dataclass(frozen=True)
class DepthOrderParameters:
    """What a study may say of the task."""

    ratio: float = key(
        1.2, "how many times as far the farther thing is, at least", low=1.01, high=10
    )

    def __post_init__(self) -> None:
        check(self)


DepthOrderSetting: TypeAlias = Setting[WorldParameters, DepthOrderParameters]


@dataclass(frozen=True)
class DepthOrderState:
    """A trial between two events."""

    marked: Marked
    aspect: float
    answer: str = ""


class DepthOrder(Basics[DepthOrderState, DepthOrderSetting]):
    """Press A or B, or their buttons; the view stands still."""

    name, code = "depth_order", "D"
    source = "Elmqvist2009 §VI-G"
    worlds = ANYWHERE
    least = 2
    Parameters = DepthOrderParameters
    measures: tuple[Measure, ...] = (CORRECT,)
    takes = keys(mark.lower() for mark in MARKS)
    texts: Texts = OwnTexts("seethrough.tasks.depth_order")
    simulate = STRATEGY

    def controls(self, setting: DepthOrderSetting) -> str:
        """Nothing moves."""
        return "depth_order.still"

    def make_scene(self, rng: Generator, setting: DepthOrderSetting) -> Marked:
        """A place, a view and a pair."""
        return marked(rng, setting, setting.task.ratio)

    def begin(self, made: Marked, setting: Setting, aspect: float) -> DepthOrderState:
        """Nothing is answered yet."""
        return DepthOrderState(made, aspect)

    def on_event(self, state: DepthOrderState, event: Event) -> DepthOrderState:
        """The first answer counts."""
        if state.answer:
            return state
        said = ""
        if isinstance(event, KeyPress):
            said = event.key.upper()
        elif isinstance(event, PointerPress):
            places = buttons(state.aspect).items()
            said = next((m for m, rect in places if rect.contains(event.x, event.y)), "")
        return replace(state, answer=said) if said in MARKS else state

    def view(self, state: DepthOrderState) -> View:
        """The place, and over it the marks."""
        hud = [Label("depth_order.question", (0.02, 0.02))]
        for mark, (x, y) in zip(MARKS, state.marked.marks().tolist(), strict=True):
            at = (state.aspect / 2 + x / 2, 0.5 - y / 2 - LIFT)
            hud.append(Label(mark, at, align="center"))
        shown = [Button(m, r, chosen=m == state.answer) for m, r in buttons(state.aspect).items()]
        return View(state.marked.scene, state.marked.camera, (*hud, *shown))

    def outcome(self, state: DepthOrderState) -> Outcome | None:
        """Whether it is the nearer one."""
        if not state.answer:
            return None
        truth = MARKS[state.marked.nearer]
        return Outcome(state.answer, truth, state.answer == truth)

    def example(self, state: DepthOrderState, aspect: float) -> Example:
        """Both things, as they are marked."""
        return Example(state.marked.pair, (state.marked.camera,))


@lru_cache(maxsize=8)
def buttons(aspect: float) -> dict[str, Rect]:
    """A and B in the lower right corner of the view."""
    left, top = aspect - EDGE - len(MARKS) * SIZE - (len(MARKS) - 1) * GAP, 1 - EDGE - SIZE
    return {m: Rect(left + i * (SIZE + GAP), top, SIZE, SIZE) for i, m in enumerate(MARKS)}
