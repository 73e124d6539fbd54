"""Effects from the participants of a data folder, reduced as the analysis reduces them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from seethrough.analysis import measures
from seethrough.analysis.cells import Cells
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.study import load_study
from seethrough.experiment.errors import InputError
from seethrough.experiment.power.power import SampledEffect
from seethrough.experiment.power.power_ranks import RankEffect

LEVELS = ("standard", "dynamic")


def sampled(folder: Path, source: str = "simulated") -> list[SampledEffect | RankEffect]:
    """Times, errors, right answers, distances and ratings of a folder's participants.

    Each with the test that the analysis makes of it. Raises DataError for a folder that a report
    refuses, InputError for one that has no such participants.
    """
    try:
        study = load_study(folder, source)
    except DataError as error:
        raise DataError(f"--effect = {folder}: {line}" for line in error.lines) from None
    trials = study.trials
    if tuple(measures.design(trials)["transparency"]) != LEVELS:
        raise InputError(f"--effect = {folder}: expected trials of both transparency levels")
    times = measures.time_by_task(trials)
    effects = [_effect("time, overall", measures.over_tasks(times))]
    effects += [_effect(f"time {task}", times, task) for task in times.factors["task"]]
    errors = measures.relative_error(trials)
    effects += [_effect(f"relative error {task}", errors, task) for task in errors.factors["task"]]
    if (trials["task"] == "unique").any():
        effects.append(_effect("distance unique", measures.distance(trials)))
    ranked = []
    if "pattern" in times.factors["task"]:
        correct = measures.share_correct(trials)
        ranked.append(_effect("right answers pattern", correct, "pattern"))
    asked = measures.rating(study.questionnaire)
    if len(asked.factors["transparency"]) == 2:
        ranked.append(_effect("rating, overall", asked))
    if any(len(effect.values) < 2 for effect in (*effects, *ranked)):
        raise InputError(f"--effect = {folder}: expected at least 2 complete participants")
    return [*effects, *map(RankEffect, ranked)]


def _effect(name: str, cells: Cells, task: str | None = None) -> SampledEffect:
    """Whoever has both levels of it, as in the report."""
    where = {} if task is None else {"task": task}
    pairs = np.stack([cells.at(**where, transparency=level) for level in LEVELS], axis=1)
    return SampledEffect(name, pairs[np.isfinite(pairs).all(axis=1)])
