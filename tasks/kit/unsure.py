"""A task that one may leave by saying that one does not know: a button of its view, and F2.

Wrapped about any task, so that none has to know of it; as pure as what it wraps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from numpy.random import Generator

from seethrough.renderer.events import Event, KeyPress, PointerPress
from seethrough.tasks.kit.base import Example, Outcome, Setting, Task, View
from seethrough.tasks.kit.hud import MARGIN, Button, FloorPlan, Rect
from seethrough.tasks.kit.world import Place

KEY = "f2"
UNKNOWN = "unknown"  # the answer of who does not know
BUTTON = Button("button.unsure", Rect(MARGIN, 1 - MARGIN - 0.055, 0.34, 0.055))


@dataclass(frozen=True, eq=False)
class UnsureState:
    """The task's own state, and whether it was left."""

    state: object
    left: bool = False


class Unsure:
    """The task, with a way out."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self.name, self.code, self.version, self.source = (
            task.name, task.code, task.version, task.source,
        )  # fmt: skip
        self.worlds, self.Parameters, self.measures = task.worlds, task.Parameters, task.measures
        self.title, self.instruction, self.texts = task.title, task.instruction, task.texts
        self.simulate, self.takes = task.simulate, task.takes | {f"key:{KEY}"}

    def make_scene(self, rng: Generator, setting: Setting) -> Place:
        """The task's."""
        return self._task.make_scene(rng, setting)

    def begin(self, made: Place, setting: Setting, aspect: float) -> UnsureState:
        """The task's first state."""
        return UnsureState(self._task.begin(made, setting, aspect))

    def on_event(self, state: UnsureState, event: Event) -> UnsureState:
        """The key or the button leave; everything else is the task's."""
        key = isinstance(event, KeyPress) and event.key == KEY
        click = isinstance(event, PointerPress) and BUTTON.rect.contains(event.x, event.y)
        if key or (click and not self._task.view(state.state).captured):
            return replace(state, left=True)
        own = self._task.on_event(state.state, event)
        return state if own is state.state else replace(state, state=own)

    def view(self, state: UnsureState) -> View:
        """The task's, and the button."""
        view = self._task.view(state.state)
        return replace(view, hud=(*view.hud, BUTTON))

    def outcome(self, state: UnsureState) -> Outcome | None:
        """Who left does not know; nothing was measured."""
        return Outcome(UNKNOWN, "", False) if state.left else self._task.outcome(state.state)

    def solution(self, state: UnsureState) -> FloorPlan | None:
        """The task's, of who answered."""
        return None if state.left else self._task.solution(state.state)

    def example(self, state: UnsureState, aspect: float) -> Example:
        """The task's."""
        return self._task.example(state.state, aspect)
