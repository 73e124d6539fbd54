"""Lets a simulated participant sit at the session: same Protocol, same events as a person."""

from __future__ import annotations

from functools import partial
from typing import Protocol

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.session.strangers import called
from seethrough.renderer.events import Event, Tick
from seethrough.renderer.scene.visibility import Visibility
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.kit.base import View


class Looks(Protocol):
    """A display that tells what can be seen in the view it shows."""

    @property
    def aspect(self) -> float:
        """Width / height of the view."""

    @property
    def technique(self) -> Parameters | None:
        """What the view shown last is drawn with; None before the first."""

    def look(self) -> Visibility:
        """What can be seen in the view shown last."""


class SimulatedInput:
    """Asks the participant what it does next and lets the simulated clock go on to then."""

    def __init__(
        self, participant: SimulatedParticipant, display: Looks, clock: SimulatedClock
    ) -> None:
        self.participant = participant
        self.display = display
        self.clock = clock
        self._task = ""

    def begin_trial(self, task: str, training: bool) -> None:
        """The participant meets a new trial."""
        self._task = task
        self.participant.begin_trial(task, self.clock.now())

    def events(self, view: View) -> list[Event]:
        """The participant's next events, and a Tick at the time of the last."""
        display = self.display
        play = partial(
            self.participant.events, view, display.look, self.clock.now(), self._task,
            display.technique, display.aspect,
        )  # fmt: skip
        events = called("task", self._task, "simulate", play)
        end = max([e.time for e in events], default=self.clock.now())
        self.clock.advance(end)
        ticked = bool(events) and isinstance(events[-1], Tick) and events[-1].time == end
        return events if ticked else [*events, Tick(end)]

    def ask(self, page: Page) -> Answers:
        """The participant reads and answers a page."""
        answers, seconds = self.participant.answer(page)
        self.clock.advance(self.clock.now() + seconds)
        return answers
