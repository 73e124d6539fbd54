"""A small study's data folder, recorded by the recorder itself: for tests of what reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.software import provenance
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.events import KeyPress, PointerMove, Tick
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Outcome, View

STUDY = load("demo")
VIEW = View(Scene(()), look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3)))
REMARK = 'a "quoted" text,\nwith\ttabs, =HYPERLINK("x") and <b>ümläuts</b>'
OUTCOMES = {
    "count": Outcome("12", "14", False, count_error=-2),
    "pattern": Outcome("K", "K", True),
    "unique": Outcome("1.0 2.0", "3.0 4.0", True, distance=2.8284271247461903),
    "count_in_building": Outcome("3", "3", True, count_error=0),
}


def record(
    data: Path, participant: str, slot: int, source: str = "human", remark: str = REMARK
) -> None:
    """A whole session of the demo study, its first trial repeated, one trial timed out."""
    clock = iter(range(10_000))
    display = {"renderer": "none", "size": "800x600", "refresh_declared": "60"}
    who = Who(
        "demo", participant, source, slot, provenance(STUDY, display), design=design_entry(STUDY)
    )

    def now() -> str:
        second = next(clock)
        return f"2026-01-02T03:{second // 60:02d}:{second % 60:02d}.500Z"

    recorder = FileRecorder(data, who, now)
    trials = [t for s in session_for(slot, STUDY.plan) for t in s.trials]
    for trial in [trials[0], *trials]:
        recorder.trial_begins(trial)
        recorder.frame(1.0, VIEW)
        recorder.event(PointerMove(1.5, 0.5, 0.25, 0.1, 0.0, True))
        recorder.event(Tick(2.0))
        recorder.event(KeyPress(2.5, "enter"))
        end = 1.0 + trial.number / 7 + slot
        timed_out = trial is trials[-1]
        outcome = None if timed_out else OUTCOMES[trial.task]
        times = (1.0, end, 0.25, timed_out)
        recorder.trial_ends(TrialRecord(trial, outcome, 14, *times, 60, 1, 0.05, 12.5, 3.25))
    for number, cell in enumerate(STUDY.plan.conditions()):
        recorder.answers([{"item": "ease", "value": str(number), **cell}])
    recorder.answers([{"item": "remarks", "text": remark}])
    recorder.note(trials[0], "the phone\trang")
    recorder.close("complete")
