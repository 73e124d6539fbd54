"""A short session through the real session code, drawn and recorded, played by a script."""

import numpy as np

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.driver import describe
from seethrough.experiment.display.looking import Looking
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.simulated_input import SimulatedInput
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.software import provenance
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import parse
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.events import (
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    SecondPress,
    SecondRelease,
    Tick,
    Wheel,
)
from seethrough.renderer.gpu.device.context import standalone
from seethrough.tasks.catalog import TASKS

FACTORS = {
    "transparency": {"levels": {
        "standard": {"technique": {"use": "standard"}},
        "dynamic": {"technique": {"use": "dynamic"}},
    }},
    "scenario": {"levels": {
        "abstract": {"world": {"use": "abstract"}, "design": {"tasks": ["count", "pattern"]}},
        "walkthrough": {
            "world": {"use": "building"}, "design": {"tasks": ["unique", "count_in_building"]},
        },
    }},
}  # fmt: skip
STUDY = {
    "study": {"name": "t", "title": "t", "description": "t", "participants": 4, "seed": 1},
    "factors": FACTORS,
    "design": {"trials": 1},
    "practice": {"trials": 0},
    "world": {
        "abstract": {"side": 50.0, "objects": 60, "target_share": [0.3, 0.4]},
        "building": {"grid": 6, "objects": 8, "count": [1, 3], "types": ["chair", "table", "cat"]},
    },
    "display": {"width": 320, "height": 240},
}
FRAME = 0.25  # s of session time between two frames


ANSWERS = {
    "count": ["1", "7", "enter"],
    "pattern": ["x", "enter"],
    "unique": ["space", "left", "enter"],
    "count_in_building": ["2", "enter"],
}


class DrawnDisplay:
    """Draws every view offscreen, as the window does, and digests it."""

    SIZE = (320, 240)
    aspect = 4 / 3

    technique = None

    def __init__(self, clock):
        self.clock = clock
        self.context = standalone()
        self.stage = Stage(self.context, self.SIZE, Texts("en"))
        self.target = self.context.framebuffer([self.context.texture(self.SIZE, 4)])

    def show(self, view, technique):
        self.technique = technique
        self.stage.draw_view(view, technique, self.target, FRAME)
        return self.clock.now()

    def digest(self):
        return self.stage.digest()

    def progress(self, fraction):
        pass

    def describe(self):
        return {**describe(self.context), "size": "320x240"}


class Script:
    """Drags, walks and turns for a dozen frames, then answers by keyboard."""

    def __init__(self, clock):
        self.clock = clock
        self.rng = np.random.default_rng(5)

    def begin_trial(self, task, training):
        self.task, self.frames = task, 0

    def events(self, view):
        self.clock.advance(self.clock.now() + FRAME)
        now, self.frames = self.clock.now(), self.frames + 1
        if self.frames <= 12:
            dx, dy = (float(v) for v in self.rng.uniform(-0.05, 0.05, 2))
            events = [PointerMove(now - 0.1, 0.5 + dx, 0.5 + dy, dx, dy, dragging=True)]
            if self.frames == 1:  # a drag begins with its press; it is none of the buttons
                events.insert(0, PointerPress(now - 0.15, 0.5, 0.5))
            if self.frames == 3:
                events.append(KeyPress(now - 0.05, "up"))
            if self.frames == 7:
                events.append(KeyRelease(now - 0.05, "up"))
            return [*events, Tick(now)]
        keys = ANSWERS[self.task]
        if self.task == "unique" and self.frames == 14:
            return [PointerPress(now, 0.6, 0.5), KeyPress(now, "enter"), Tick(now)]
        keys = keys[:1] if self.task == "unique" else keys
        return [*(KeyPress(now, k) for k in keys), Tick(now)]

    def ask(self, page):
        self.clock.advance(self.clock.now() + 1.0)
        return {"button": "0"}


class Handling(Script):
    """Turns the wheel, presses the right button and keys as well."""

    def events(self, view):
        events = super().events(view)
        now = self.clock.now()
        more = {
            2: [Wheel(now - 0.08, 0.5, 0.5, 3.0)],
            4: [SecondPress(now - 0.09, 0.5, 0.5), SecondRelease(now - 0.08, 0.5, 0.5)],
            5: [KeyPress(now - 0.09, "q"), KeyRelease(now - 0.08, "q")],
            8: [KeyPress(now - 0.09, "e"), KeyRelease(now - 0.08, "e")],
        }
        return [*events[:-1], *more.get(self.frames, []), events[-1]]


class Simulated(SimulatedInput):
    """A simulated person, who looks at what the display draws."""

    def __init__(self, clock, display):
        self._display, self._looking = display, Looking(display.context, display.SIZE, simple=True)
        super().__init__(SimulatedParticipant(np.random.default_rng(6)), self, clock)

    technique = property(lambda self: self._display.technique)
    aspect = property(lambda self: self._display.aspect)

    def events(self, view):
        self._view = view
        return super().events(view)

    def look(self):
        self._looking.technique = self.technique
        return self._looking.look(self._view)


def play_recorded(folder, table=STUDY, script=Script):
    """Play participant P01's session into `folder`."""
    study = parse(table, "test")
    clock = SimulatedClock(1000.0)
    display = DrawnDisplay(clock)
    who = Who(
        "t", "P01", "human", 1, provenance(study, display.describe()), design=design_entry(study)
    )
    hands = script(clock, display) if script is Simulated else script(clock)
    world = Surroundings(display, hands, clock, FileRecorder(folder, who), TASKS)
    assert run_session(study, 1, world) == "complete"
