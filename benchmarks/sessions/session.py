"""What a session costs: first frame, recording, replay. `seethrough bench session`."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.looking import Looking
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.replay.replayer import find_trial, replay
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import SIMULATED, Trial, generator, session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.events import PointerMove, Tick
from seethrough.renderer.gpu.device.context import standalone
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome, View

FRAMES = 3600  # a minute at 60 Hz
DRAGGED = 10.0  # s
IN_A_WINDOW = {  # what window_frames.py is asked for, and what the table calls it
    "standard": "abstract, standard, dragged",
    "dynamic": "abstract, dynamic, dragged",
    "walks": "building, standard, along the walks",
}
FIRST_FRAME = """
import sys, time
from seethrough.experiment.study.config import load
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.pages.pages import Page, Paragraph
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.display.window import Window
study = load("published")
window = Window(study.display, Texts("en"), RealClock(), "bench")
def shown():
    print(time.monotonic()); sys.stdout.flush(); raise SystemExit
window.on_frame = shown
window.ask(Page("welcome", "welcome.title", (Paragraph("welcome.text"),)))
"""


def figures() -> Iterator[Row]:
    """Rows of {figure, scene, value, unit, must, aim, met}, as they are measured."""
    with tempfile.TemporaryDirectory() as folder:
        frame, end = _recording(Path(folder) / "recording")
        yield row("recorder, a frame", "abstract", 1000 * frame, "ms", 1.0)
        yield row("recorder, a trial's end", "abstract", 1000 * end, "ms", 20.0)
        yield row("replay, of real time", "demo", 1 / _replay(Path(folder)), "part", 0.25)
    with _screen() as screen:
        if screen is None:
            return
        yield row("first frame after the command", "published", _first_frame(screen), "s", 3.0)
        for what, scene in IN_A_WINDOW.items():
            found = _in_a_window(what, screen)
            yield row("frames missed in a window", scene, found["missed"], "part", 0.01, 0.002)
            yield row("frames", scene, found["frames"], "frames")
            yield row("of them, from elsewhere", scene, found["moved"], "part", 0.9, more=True)
            yield row("longest frame", scene, 1000 * found["worst"], "ms")
            yield row("a frame, all threads", scene, 1000 * found["cpu"], "ms")
            yield row("of that, the renderer", scene, 1000 * found["drawing"], "ms")


def _first_view(study: Study) -> tuple[Trial, View]:
    from seethrough.experiment.study.study_scenes import StudyScenes

    trial = session_for(1, study.plan)[0].trials[0]
    task = TASKS[trial.task]
    return trial, task.view(StudyScenes(study).begin(task, trial, 4 / 3))


def _recording(folder: Path) -> tuple[float, float]:
    """Seconds for a frame with two events, and for a trial's end with fsync (medians)."""
    study = load("published")
    trial, view = _first_view(study)
    who = Who("published", "P01", "pilot", 1, {}, design=design_entry(study))
    recorder = FileRecorder(folder, who)
    frames, ends = [], []
    for _ in range(5):
        recorder.trial_begins(trial)
        for k in range(FRAMES):
            start = time.perf_counter()
            recorder.event(PointerMove(k / 60, 0.5, 0.5, 0.01, 0.01, True))
            recorder.event(Tick(k / 60))
            recorder.frame(k / 60, View(view.scene, view.camera))
            frames.append(time.perf_counter() - start)
        outcome = Outcome("1", "1", True)
        record = TrialRecord(trial, outcome, 1, 0.0, 60.0, 0.0, False, FRAMES, 0, 0.02, 0.0, 0.0)
        start = time.perf_counter()
        recorder.trial_ends(record)
        ends.append(time.perf_counter() - start)
    recorder.close("complete")
    return float(np.median(frames)), float(np.median(ends))


def _replay(folder: Path) -> float:
    """How many times faster than real time a simulated demo session is replayed and looked at."""
    from seethrough.experiment.display.offscreen import OffscreenDisplay
    from seethrough.experiment.people.participant import SimulatedParticipant
    from seethrough.experiment.people.simulated_input import SimulatedInput
    from seethrough.experiment.session.session import run_session
    from seethrough.experiment.session.software import provenance
    from seethrough.experiment.session.surroundings import Surroundings

    study, clock, context = load("demo"), SimulatedClock(), standalone()
    display = OffscreenDisplay(context, (study.display.width, study.display.height), clock)
    made = provenance(study, display.describe())
    who = Who("demo", "S01", "simulated", 1, made, design=design_entry(study))
    person = SimulatedParticipant(generator(1, (SIMULATED, 1)))
    recorder = FileRecorder(folder / "replay", who)
    run_session(
        study,
        1,
        Surroundings(display, SimulatedInput(person, display, clock), clock, recorder, TASKS),
    )
    shown, start = 0.0, time.perf_counter()
    for number in range(1, 9):
        recorded = find_trial(folder / "replay", "S01", number)
        looking = Looking(context, recorded.size)
        looking.technique = recorded.technique
        times = []
        for frame in replay(recorded):
            looking.look(frame.view)
            times.append(frame.time)
        shown += times[-1] - times[0]
    return shown / (time.perf_counter() - start)


@contextmanager
def _screen() -> Iterator[dict[str, str] | None]:
    """An environment with a display: the desktop's, or an Xvfb of our own; None without either."""
    if os.environ.get("DISPLAY") or shutil.which("Xvfb") is None:
        yield dict(os.environ) if os.environ.get("DISPLAY") else None
        return
    read, write = os.pipe()
    words = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1024x768x24", "-noreset"]
    server = subprocess.Popen(
        [*words, "-nolisten", "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL
    )
    os.close(write)
    try:
        with os.fdopen(read) as number:
            yield {**os.environ, "DISPLAY": f":{number.readline().strip()}"}
    finally:
        server.terminate()
        server.wait(10)


def _in_a_window(what: str, screen: dict[str, str]) -> dict[str, float]:
    """A session in a window of a process of its own (window_frames.py)."""
    module = "seethrough.benchmarks.sessions.window_frames"
    words = [sys.executable, "-m", module, what, str(DRAGGED)]
    done = subprocess.run(
        words, capture_output=True, text=True, check=True, timeout=300, env=screen
    )
    return json.loads(done.stdout)


def _first_frame(screen: dict[str, str]) -> float:
    """Seconds from starting Python to the first page on the screen, the median of three."""
    took = []
    for _ in range(3):
        start = time.monotonic()
        words = [sys.executable, "-c", FIRST_FRAME]
        done = subprocess.run(
            words, capture_output=True, text=True, check=True, timeout=120, env=screen
        )
        took.append(float(done.stdout.split()[0]) - start)
    return float(np.median(took))
