"""Kills sessions at random moments and looks at what is on disk.

    python tests/support/killed_sessions.py COUNT SEED FOLDER

Each session is a fork that plays through the real session code and recorder, without drawing, and
tells through a pipe when a trial's record has returned; at a random moment it gets SIGKILL.
"""

import csv
import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

from experiment.clock import SimulatedClock
from experiment.config import parse
from experiment.recorder import FileRecorder, Who
from experiment.resume import starting_point
from experiment.session import run_session
from experiment.world import World
from tasks.catalog import TASKS
from tasks.events import KeyPress, PointerMove, Tick

STUDY = parse(
    {
        "study": {"name": "k", "title": "k", "description": "k", "participants": 1, "seed": 1},
        "design": {"trials": 6, "training": 0, "tasks": ["count", "pattern"]},
        "abstract": {"side": 50.0, "objects": 60, "target_share": [0.3, 0.4]},
        "session": {"questionnaire": [], "resume": "trial"},
    },
    "killed sessions",
)
TRIALS = 24


class Script:
    """A display and an input in one: a few frames of dragging, then an answer."""

    aspect = 4 / 3

    def __init__(self, clock):
        self.clock = clock

    def show(self, view, technique):
        return self.clock.now()

    def digest(self):
        return ""

    def progress(self, fraction):
        pass

    def describe(self):
        return {}

    def begin_trial(self, task, training):
        self.task, self.frames = task, 0

    def events(self, view):
        time.sleep(0.001)  # gives the killer moments inside a trial
        self.clock.advance(self.clock.now() + 1 / 60)
        now, self.frames = self.clock.now(), self.frames + 1
        if self.frames < 5:
            return [PointerMove(now, 0.5, 0.5, 0.01, 0.01, True), Tick(now)]
        keys = ["1", "7", "enter"] if self.task == "count" else ["x", "enter"]
        return [*(KeyPress(now, k) for k in keys), Tick(now)]

    def ask(self, page):
        return {"button": "0"}


def play(folder, told):
    """Play until killed; one byte into the pipe for every trial that is on disk."""
    clock = SimulatedClock()
    who = Who("k", "P01", "human", 1, {"study_sha256": STUDY.digest()})
    script = Script(clock)
    world = World(
        script, script, clock, FileRecorder(folder, who), TASKS, lambda _: os.write(told, b".")
    )
    run_session(STUDY, 1, world)


def killed(folder, moment):
    """Play in a fork, kill it after `moment` seconds; how many trials it said were on disk."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read)
        play(folder, write)
        os._exit(0)
    os.close(write)
    time.sleep(moment)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    with os.fdopen(read, "rb") as pipe:
        return len(pipe.read())


def look(folder, told):
    """Raise AssertionError unless the files hold what was told, whole; the trials on disk."""
    tables = list(folder.glob("data/human/P01/*_trials_data.csv"))
    if not tables:
        assert told == 0
        return 0
    text = tables[0].read_text(encoding="utf-8")
    assert text == "" or text.endswith("\n"), "half a row"
    rows = list(csv.DictReader(text.splitlines()))
    assert [int(r["trial"]) for r in rows] == list(range(1, len(rows) + 1))
    assert all(None not in r.values() and None not in r for r in rows), "a row of another length"
    assert told <= len(rows) <= told + 1, f"told of {told} trials, {len(rows)} on disk"
    for row in rows:
        assert (tables[0].parent / row["events_file"]).read_text().endswith("\n")
    if len(rows) < TRIALS:
        start = starting_point(STUDY, folder, "human", "P01", 1)
        assert start.done == frozenset(range(1, len(rows) + 1)) and start.session == 2
    return len(rows)


def main(count, seed, folder):
    rng = np.random.default_rng(seed)
    began = time.perf_counter()
    play(folder / "whole", os.open(os.devnull, 1))
    whole = time.perf_counter() - began
    kept = []
    for number in range(count):
        place = folder / f"{number:03d}"
        kept.append(look(place, killed(place, float(rng.uniform(0, whole)))))
    print(f"{count} sessions killed, {sum(kept)} trials kept, none lost; {len(set(kept))} lengths")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))
