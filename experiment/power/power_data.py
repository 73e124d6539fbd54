"""Effects from the participants of a data folder, reduced as the analysis reduces them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from seethrough.analysis import measures
from seethrough.analysis.cells import Cells
from seethrough.analysis.design import ABSOLUTE, Contrast, Measured
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.study import Study, load_study
from seethrough.analysis.tradeoff import price_of
from seethrough.experiment.errors import InputError
from seethrough.experiment.power.power import SampledEffect
from seethrough.experiment.power.power_ranks import RankEffect


def sampled(folder: Path, source: str = "simulated") -> list[SampledEffect | RankEffect]:
    """Times, errors, right answers, distances and ratings of a folder's participants.

    Each with the test that the analysis makes of it. Raises DataError for a folder that a report
    refuses, InputError for one that has no such participants.
    """
    try:
        study = load_study(folder, source)
    except DataError as error:
        raise DataError(f"--effect = {folder}: {line}" for line in error.lines) from None
    design, trials = study.design, study.trials
    contrast = next((c for c in design.contrasts() if not c.between), None)
    levels = () if contrast is None else (contrast.baseline, contrast.level)
    if contrast is None or not set(levels) <= set(trials[contrast.factor].astype("str")):
        name = "any factor" if contrast is None else contrast.factor
        raise InputError(f"--effect = {folder}: expected trials of both levels of {name}")
    plain = [m for m in design.measures() if not m.ranked]
    effects = [e for m in plain for e in _effects(study, m, contrast)]
    ranked = [e for m in design.measures() if m.ranked for e in _effects(study, m, contrast)]
    ranked += _ratings(study, contrast)
    if any(len(effect.values) < 2 for effect in (*effects, *ranked)):
        raise InputError(f"--effect = {folder}: expected at least 2 complete participants")
    return [*effects, *map(RankEffect, ranked)]


def _effects(study: Study, measure: Measured, contrast: Contrast) -> Iterator[SampledEffect]:
    """A measure's effects: over its tasks, for a time, and in each; what a task is not judged by is
    left out."""
    if measure.adds == ABSOLUTE:
        return
    cells = measures.cells_of(study.trials, study.design, measure)
    tasks = cells.factors[measures.TASK]
    name = "time" if measure.log else measure.said
    if measure.log and len(tasks) > 1:
        yield _effect(f"{name}, overall", measures.over_tasks(cells), contrast)
    for task in tasks:
        found = _effect(f"{name} {task}", cells, contrast, task=task)
        own = study.design.task(task)
        price = price_of(own) if own else None
        if not measure.ranked or (price is not None and price.name == measure.name):
            yield found


def _ratings(study: Study, contrast: Contrast) -> Iterator[SampledEffect]:
    """The mean of the items that are asked for each level."""
    asked = [i for i in study.design.items or () if contrast.factor in i.each]
    if not asked or not len(study.questionnaire):
        return
    factors = [study.design.factor(name) for name in asked[0].each]
    own = [i.name for i in asked if i.each == asked[0].each]
    cells = measures.ratings(study.questionnaire, own, factors)
    if {contrast.baseline, contrast.level} <= set(cells.factors[contrast.factor]):
        yield _effect("rating, overall", cells, contrast)


def _effect(name: str, cells: Cells, contrast: Contrast, **at: str) -> SampledEffect:
    """Whoever has both levels of it, as in the report."""
    levels = (contrast.baseline, contrast.level)
    pairs = np.stack(cells.both(contrast.factor, *levels, **at), axis=1)
    return SampledEffect(name, pairs[np.isfinite(pairs).all(axis=1)])
