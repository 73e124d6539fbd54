"""A simulated participant in a window, for somebody to watch: its events arrive as time passes."""

from __future__ import annotations

from collections import deque

from seethrough.experiment.display.display import Leave
from seethrough.experiment.display.looking import Looking
from seethrough.experiment.display.window import Window
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.renderer.events import (
    Event,
    KeyPress,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.tasks.kit.base import View


class WatchedInput:
    """The participant's events, each at its time on the window's clock. Esc ends the watching."""

    def __init__(self, participant: SimulatedParticipant, window: Window, looking: Looking) -> None:
        self.participant = participant
        self.window = window
        self.looking = looking
        self._coming: deque[Event] = deque()
        self._task = ""

    def begin_trial(self, task: str, training: bool) -> None:
        """The participant meets a new trial."""
        self._task = task
        self._coming.clear()
        self.window.begin_trial(task, training)
        self.participant.begin_trial(task, self.window.clock.now())

    def events(self, view: View) -> list[Event]:
        """What of the participant's plan is due by now. Raises Leave on Esc."""
        for event in self.window.events(view):
            if isinstance(event, KeyPress) and event.key == "escape":
                raise Leave
        now = self.window.clock.now()
        self.looking.technique = self.window.technique
        self.looking.resize(self.window.size)
        if not self._coming:
            planned = self.participant.events(
                view,
                lambda: self.looking.look(view),
                now,
                self._task,
                self.window.technique,
                self.window.aspect,
            )
            self._coming.extend(sorted(planned, key=lambda e: e.time))
        due: list[Event] = []
        while self._coming and self._coming[0].time <= now:
            due.append(self._coming.popleft())
        for event in due:
            if isinstance(event, PointerMove | PointerPress | PointerRelease):
                self.window.point((event.x, event.y))
        return [*due, Tick(now)]

    def ask(self, page: Page) -> Answers:
        """The participant reads and answers a page while it is shown."""
        answers, seconds = self.participant.answer(page)
        self.window.present(page, answers, seconds)
        return answers
