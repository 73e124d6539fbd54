"""Frames of a session in a real window while somebody drags the abstract scene.

    python -m seethrough.benchmarks.sessions.window_frames standard|dynamic [SECONDS]

Prints {frames, missed, worst, cpu, drawing} as JSON: the share of frames that took over 1.5
periods; the worst frame; and the processor time of a frame, of all threads, for the whole of the
session's loop (recorder and digests included) and for the renderer alone on the same views. In s.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from pathlib import Path

from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.display.window import _KEYS, Window
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View

LEFT = 1  # pyglet's number of the left button
AGAIN = 300  # views that the renderer draws again alone


class Hand:
    """Drags in circles, then answers. Its events come as pyglet's do, between two frames."""

    def __init__(self, window: Window, seconds: float) -> None:
        self.window, self.seconds = window, seconds
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
        now = time.perf_counter()
        if self.began is None:
            self.began, self.cpu = now, time.process_time()
            self.window.on_mouse_press(300, 300, LEFT, 0)
        elif now - self.began < self.seconds:
            way = 1 if (now - self.began) % 4 < 2 else -1
            self.window.on_mouse_drag(300, 300, 5 * way, way, LEFT, 0)
        elif self.cpu > 0:
            self.cpu = -(time.process_time() - self.cpu)
            symbols = {ours: theirs for theirs, ours in _KEYS.items()}
            for name in ("1", "enter"):
                self.window.on_key_press(symbols[name], 0)


def measured(transparency: str, seconds: float) -> dict[str, float]:
    """A counting trial of the published study at that level, dragged for so long."""
    study = load("published")
    trials = [t for s in session_for(1, study.plan) for t in s.trials]
    trial = next(t for t in trials if (t.task, t.levels["transparency"]) == ("count", transparency))
    window = Window(study.display, Texts("en"), RealClock(), "bench")
    with tempfile.TemporaryDirectory() as folder:
        recorder = FileRecorder(Path(folder), Who("published", "P01", "pilot", 1, {}))
        hand = Hand(window, seconds)
        run = TrialRun(study, Surroundings(window, window, window.clock, recorder, TASKS))
        record = run.play(trial, 0.0)
        recorder.trial_ends(record)
        recorder.close("complete")
    drawing = _alone(window, hand.views, run.technique(trial))
    window.close()
    return {
        "frames": record.frames,
        "missed": record.frames_missed / record.frames,
        "worst": record.worst_frame,
        "cpu": -hand.cpu / record.frames,
        "drawing": drawing,
    }


def _alone(window: Window, views: list[View], technique: Parameters) -> float:
    step = max(len(views) // AGAIN, 1)
    renderer, target = window.stage.renderer, window.context.screen
    start = time.process_time()
    for view in views[::step]:
        renderer.draw(view.scene, view.camera, technique, target)
        window.context.finish()
    return (time.process_time() - start) / len(views[::step])


if __name__ == "__main__":
    print(json.dumps(measured(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 10.0)))
