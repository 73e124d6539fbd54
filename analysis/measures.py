"""From trials to one value per participant and cell, by what the design says of each measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells, level_codes, means, people, sums, table_of
from seethrough.analysis.design import ABSOLUTE, RELATIVE, Design, Factor, Measured
from seethrough.analysis.stats.arrays import Array

TASK = "task"


def levels_present(table: pd.DataFrame, column: str, known: Sequence[str]) -> tuple[str, ...]:
    """The known levels that occur, in their usual order; unused ones play no part."""
    there = {str(level) for level in pd.unique(table[column])}
    return tuple(level for level in known if level in there)


def levels_of(
    table: pd.DataFrame, factors: Sequence[Factor], tasks: Sequence[str] = ()
) -> dict[str, tuple[str, ...]]:
    """The levels that a table has of task (where `tasks` are given) and of each factor."""
    own = {TASK: levels_present(table, TASK, tasks)} if tasks else {}
    return own | {f.name: levels_present(table, f.name, f.levels) for f in factors}


def cells_of(
    trials: pd.DataFrame, design: Design, measure: Measured, log: bool = False
) -> Cells:  # fmt: skip
    """A measure: task × the within factors that vary inside a task, by participant.

    `log`: the mean of the trials' logarithms instead. Its exponential is a geometric mean of
    trials: one trial of 10⁶ s among three then moves a ratio by the cube root of what it moves a
    mean.
    """
    own = trials[trials[TASK].isin(design.tasks_with(measure.name))]
    factors = levels_of(own, design.crossed, design.task_names)
    if measure.rows == "right":
        own = own[own["correct"] == 1]
    if log:
        column = f"log_{measure.column}"
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = np.log(own[measure.column].to_numpy(dtype=np.float64))
        own = own.assign(**{column: np.where(np.isfinite(logs), logs, np.nan)})
        return means(own, column, factors)
    if measure.adds in (RELATIVE, ABSOLUTE):
        return _relative(own, measure, factors)
    if measure.adds == "sum":
        (total,), counts, names = sums(own, [measure.column], factors)
        return table_of(total, counts, names, factors)
    if measure.adds == "median":
        return _medians(own, measure.column, factors)
    return means(own, measure.column, factors)


def _relative(own: pd.DataFrame, measure: Measured, factors: dict[str, tuple[str, ...]]) -> Cells:
    """Sums of errors over sums of what was true, of the trials that have both."""
    error = own[measure.column]
    truth = pd.to_numeric(own["truth"].astype("str"), errors="coerce")
    own = own.assign(_off=error.abs() if measure.adds == ABSOLUTE else error, _truth=truth)
    (off, true), counts, names = sums(own, ["_off", "_truth"], factors)
    with np.errstate(invalid="ignore", divide="ignore"):
        return table_of(np.abs(off) / true, counts, names, factors)


def _medians(own: pd.DataFrame, column: str, factors: dict[str, tuple[str, ...]]) -> Cells:
    """Median of a person's trials in each cell."""
    names = people(own)
    keys = [level_codes(own["participant"], names)]
    keys += [level_codes(own[factor], levels) for factor, levels in factors.items()]
    values = own[column].to_numpy(dtype=np.float64)
    known = ~np.isnan(values) & np.all([k >= 0 for k in keys], axis=0)
    shape = (len(names), *(len(levels) for levels in factors.values()))
    flat = np.ravel_multi_index([k[known] for k in keys], shape) if known.any() else np.array([])
    grouped = pd.Series(values[known]).groupby(flat)
    found, counts = np.full(int(np.prod(shape)), np.nan), np.zeros(int(np.prod(shape)), np.intp)
    if len(flat):
        at = grouped.median()
        found[at.index.to_numpy(dtype=np.intp)] = at.to_numpy()
        counts[at.index.to_numpy(dtype=np.intp)] = grouped.size().to_numpy()
    return table_of(found.reshape(shape), counts.reshape(shape), names, factors)


def over_tasks(cells: Cells) -> Cells:
    """The plain mean over the tasks, of who has them all."""
    levels = {name: known for name, known in cells.factors.items() if name != TASK}
    return Cells(cells.values.mean(axis=1), cells.counts.sum(axis=1), cells.participants, levels)


def by_nesting(cells: Cells, factor: Factor, trials: pd.DataFrame) -> Cells:
    """The factor × the crossed ones: the mean of the tasks nested in each of its levels."""
    pairs = trials[[TASK, factor.name]].drop_duplicates()
    level_of = {str(t): str(s) for t, s in zip(pairs[TASK], pairs[factor.name], strict=True)}
    tasks = cells.factors[TASK]
    there = tuple(s for s in factor.levels if s in {level_of[t] for t in tasks})
    picks = [[i for i, t in enumerate(tasks) if level_of[t] == s] for s in there]
    values = np.stack([cells.values[:, p].mean(axis=1) for p in picks], axis=1)
    counts = np.stack([cells.counts[:, p].sum(axis=1) for p in picks], axis=1)
    others = {name: known for name, known in cells.factors.items() if name != TASK}
    return Cells(values, counts, cells.participants, {factor.name: there, **others})


def groups_of(trials: pd.DataFrame, factor: Factor, names: Sequence[str]) -> tuple[str, ...]:
    """Each participant's level of a factor between people, in the order of `names`."""
    first = trials.drop_duplicates("participant")
    own = dict(zip(first["participant"].astype("str"), first[factor.name].astype("str"),
                   strict=True))  # fmt: skip
    return tuple(own.get(name, "") for name in names)


def wrong(cells: Cells) -> Cells:
    """Shares wrong of shares right."""
    return replace(cells, values=1 - cells.values)


def ratings(asked: pd.DataFrame, names: Sequence[str], factors: Sequence[Factor]) -> Cells:
    """Answers: item × the factors that they are asked for each level of."""
    own = asked[asked["item"].isin(list(names))]
    levels = {"item": levels_present(own, "item", names), **levels_of(own, factors)}
    return means(own, "value", levels)


def answers(questionnaire: pd.DataFrame, item: str) -> Array:
    """All values of an item asked once per participant."""
    values = questionnaire.loc[questionnaire["item"] == item, "value"].to_numpy(dtype=np.float64)
    given: Array = values[~np.isnan(values)]
    return given
