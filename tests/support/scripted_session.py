"""A session's display, input and recorder that remember what happened: no window, no files."""

from dataclasses import dataclass, field

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import parse
from seethrough.renderer.events import KeyPress, Tick
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View

FRAME = 0.25  # s between the frames of the fake display: a binary fraction, so sums are exact
VIEWS = {
    "standard": {"technique": {"use": "standard"}},
    "dynamic": {"technique": {"use": "dynamic"}},
}


def study(**tables):
    return parse(
        {
            "study": {
                "name": "t", "title": "t", "description": "t", "participants": 4, "seed": 1,
            },
            "factors": {"transparency": {"levels": VIEWS}},
            "design": {"trials": 2, "tasks": ["count", "pattern"]},
            "world": {"use": "abstract", "abstract": {"objects": 100, "target_share": [0.2, 0.3]}},
            **tables,
        },
        "test",
    )  # fmt: skip


@dataclass
class FakeDisplay:
    clock: SimulatedClock
    aspect: float = 4 / 3
    shown: list = field(default_factory=list)

    def show(self, view, technique):
        self.shown.append((view, technique))
        return self.clock.now()

    def digest(self):
        return ""

    def progress(self, fraction):
        self.fraction = fraction

    def describe(self):
        return {}


@dataclass
class ScriptedInput:
    """Looks at `thinking` frames, then types what `answer` says for the task."""

    clock: SimulatedClock
    answers: dict
    thinking: int = 3
    pages: list = field(default_factory=list)
    leave_at: int = -1
    trials: int = 0
    frames: int = 0

    def begin_trial(self, task, training):
        self.task, self.frames = task, 0
        self.trials += 1

    def events(self, view):
        assert isinstance(view, View)
        self.clock.advance(self.clock.now() + FRAME)
        self.frames += 1
        now = self.clock.now()
        if self.trials == self.leave_at:
            return [KeyPress(now, "escape"), Tick(now)]
        if self.frames <= self.thinking:
            return [Tick(now)]
        keys = self.answers[self.task]
        return [*(KeyPress(now, k) for k in keys), Tick(now)]

    def ask(self, page):
        self.pages.append(page)
        self.clock.advance(self.clock.now() + 2.0)
        return {"button": "1" if page.name == "leave" else "0"}


@dataclass
class MemoryRecorder:
    begun: list = field(default_factory=list)
    ended: list = field(default_factory=list)
    events: list = field(default_factory=list)
    rows: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    status: str = ""

    def trial_begins(self, trial):
        self.begun.append(trial)

    def event(self, event):
        self.events.append(event)

    def frame(self, time, view, digest=""):
        pass

    def trial_ends(self, record):
        self.ended.append(record)

    def answers(self, rows):
        self.rows.extend(rows)

    def note(self, trial, text):
        self.notes.append((trial, text))

    def close(self, status):
        self.status = status


ANSWERS = {"count": ["2", "0", "enter"], "pattern": ["k", "enter"]}


def play(config, slot=1, done=frozenset(), period=None, **script):
    clock = SimulatedClock(100.0)
    display, recorder = FakeDisplay(clock), MemoryRecorder()
    person = ScriptedInput(clock, ANSWERS, **script)
    world = Surroundings(display, person, clock, recorder, TASKS, period=period)
    status = run_session(config, slot, world, done)
    return status, recorder, person, display
