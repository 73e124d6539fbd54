"""People of a data folder of this study, reduced to scores as its report reduces them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from seethrough.analysis import measures
from seethrough.analysis.cells import people as people_of
from seethrough.analysis.design import Design
from seethrough.analysis.errors import DataError
from seethrough.analysis.exclude import apply_rules
from seethrough.analysis.load.plan import make_plan
from seethrough.analysis.load.study import load_study
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.tests.measured import OVERALL, pair_key, pairs_of
from seethrough.analysis.stats.ties import signs, slack
from seethrough.experiment.errors import InputError
from seethrough.experiment.power.planned import Plans, Score, groups_of
from seethrough.experiment.power.sources import Sampled

Array = NDArray[np.float64]
ASKED = ("factors", "tasks", "excluded", "predictions")  # of a design, what scores rest on


def context_of(folder: Path, source: str | None, design: Design) -> Context:
    """A folder as its report reads it, exclusions and all.

    Raises DataError for a folder that a report refuses, InputError for another study's.
    """
    try:
        study = load_study(folder, source)
    except DataError as error:
        raise DataError(f"--effect = {folder}: {line}" for line in error.lines) from None
    other = [part for part in ASKED if getattr(study.design, part) != getattr(design, part)]
    if other:
        words = "levels left out" if other == ["excluded"] else " and ".join(other)
        raise InputError(f"--effect = {folder}: expected data of this study: other {words} there")
    plan = make_plan(study)
    trials, excluded = apply_rules(study.trials, plan.exclude, plan.too_fast)
    return Context(study, plan, trials, excluded, 1)


def sampled(context: Context, plans: Plans) -> tuple[Sampled, Array]:
    """The people of a folder by group, and all of their scores (people, columns).

    Raises InputError where a group has fewer than two people, or nobody has a score.
    """
    design, trials = context.design, context.study.trials
    people = people_of(trials)
    scores = np.stack([_column(context, s, people) for s in plans.scores], axis=1)
    own = [measures.groups_of(trials, f, people) for f in design.groups]
    keys = list(zip(*own, strict=True)) if own else [()] * len(people)
    parts = []
    for group in groups_of(design):
        at = np.array([key == tuple(group.values()) for key in keys])
        if at.sum() < 2:
            where = f" in the group {', '.join(group.values())}" if group else ""
            raise InputError(
                f"--effect: expected at least 2 participants{where}, got {int(at.sum())}"
            )
        parts.append(scores[at])
    for k, score in enumerate(plans.scores):
        if not np.isfinite(scores[:, k]).any():
            what = score.item or (score.measure.said if score.measure else "")
            raise InputError(
                f"--effect: expected somebody with {what} {score.where}: nobody has it"
            )
    shares = tuple(len(part) / len(people) for part in parts)
    return Sampled(tuple(parts), shares), scores


def _column(context: Context, score: Score, people: list[str]) -> Array:
    """(n,) a score of everybody, NaN for who lacks it."""
    found = np.full(len(people), np.nan)
    if score.measure is None:
        return _item(context, score.item, people)
    measure, contrast, design = score.measure, score.contrast, context.design
    assert contrast is not None
    cells = measures.cells_of(context.trials, design, measure)
    logs = measures.cells_of(context.trials, design, measure, log=True) if measure.log else None
    if contrast.between:
        used = logs or cells
        own = measures.over_tasks(used) if score.where == OVERALL else used.pick(task=score.where)
        place = {name: k for k, name in enumerate(own.participants)}
        values = own.at()
        return np.array([values[place[name]] if name in place else np.nan for name in people])
    several = len([c for c in design.contrasts() if not c.between]) > 1
    key = pair_key(measure.name, score.where, contrast, several)
    pair = next((p for p in pairs_of(context, measure, cells, logs) if p.key == key), None)
    if pair is None:
        return found
    first, second = pair.logs if pair.logs is not None else (pair.first, pair.second)
    place = {name: k for k, name in enumerate(people)}
    at = [place[name] for name in pair.participants]
    found[at] = scores_of(score, first, second)
    return found


def scores_of(score: Score, first: Array, second: Array) -> Array:
    """(n,) scores of baseline and level, (n,) each: exactly 0 where the two are equal up to
    rounding, as the report has it, so that whoever draws these people need not know what the scores
    were made from."""
    first, second = score.first * first, score.second * second
    found = first + second
    return np.where(signs(found, slack(first, second)) == 0, 0.0, found)


def _item(context: Context, item: str, people: list[str]) -> Array:
    """What everybody answered to what was asked once."""
    asked = context.study.questionnaire
    if not len(asked):
        return np.full(len(people), np.nan)
    own = asked[asked["item"].astype("str") == item]
    values = pd.to_numeric(own["value"], errors="coerce")
    mean = values.groupby(own["participant"].astype("str")).mean()
    return np.array([float(mean.get(name, np.nan)) for name in people])
