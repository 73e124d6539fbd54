"""Every Display, Input and Recorder keeps to what a session relies on."""

import csv
import sys

import numpy as np
import pytest
from desktop import Desktop, Program, wait_until
from protocol_suites import keeps_to_display, keeps_to_input, keeps_to_recorder
from published_design import published
from recorded import VIEW

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.driver import open_context
from seethrough.experiment.display.offscreen import OffscreenDisplay
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs.data_mode import Played, TableDisplay
from seethrough.experiment.people.runs.pool import drawing
from seethrough.experiment.people.simulated_input import SimulatedInput
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import Trial, session_for
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome

STUDY = load("demo")
LEVELS = {"transparency": "dynamic", "scenario": "abstract"}
TRIAL = Trial(5, 1, 2, 2, LEVELS, "count", "stream-1", (1, 1), world="abstract")
RECORD = TrialRecord(
    TRIAL, Outcome("12", "14", False, count_error=-2), 14, 10.0, 52.25, 2.25, False,
    2500, 3, 0.05, 12.5, 3.25,
)  # fmt: skip


def setup(kind):
    """(display, clock, task, two views, technique) of a display for simulated people."""
    clock, pool = SimulatedClock(100.0), drawing(STUDY, 1)
    size = (320, 240)
    display = (
        OffscreenDisplay(open_context(), size, clock)
        if kind == "offscreen"
        else TableDisplay(pool, clock, 4 / 3)
    )
    trials = [s.trials[0] for s in session_for(1, STUDY.plan)]
    trial = next(t for t in trials if t.task == "count")
    task, state = TASKS["count"], pool.begin(TASKS["count"], trial, 4 / 3)
    views = [task.view(state)]
    turned = next(t for t in trials if t.task == "pattern")
    views.append(TASKS["pattern"].view(pool.begin(TASKS["pattern"], turned, 4 / 3)))
    return display, clock, task, views, STUDY.part(trial.levels).technique


@pytest.mark.parametrize("kind", ["offscreen", "tables"])
def test_displays_for_simulated_people(kind):
    display, clock, _, views, technique = setup(kind)
    keeps_to_display(display, clock, views, technique)


@pytest.mark.parametrize("kind", ["offscreen", "tables"])
def test_simulated_people_at_them(kind):
    display, clock, task, views, technique = setup(kind)
    person = SimulatedInput(SimulatedParticipant(np.random.default_rng(3)), display, clock)
    keeps_to_input(person, clock, task, views, lambda view: display.show(view, technique))


WINDOW = """
import sys
sys.path[:0] = {path!r}
import numpy as np
from recorded import VIEW
from published_design import published
from protocol_suites import keeps_to_display, keeps_to_input
from test_protocols import STUDY, setup
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.display.driver import open_context
from seethrough.experiment.display.looking import Looking
from seethrough.experiment.display.window import Window
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.watched_input import WatchedInput

_, _, task, views, technique = setup("tables")
window = Window(STUDY.display, Texts("en"), RealClock(), "suite")
keeps_to_display(window, window.clock, views, technique)
looking = Looking(open_context(), (160, 120))
person = WatchedInput(SimulatedParticipant(np.random.default_rng(3)), window, looking)
keeps_to_input(person, window.clock, task, views, lambda view: window.show(view, technique))
window.close()
print("kept to both")
"""


def test_the_window_and_who_is_watched_in_it(tmp_path):
    script = tmp_path / "suite.py"
    here = [p for p in sys.path if p.endswith("support")] + [__file__.rpartition("/")[0]]
    script.write_text(WINDOW.format(path=here), "utf-8")
    with (
        Desktop() as screen,
        Program(screen, tmp_path / "log", str(script), start=(sys.executable,)) as program,
    ):
        wait_until(lambda: not program.running(), 60, "the suite's end")
        assert "kept to both" in program.said(), program.said()


def test_the_recorder_of_files(tmp_path):
    recorder = FileRecorder(
        tmp_path, Who("test", "P01", "human", 1, {"seed": 3}, design=published())
    )
    folder = tmp_path / "data" / "human" / "P01"

    def read():
        found = []
        for kind in ("trials", "questionnaire"):
            rows = []
            for table in folder.glob(f"*{kind}_data.csv"):
                with open(table, encoding="utf-8", newline="") as file:
                    rows += list(csv.DictReader(file))
            found.append(rows)
        return tuple(found)

    keeps_to_recorder(recorder, RECORD, VIEW, read)


def test_the_recorder_of_data_mode():
    played = Played("test", "S01", 1)
    keeps_to_recorder(played, RECORD, VIEW, lambda: (played.trials[:], played.questions[:]))
