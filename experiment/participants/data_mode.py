"""Data mode: the same decisions as in the real session, from visibility tables made beforehand."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from experiment.config import Study
from experiment.design import SIMULATED, Trial, generator, session_for
from experiment.pages import Page, Paragraph
from experiment.participants.participant import SimulatedParticipant
from experiment.participants.pool import Pool
from experiment.participants.profile import AVERAGE, Profile
from tasks.base import Outcome
from tasks.catalog import TASKS
from tasks.events import Event, Tick


@dataclass(frozen=True)
class DataTrial:
    """A trial as it went; `events` are kept where somebody asks for them."""

    trial: Trial
    outcome: Outcome | None
    time: float
    looks: int
    targets: int
    events: tuple[Event, ...] = ()


def play_trial(
    participant: SimulatedParticipant,
    pool: Pool,
    trial: Trial,
    now: float,
    aspect: float,
    keep: bool = False,
) -> tuple[DataTrial, float]:
    """One trial from its scene's table; the trial and the time after it."""
    task = TASKS[trial.task]
    name, state = pool.begin(trial, aspect)
    view = task.view(state)
    eyes = pool.eyes(name, trial, view.scene)
    participant.begin_trial(trial.task, now)
    first, looks, kept = now, 0, []
    outcome = None
    while outcome is None:
        events = participant.events(
            view, lambda v=view: eyes.look(v.scene, v.camera), now, trial.task
        )
        looks += 1
        now = max(e.time for e in events)
        ended = now
        # The Tick is the session's: it closes each batch at the time of its last event.
        for event in (*events, Tick(now)):
            if keep:
                kept.append(event)
            state = task.on_event(state, event)
            outcome = task.outcome(state)
            if outcome is not None:
                ended = event.time
                break
        view = task.view(state)
    targets = int(view.scene.targets.sum())
    return DataTrial(trial, outcome, ended - first, looks, targets, tuple(kept)), now


def play_session(
    study: Study,
    slot: int,
    seed: int,
    pool: Pool,
    profile: Profile = AVERAGE,
    without: frozenset[str] = frozenset(),
) -> list[DataTrial]:
    """The trials of a participant's whole session; the pages around them are left out."""
    aspect = study.display.width / study.display.height
    participant = SimulatedParticipant(generator(seed, (SIMULATED, slot)), profile, without)
    now, trials = 0.0, []
    for task_set in session_for(slot, study.design.factors()):
        now += participant.answer(_instruction(task_set.trials[0]))[1]
        for trial in task_set.training:
            _, now = play_trial(participant, pool, trial, now, aspect)
        for trial in task_set.trials:
            played, now = play_trial(participant, pool, trial, now, aspect)
            trials.append(played)
    return trials


def _instruction(trial: Trial) -> Page:
    texts = (f"{trial.task}.instruction", f"{trial.scenario}.controls",
             f"transparency.{trial.transparency}", "progress")  # fmt: skip
    return Page("instruction", f"{trial.task}.title", tuple(Paragraph(t) for t in texts))


def trial_row(study: Study, slot: int, played: DataTrial) -> dict[str, Any]:
    """The trial's row of the trial table (experiment/columns.py)."""
    trial = played.trial
    who = f"S{slot:02d}"
    row = {
        "row_id": f"simulated-{who}-1-trial{trial.number:03d}",
        "study": study.study.name,
        "participant": who,
        "session": 1,
        "source": "simulated",
        "slot": slot,
        "trial": trial.number,
        "block": trial.block,
        "task_set": trial.task_set,
        "trial_in_set": trial.in_set,
        "attempt": 1,
        "transparency": trial.transparency,
        "scenario": trial.scenario,
        "task": trial.task,
        "scene": trial.scene,
        "targets": played.targets,
        "time": played.time,
        "time_clean": played.time,
        "timed_out": False,
        "frames": played.looks,
    }
    return row | (asdict(played.outcome) if played.outcome else {})
