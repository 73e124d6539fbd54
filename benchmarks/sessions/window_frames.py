"""Frames of a session in a real window while somebody drags the abstract scene, or walks.

    python -m seethrough.benchmarks.sessions.window_frames standard|dynamic|walks [SECONDS]

`walks`: along the ways through the building that simulated people took in the published study
without dynamic transparency (data/walks), a second of every EVERY in which the walker moves.
Prints {frames, moved, missed, worst, cpu, drawing} as JSON: the share of frames that were seen from
elsewhere than the one before, and of those that took over 1.5 periods; the worst frame; and the
processor time of a frame, of all threads, for the whole of the session's loop (recorder and digests
included) and for the renderer alone on the same views. In s.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from seethrough.benchmarks.drawing.walks import Walked, walked
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.display.window import _KEYS, Window
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View

LEFT = 1  # pyglet's number of the left button
AGAIN = 300  # views that the renderer draws again alone
RATE, EVERY = 60, 20  # frames a second of a walk; one second of so many is walked
ANSWERS = {  # keys that end a trial
    "count": ("1", "enter"),
    "count_in_building": ("1", "enter"),
    "unique": ("space", "left", "enter"),
}


class Hand(ABC):
    """Moves, then answers. Its events come as pyglet's do, between two frames."""

    def __init__(self, window: Window, task: str) -> None:
        self.window, self.task = window, task
        self.began: float | None = None
        self.views: list[View] = []
        self.cpu = 0.0
        self._show = window.show
        window.show = self.show  # type: ignore[method-assign]  # it drives a window as it is
        window.on_frame = self.act

    def show(self, view: View, technique: Parameters) -> float:
        """The window's own, keeping the views."""
        self.views.append(view)
        return self._show(view, technique)

    def act(self) -> None:
        """One move a frame; at the end an answer."""
        if self.began is None:
            self.began, self.cpu = time.perf_counter(), time.process_time()
        elif not self.moved() and self.cpu > 0:
            self.cpu = -(time.process_time() - self.cpu)
            symbols = {ours: theirs for theirs, ours in _KEYS.items()}
            for name in ANSWERS[self.task]:
                self.window.on_key_press(symbols[name], 0)

    @abstractmethod
    def moved(self) -> bool:
        """Make the next move; whether there was one."""

    def let_go(self) -> None:
        """Leave the window as it was."""
        self.window.show = self._show  # type: ignore[method-assign]
        self.window.on_frame = lambda: None


class Dragging(Hand):
    """Drags to and fro for so many seconds."""

    def __init__(self, window: Window, task: str, seconds: float) -> None:
        super().__init__(window, task)
        self.seconds, self.down = seconds, False

    def moved(self) -> bool:
        """A way to the side, until the time is over."""
        since = time.perf_counter() - (self.began or 0.0)
        if since >= self.seconds:
            return False
        if not self.down:  # not before the first frame was seen: that would count for nothing
            self.window.on_mouse_press(300, 300, LEFT, 0)
            self.down = True
        way = 1 if since % 4 < 2 else -1
        self.window.on_mouse_drag(300, 300, 5 * way, way, LEFT, 0)
        return True


class Walking(Hand):
    """Sees what a walker saw, a frame after the other."""

    def __init__(self, window: Window, task: str, cameras: list[Camera]) -> None:
        super().__init__(window, task)
        self.cameras = cameras

    def show(self, view: View, technique: Parameters) -> float:
        """The view from where the walker was."""
        camera = self.cameras[min(len(self.views), len(self.cameras) - 1)]
        return super().show(replace(view, camera=camera), technique)

    def moved(self) -> bool:
        """Whether the walk goes on."""
        return len(self.views) < len(self.cameras)


def stretches(cameras: list[Camera], every: int) -> list[Camera]:
    """One second of every `every`, from the middle of each; of a shorter walk its middle."""
    long = max(min(every * RATE, len(cameras)), RATE)
    begins = range((long - RATE) // 2, len(cameras) - RATE + 1, long)
    return [camera for begin in begins for camera in cameras[begin : begin + RATE]]


def measured(what: str, seconds: float) -> dict[str, float]:
    """Trials of the published study: one of counting at that level, dragged for so long; or those
    of the walks."""
    study = load("published")
    window = Window(study.display, Texts("en"), RealClock(), "bench")
    hands, records = [], []
    with tempfile.TemporaryDirectory() as folder:
        who = Who("published", "P01", "pilot", 1, {}, design=design_entry(study))
        recorder = FileRecorder(Path(folder), who)
        run = TrialRun(study, Surroundings(window, window, window.clock, recorder, TASKS))
        for trial, walk in _walks(study) if what == "walks" else _counting(study, what):
            hand: Hand
            if walk is None:
                hand = Dragging(window, trial.task, seconds)
            else:
                hand = Walking(window, trial.task, stretches(walk.frames(RATE)[1], EVERY))
            records.append(run.play(trial, 0.0))
            recorder.trial_ends(records[-1])
            hand.let_go()
            hands.append(hand)
        recorder.close("complete")
    views = [view for hand in hands for view in hand.views]
    drawing = _alone(window, views, run.technique(trial))
    window.close()
    frames = sum(record.frames for record in records)
    return {
        "frames": frames,
        "moved": sum(_pose(a) != _pose(b) for a, b in pairwise(views)) / frames,
        "missed": sum(record.frames_missed for record in records) / frames,
        "worst": max(record.worst_frame for record in records),
        "cpu": -sum(hand.cpu for hand in hands) / frames,
        "drawing": drawing,
    }


def _counting(study: Study, level: str) -> Iterator[tuple[Trial, None]]:
    trials = [t for s in session_for(1, study.plan) for t in s.trials]
    of_level = ("count", level)
    yield next(t for t in trials if (t.task, t.levels["transparency"]) == of_level), None


def _walks(study: Study) -> Iterator[tuple[Trial, Walked]]:
    for walk in walked():
        if walk.level == "standard":
            trials = [t for s in session_for(walk.slot, study.plan) for t in s.trials]
            yield next(t for t in trials if t.number == walk.trial), walk


def _pose(view: View) -> bytes:
    return view.camera.eye.tobytes() + view.camera.rotation.tobytes()


def _alone(window: Window, views: list[View], technique: Parameters) -> float:
    step = max(len(views) // AGAIN, 1)
    renderer, target = window.stage.renderer, window.context.screen
    start = time.process_time()
    for view in views[::step]:
        renderer.draw(view.scene, view.camera, technique, target)
        window.context.finish()
    return (time.process_time() - start) / len(views[::step])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("standard", "dynamic", "walks"))
    parser.add_argument("seconds", type=float, nargs="?", default=10.0)
    given = parser.parse_args()
    print(json.dumps(measured(given.what, given.seconds)))
