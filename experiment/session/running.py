"""A trial while it runs: frames go out, events come in, until it has an answer."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING, TypeGuard

from seethrough.experiment.display.display import LEAVE, MEANT, Leave
from seethrough.experiment.pages.pages import Page, TextField
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.frames import Watch
from seethrough.experiment.session.hand import Hand
from seethrough.experiment.session.strangers import called
from seethrough.experiment.study.design.design import Trial
from seethrough.renderer.events import (
    Event,
    FocusChange,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerRelease,
    SecondPress,
    SecondRelease,
    Tick,
    Wheel,
)
from seethrough.tasks.kit.base import Outcome, View
from seethrough.tasks.kit.hud import practice_mark

if TYPE_CHECKING:
    from seethrough.experiment.session.trial import TrialRun

DIGEST_EVERY = 1.0  # s between the digests of frames that replay compares, closer at the start:
DIGEST_SOONEST = 0.25  # so that a short trial has some too

POINTER, SECOND = "pointer", "second button"  # left and right, among the keys that are down

BUTTONS: dict[str, type[PointerRelease] | type[SecondRelease]] = {
    POINTER: PointerRelease,
    SECOND: SecondRelease,
}

MENU = Page(
    "menu",
    "menu.title",
    (TextField("note", "menu.note"),),
    ("menu.on", "menu.repeat", "menu.leave"),
)


def _interrupts(event: Event) -> TypeGuard[KeyPress]:
    return isinstance(event, KeyPress) and event.key in MEANT


def _held(event: Event) -> str:
    """What an event holds down or lets go: a key's name, or a button's."""
    if isinstance(event, KeyPress | KeyRelease):
        return event.key
    return SECOND if isinstance(event, SecondPress | SecondRelease) else POINTER


class Running:
    """A trial while it runs."""

    def __init__(self, run: TrialRun, trial: Trial, state: object, limit: float) -> None:
        self._world, self._task = run.world, run.task(trial)
        self._technique = run.technique(trial)
        self._technique_name = run.study.part(trial.levels).technique_name
        display = run.study.part(trial.levels).display
        look, aspect = run.look(trial), run.world.display.aspect
        self._hand = Hand(self._technique, aspect, look, display.height)
        self._trial, self._state, self._limit = trial, state, limit
        self._watch = Watch(run.world.period or 1.0 / display.refresh)
        self.first = self._confirmed = self._since = 0.0
        self._first_within = self._within = 0.0
        self._down: set[str] = set()  # pressed in this trial and not released
        self._early = 0
        self._digested = -inf
        self._away = self._counted = 0.0  # what was away, and up to when a page's time is in it
        self._lost_focus: float | None = None
        self._outcome: Outcome | None = None
        self._timed_out = self._repeat = False
        self._marks = (practice_mark(run.world.display.aspect),) if trial.training else ()
        self.view = self._viewed()

    @property
    def ended(self) -> bool:
        """Whether there is an answer, the time is over, or the trial is to be repeated."""
        return self._outcome is not None or self._timed_out or self._repeat

    def _viewed(self) -> View:
        """What the task shows now; all through a practice trial, with a mark that says so."""
        view = self._hand.shown(self._task.view(self._state))
        return replace(view, hud=(*view.hud, *self._marks)) if self._marks else view

    def show(self) -> None:
        """Show the view as it is now and note the frame."""
        self.view = self._viewed()
        show = partial(self._world.display.show, self.view, self._technique)
        flip = called("technique", self._technique_name, "drawing", show)
        if self._watch.frames == 0:
            self.first, self._first_within = flip, self._world.flip_within()
        if not self._watch.seen:
            self._since = flip
        self._watch.frame(flip, self.view)
        after = min(DIGEST_EVERY, max(DIGEST_SOONEST, (flip - self.first) / 4))
        due = flip - self._digested >= after
        digest = self._world.display.digest() if due else ""
        self._digested = flip if due else self._digested
        self._world.recorder.frame(flip, self.view, digest)

    def admitted(self, event: Event) -> Event | None:
        """The event as far as the trial has to do with it, None if it came from before.

        What was pressed before the first frame, or while a page lay over the trial, answers
        nothing, and neither does what may have been. Nor do the releases and drags that follow.
        """
        if _interrupts(event) or isinstance(event, Tick | FocusChange):
            return event
        if isinstance(event, Wheel | SecondPress | SecondRelease) and not self._hand.takes(event):
            return None
        if isinstance(event, KeyRelease | PointerRelease | SecondRelease):
            key = _held(event)
            known = key in self._down
            self._down.discard(key)
            return event if known else None
        if event.time < self._since:
            self._early += not isinstance(event, PointerMove | Wheel)
            return None
        if isinstance(event, PointerMove):
            stale = event.dragging and POINTER not in self._down
            return replace(event, dragging=False) if stale else event
        if not isinstance(event, Wheel):
            self._down.add(_held(event))
        return event

    def take(self, event: Event) -> bool:
        """Let an event change the trial; whether that ended or interrupted it. Raises Leave."""
        self._confirmed, self._within = max(event.time, self.first), 0.0
        if _interrupts(event):
            self._interrupt(event)
            return True
        if isinstance(event, FocusChange):
            self._focus(event)
            return False
        if not isinstance(event, Tick):
            self._within = event.within
        event = self._hand.pointed(event, self.view)
        used = self._hand.on_event(event, self.view)
        state = self._state if used else self._task.on_event(self._state, event)
        if state is not self._state:
            self._state, self._outcome = state, self._task.outcome(state)
        over = bool(self._limit) and event.time - self.first >= self._limit
        self._timed_out = over and self._outcome is None
        return self.ended

    def _focus(self, event: FocusChange) -> None:
        if not event.focused:
            self._lost_focus = max(event.time, self.first, self._counted)
        elif self._lost_focus is not None:
            self._away += max(event.time - self._lost_focus, 0.0)
            self._lost_focus = None

    def _interrupt(self, event: KeyPress) -> None:
        """Esc asks whether to leave, F1 opens the experimenter's menu; both stop the clean time."""
        before, handled = max(event.time, self.first), self._world.clock.now()
        if event.key == "escape":
            if self._world.input.ask(LEAVE)["button"] == "1":
                raise Leave
        else:
            answers = self._world.input.ask(MENU)
            if answers.get("note"):
                self._world.recorder.note(self._trial, answers["note"])
            if answers["button"] == "2":
                raise Leave
            self._repeat = answers["button"] == "1"
        if self._repeat:
            self._confirmed = handled
        else:
            self._go_on(before, self._world.clock.now())

    def _go_on(self, before: float, now: float) -> None:
        """After a page: its time counts once, and what was down came up on it."""
        self._away += now - before
        if self._lost_focus is not None:
            self._away += before - self._lost_focus
            self._lost_focus = now
        self._counted = now
        self._watch.pause()
        up: list[Event] = [
            BUTTONS[key](before, 0.0, 0.0, now - before)
            if key in BUTTONS
            else KeyRelease(before, key, now - before)
            for key in sorted(self._down)
        ]
        self._down.clear()
        # No tick of now: what came in under the page may not be dispatched yet.
        for event in (*up, Tick(before)):
            self._world.recorder.event(event)
            self.take(event)

    def record(self) -> TrialRecord:
        """What became of the trial; the frame it ended on is noted with its digest."""
        watch = self._watch
        self._world.recorder.frame(self._confirmed, self.view, self._world.display.digest())
        lost = 0.0 if self._lost_focus is None else max(self._confirmed - self._lost_focus, 0.0)
        return TrialRecord(
            trial=self._trial,
            outcome=self._outcome,
            targets=int(self.view.scene.targets.sum()),
            first_frame=self.first,
            confirmed=self._confirmed,
            away=self._away + lost,
            timed_out=self._timed_out,
            frames=watch.frames,
            frames_missed=watch.missed,
            worst_frame=watch.worst,
            path_length=watch.path,
            turned=watch.turned,
            repeat=self._repeat,
            solution=self._task.solution(self._state) if self._trial.training else None,
            within=self._first_within + self._within,
            early=self._early,
        )
