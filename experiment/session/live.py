"""A session in a window, wired: the only place that builds everything for a person."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.display import refresh
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.display.display import Input
from seethrough.experiment.display.interrupt import check
from seethrough.experiment.display.window import Window
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.resume import going_on, starting_point
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.software import changed_since, provenance
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.beside.own_model_files import keep
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.translations import demand_texts, texts_of
from seethrough.tasks.catalog import TASKS

if TYPE_CHECKING:
    from seethrough.experiment.people.participant import SimulatedParticipant


def play_in_window(
    study: Study,
    participant: str,
    slot: int,
    source: str,
    data: Path,
    clock: RealClock,
    watched: SimulatedParticipant | None = None,
    about: Mapping[str, object] | None = None,
    guard: Callable[[], None] = lambda: None,
) -> str:
    """Play a slot's session in a window; how it ended. Raises InputError.

    It is `complete`, `left`, `time limit` or `display lost` (experiment/session/session.py).
    An interrupted session of the participant is gone on with, in its own slot. With `watched`, a
    simulated participant, it plays and somebody looks on; without, the window's own events count.
    `about` is what the sidecar says of it besides (`SimulatedParticipant.about`); `guard` raises
    where the session may not write any more (experiment/ledger/ledger_lock.py).
    """
    start = starting_point(study, data, source, participant, slot)
    if start.session > 1:
        print(going_on(study, start), file=sys.stderr, flush=True)
    part = study.session_part(start.slot)
    if start.session == 1:  # who has begun goes on as they began
        demand_texts(study, part.general.language)
    texts = texts_of(study, part.general.language)
    window = Window(part.display, texts, clock, texts.get(study.general.title))
    window.stage.pilot = source == "pilot"
    if not refresh.fits(window.measured, window.declared):
        print(f"display: {refresh.said(window.measured, window.declared)}", file=sys.stderr)
    try:
        check()
        described = provenance(study, window.describe(), speed=clock.speed, **(about or {}))
        if start.made is not None:
            # The study is the same, or it would be refused; the program need not be.
            changed = changed_since(start.made, described)
            described["changed_since"] = changed
            for line in changed:
                print(f"since the session before: {line}", file=sys.stderr, flush=True)
        who = Who(
            study.general.name, participant, source, start.slot, described, start.session,
            design_entry(study),
        )  # fmt: skip
        person: Input = window if watched is None else _simulated(watched, window)
        keep(study, data)  # first: a model that can't be kept begins no session
        recorder = FileRecorder(data, who, attempts=start.attempts, guard=guard)
        world = Surroundings(
            window,
            person,
            clock,
            recorder,
            TASKS,
            say,
            period=window.period,
            waiting=window.waiting,
            explores=watched is None,
            flip_within=lambda: window.flip_within,
        )
        return run_session(study, start.slot, world, start.done, start.given)
    finally:
        window.close()


def _simulated(participant: SimulatedParticipant, window: Window) -> Input:
    from seethrough.experiment.display.looking import Looking
    from seethrough.experiment.people.watched_input import WatchedInput

    looking = Looking(window.context, window.size, simple=True)
    return WatchedInput(participant, window, looking)


def say(record: TrialRecord) -> None:
    """One line on standard error for the experimenter."""
    trial, outcome = record.trial, record.outcome
    answer = outcome.answer if outcome else "timed out"
    print(
        f"trial {trial.number:3d} {' '.join(trial.levels.values())} {trial.task:18s}{answer:>6s} "
        f"{record.time:6.1f} s, {record.frames_missed}/{record.frames} frames missed",
        file=sys.stderr,
        flush=True,
    )
