"""One trial: from its stream to a scored record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from experiment.config import Study
from experiment.design import Trial
from experiment.display import Leave
from experiment.pages import Page, Paragraph
from experiment.scenes import StudyScenes
from renderer.techniques.standard import Standard
from tasks.base import Outcome, View
from tasks.events import KeyPress

if TYPE_CHECKING:
    from experiment.session import World

# A frame that took this many display periods was missed (issue: over 1.5 periods).
MISSED = 1.5


@dataclass(frozen=True)
class TrialRecord:
    """A trial that ended; times in seconds on the session's clock."""

    trial: Trial
    outcome: Outcome | None
    targets: int
    first_frame: float
    confirmed: float
    away: float
    timed_out: bool
    frames: int
    frames_missed: int
    worst_frame: float
    path_length: float
    turned: float

    @property
    def time(self) -> float:
        """Completion time: first frame shown to the answer's confirmation."""
        return self.confirmed - self.first_frame


class _Watch:
    """Counts frames and what the viewer's movement adds up to."""

    def __init__(self, period: float) -> None:
        self.period = period
        self.frames = 0
        self.missed = 0
        self.worst = 0.0
        self.path = 0.0
        self.turned = 0.0
        self._time: float | None = None
        self._view: View | None = None

    def frame(self, time: float, view: View) -> None:
        self.frames += 1
        if self._time is not None:
            took = time - self._time
            self.worst = max(self.worst, took)
            self.missed += took > MISSED * self.period
        if self._view is not None and self._view.camera is not view.camera:
            old, new = self._view.camera, view.camera
            self.path += float(np.linalg.norm(new.eye - old.eye))
            self.turned += float(np.arccos(np.clip(new.forward @ old.forward, -1.0, 1.0)))
        self._time, self._view = time, view

    def pause(self) -> None:
        """The next frame comes after a page: its distance to the last one is not a missed frame."""
        self._time = None


class TrialRun:
    """Plays trials of a study in a world."""

    def __init__(self, study: Study, world: World) -> None:
        self.study = study
        self.world = world
        self.scenes = StudyScenes(study)

    def technique(self, trial: Trial) -> Any:
        """What the trial's transparency level draws with."""
        return self.study.dynamic if trial.transparency == "dynamic" else Standard()

    def begin(self, trial: Trial) -> Any:
        """The task's first state, from the trial's own stream."""
        task = self.world.tasks[trial.task]
        return self.scenes.begin(task, trial, self.world.display.aspect)

    def preview(self, trial: Trial) -> View:
        """What the instruction page shows: a scene of the task that is no trial's scene."""
        example = self.scenes.example(trial)
        view = self.world.tasks[trial.task].view(self.begin(example))
        return View(view.scene, view.camera)

    def play(self, trial: Trial, limit: float) -> TrialRecord:
        """Run one trial to its confirmed answer or its limit (seconds; 0: none). Raises Leave."""
        world, task = self.world, self.world.tasks[trial.task]
        technique = self.technique(trial)
        state = self.begin(trial)
        watch = _Watch(1.0 / self.study.display.refresh)
        world.recorder.trial_begins(trial)
        world.input.begin_trial(trial.task, trial.training)
        view = task.view(state)
        targets = int(view.scene.targets.sum())
        first = flip = world.display.show(view, technique)
        watch.frame(flip, view)
        world.recorder.frame(flip, view)
        away, timed_out, confirmed = 0.0, False, flip
        outcome = None
        while outcome is None and not timed_out:
            for event in world.input.events(view):
                world.recorder.event(event)
                if isinstance(event, KeyPress) and event.key == "escape":
                    away += self._confirm_leaving()
                    watch.pause()
                    break
                state = task.on_event(state, event)
                confirmed = event.time
                outcome = task.outcome(state)
                timed_out = bool(limit) and event.time - first >= limit
                if outcome is not None or timed_out:
                    break
            else:
                view = task.view(state)
                flip = world.display.show(view, technique)
                watch.frame(flip, view)
                world.recorder.frame(flip, view)
        return TrialRecord(
            trial, outcome, targets, first, confirmed, away, timed_out and outcome is None,
            watch.frames, watch.missed, watch.worst, watch.path, watch.turned,
        )  # fmt: skip

    def _confirm_leaving(self) -> float:
        """Ask whether to leave; the seconds the question took. Raises Leave."""
        before = self.world.clock.now()
        page = Page("leave", "leave.title", (Paragraph("leave.text"),), ("leave.no", "leave.yes"))
        if self.world.input.ask(page)["button"] == "1":
            raise Leave
        return self.world.clock.now() - before
