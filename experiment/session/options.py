"""What a study may ask of any task: how sure one is of an answer, and to say that one is not."""

from __future__ import annotations

from dataclasses import replace

from seethrough.experiment.display.display import Leave
from seethrough.experiment.pages.pages import Page, Scale
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.strangers import Watched, is_stranger
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.design.factors import Levels
from seethrough.experiment.study.study import Study
from seethrough.tasks.kit.base import Task, opaque
from seethrough.tasks.kit.measure import CONFIDENCE
from seethrough.tasks.kit.unsure import Unsure

STEPS = 5  # of confidence, counted from 1


def as_asked(task: Task, study: Study, trial: Trial) -> Task:
    """The task as the study wants it in a trial; watched if a stranger's code is in it."""
    for kind, name in (("task", trial.task), ("world", trial.world)):
        if is_stranger(kind, name):
            task = Watched(task, kind, name)
            break
    unsure = study.part(trial.levels).task_options.of(trial.task).unsure
    return opaque(Unsure(task)) if unsure else task


def with_confidence(record: TrialRecord, study: Study, world: Surroundings) -> TrialRecord:
    """The record with how sure one is, where the study asks for it and there is an answer. Raises
    Leave of who leaves the page, once the recorder has the record without it."""
    trial, outcome = record.trial, record.outcome
    wanted = study.part(trial.levels).task_options.of(trial.task).confidence
    if not wanted or trial.training or outcome is None or record.repeat:
        return record
    try:
        said = int(world.input.ask(_page(trial.levels))[CONFIDENCE.name]) + 1
    except Leave:
        world.recorder.trial_ends(record)
        raise
    more = {**outcome.more, CONFIDENCE.name: said}
    return replace(record, outcome=replace(outcome, more=more))


def _page(levels: Levels) -> Page:
    asked = Scale(
        CONFIDENCE.name, "confidence.text", "confidence.low", "confidence.high", STEPS, first=1
    )
    return Page("confidence", "confidence.title", (asked,), about=tuple(levels.items()))
