"""Kills sessions at random moments and looks at what is on disk.

    python tests/support/killed_sessions.py COUNT SEED FOLDER

Each session is a fork that plays through the real session code and recorder, without drawing, and
tells through a pipe when a trial's or a page's record has returned; at a random moment it gets
SIGKILL. Then the participant goes on, and has played and answered everything once.
"""

import csv
import io
import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.record.chain import verify
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.resume import starting_point
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import parse
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.events import KeyPress, PointerMove, Tick
from seethrough.tasks.catalog import TASKS

VIEWS = {
    "standard": {"technique": {"use": "standard"}},
    "dynamic": {"technique": {"use": "dynamic"}},
}
STUDY = parse(
    {
        "study": {"name": "k", "title": "k", "description": "k", "participants": 1, "seed": 1},
        "factors": {"transparency": {"levels": VIEWS}},
        "design": {"trials": 6, "tasks": ["count", "pattern"]},
        "practice": {"trials": 0},
        "world": {
            "use": "abstract",
            "abstract": {"side": 50.0, "objects": 60, "target_share": [0.3, 0.4]},
        },
        "session": {"resume": "trial"},
        "questions": {
            "demographics": {}, "color_check": {}, "ratings": {}, "comparison": {}, "tlx": {},
            "sus": {}, "depth_test": {}, "remarks": {},
        },
    },
    "killed sessions",
)  # fmt: skip
TRIALS = 24
DELAY = 0.02  # s after what was said last: a page takes 5 ms, a trial about 8
REMARKS = 'two lines,\nof which the second "ends"\n'


class Script:
    """A display and an input in one: a few frames of dragging, then an answer."""

    aspect = 4 / 3

    def __init__(self, clock, told):
        self.clock, self.told = clock, told

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
        if any(hasattr(block, "name") for block in page.blocks):
            os.write(self.told, b"!")  # a page of questions is shown
        time.sleep(0.005)  # and moments on its pages
        answers = {"button": "0", "age": "30", "gender": "1", "remarks": REMARKS}
        return answers | dict.fromkeys(page.required, "1")


class Telling(FileRecorder):
    """A recorder that puts a byte into a pipe for every answer that is on disk."""

    def answers(self, rows):
        super().answers(rows)
        os.write(self.told, b"?" * len(rows))


def play(folder, told):
    """Play on until killed; a byte into the pipe for a page shown, a trial or answer on disk."""
    clock, start = SimulatedClock(), starting_point(STUDY, folder, "human", "P01", 1)
    who = Who("k", "P01", "human", 1, {"study_sha256": STUDY.digest()}, start.session,
              design_entry(STUDY))  # fmt: skip
    script, recorder = Script(clock, told), Telling(folder, who, attempts=start.attempts)
    recorder.told = told
    world = Surroundings(script, script, clock, recorder, TASKS, lambda _: os.write(told, b"."))
    assert run_session(STUDY, 1, world, start.done, start.given) == "complete"


def killed(folder, after, delay):
    """Play in a fork, kill it `delay` seconds after so many bytes; all that it said."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read)
        play(folder, write)
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb", buffering=0) as pipe:
        said = b"".join(pipe.read(1) for _ in range(after))
        time.sleep(delay)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return said + pipe.readall()


def rows_of(folder, name):
    """Every whole row of the sessions' tables of a name. Raises AssertionError at half a row."""
    rows = []
    for table in sorted(folder.glob(f"data/human/P01/*_{name}_data.csv")):
        text = table.read_bytes().decode("utf-8")
        assert text == "" or text.endswith("\n"), "half a row"
        rows += csv.DictReader(io.StringIO(text, newline=""))
    assert all(None not in r.values() and None not in r for r in rows), "a row of another length"
    return rows


def look(folder, told):
    """Raise AssertionError unless the files hold what was told, whole; trials and answers there."""
    trials, answers = told.count(b"."), told.count(b"?")
    rows, given = rows_of(folder, "trials"), rows_of(folder, "questionnaire")
    assert [int(r["trial"]) for r in rows] == list(range(1, len(rows) + 1))
    assert trials <= len(rows) <= trials + 1, f"told of {trials} trials, {len(rows)} on disk"
    page = 11  # rows of the longest
    assert answers <= len(given) <= answers + page, f"told of {answers}, {len(given)} on disk"
    # Each page brings one row at least, before the next is shown.
    assert len(given) >= told.count(b"!") - 1, f"{told.count(b'!')} pages, {len(given)} answers"
    for row in rows:
        assert (folder / "data/human/P01" / row["events_file"]).read_text().endswith("\n")
    return len(rows), len(given)


def go_on(folder, whole):
    """The participant's next session: in the end each trial and item is there once, as `whole`."""
    begun, told = list(folder.glob("data/human/P01/*_trials_data.json")), os.open(os.devnull, 1)
    if list(folder.glob("data/human/P01/*_end.json")):
        return
    before = len(rows_of(folder, "trials"))
    start = starting_point(STUDY, folder, "human", "P01", 1)
    assert start.done == frozenset(range(1, before + 1)) and start.session == len(begun) + 1
    play(folder, told)
    assert everything(folder) == whole
    assert verify(folder / "data/human/P01") == []


def everything(folder):
    """Trials and answers in their order, in all sessions."""
    trials = [int(r["trial"]) for r in rows_of(folder, "trials")]
    names = ("item", "transparency", "value", "text")
    return trials, [tuple(r[n] for n in names) for r in rows_of(folder, "questionnaire")]


def main(count, seed, folder):
    rng = np.random.default_rng(seed)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "said", "w+b", buffering=0) as said:
        play(folder / "whole", said.fileno())
        said.seek(0)
        most, whole = len(said.read()), everything(folder / "whole")
    assert whole[0] == list(range(1, TRIALS + 1))
    kept = []
    for number in range(count):
        place = folder / f"{number:03d}"
        moment = int(rng.integers(most)), float(rng.uniform(0, DELAY))
        kept.append(look(place, killed(place, *moment)))
        go_on(place, whole)
    trials, answers = (sum(n) for n in zip(*kept, strict=True))
    asking = sum(0 < n < len(whole[1]) for t, n in kept if t in (0, TRIALS))
    print(
        f"{count} sessions killed, {trials} trials and {answers} answers kept, none lost; "
        f"{asking} killed among the pages, {len(set(kept))} lengths"
    )


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))
