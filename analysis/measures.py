"""From trials to one value per participant and condition (study.md, "Measures")."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Array, Cells, means, sums, table_of
from seethrough.analysis.load.schema import SCENARIO, TASKS, TRANSPARENCY

COUNTING = ("count", "count_in_building")
RATINGS = ("efficiency", "ease", "enjoy")


def levels_present(table: pd.DataFrame, column: str, known: Sequence[str]) -> tuple[str, ...]:
    """The known levels that occur, in their usual order; unused ones play no part."""
    there = {str(level) for level in pd.unique(table[column])}
    return tuple(level for level in known if level in there)


def design(trials: pd.DataFrame) -> dict[str, tuple[str, ...]]:
    """Levels of task, scenario and transparency that the trials have."""
    return {
        "task": levels_present(trials, "task", TASKS),
        "scenario": levels_present(trials, "scenario", SCENARIO),
        "transparency": levels_present(trials, "transparency", TRANSPARENCY),
    }


def time_by_task(trials: pd.DataFrame, column: str = "time") -> Cells:
    """Mean completion time: task × transparency, seconds."""
    levels = design(trials)
    return means(trials, column, {k: levels[k] for k in ("task", "transparency")})


def log_time_by_task(trials: pd.DataFrame) -> Cells:
    """Mean of the trials' logarithms of seconds: task × transparency.

    Its exponential is a geometric mean of trials: one trial of 10⁶ s among three then moves a
    ratio by the cube root of what it moves a mean.
    """
    return time_by_task(trials.assign(log_time=np.log(trials["time"])), "log_time")


def over_tasks(cells: Cells) -> Cells:
    """Transparency alone: the plain mean over the tasks, of who has them all."""
    levels = {"transparency": cells.factors["transparency"]}
    return Cells(cells.values.mean(axis=1), cells.counts.sum(axis=1), cells.participants, levels)


def by_scenario(cells: Cells, scenario_of: Mapping[str, str]) -> Cells:
    """Scenario × transparency: the mean of the tasks nested in each scenario."""
    tasks = cells.factors["task"]
    scenarios = tuple(s for s in SCENARIO if s in {scenario_of[t] for t in tasks})
    picks = [[i for i, t in enumerate(tasks) if scenario_of[t] == s] for s in scenarios]
    values = np.stack([cells.values[:, p].mean(axis=1) for p in picks], axis=1)
    counts = np.stack([cells.counts[:, p].sum(axis=1) for p in picks], axis=1)
    levels = {"scenario": scenarios, "transparency": cells.factors["transparency"]}
    return Cells(values, counts, cells.participants, levels)


def scenario_of(trials: pd.DataFrame) -> dict[str, str]:
    """Which scenario each task is nested in."""
    pairs = trials[["task", "scenario"]].drop_duplicates()
    return {str(t): str(s) for t, s in zip(pairs["task"], pairs["scenario"], strict=True)}


def relative_error(trials: pd.DataFrame, signed: bool = True) -> Cells:
    """Relative count error: task × transparency, for the counting tasks.

    `signed`: the paper's |Σ answer − Σ truth| / Σ truth, where over- and undercounts cancel;
    else Σ |answer − truth| / Σ truth.
    """
    counting = trials[trials["task"].isin(COUNTING)].copy()
    counting["truth_number"] = pd.to_numeric(counting["truth"].astype("str"), errors="coerce")
    counting["off"] = counting["count_error"] if signed else counting["count_error"].abs()
    levels = design(counting)
    factors = {k: levels[k] for k in ("task", "transparency")}
    (off, truth), counts, names = sums(counting, ["off", "truth_number"], factors)
    with np.errstate(invalid="ignore", divide="ignore"):
        return table_of(np.abs(off) / truth, counts, names, factors)


def share_correct(trials: pd.DataFrame) -> Cells:
    """Share of right answers: task × transparency."""
    levels = design(trials)
    return means(trials, "correct", {k: levels[k] for k in ("task", "transparency")})


def share_wrong(trials: pd.DataFrame) -> Cells:
    """Share of wrong answers: task × transparency."""
    right = share_correct(trials)
    return Cells(1 - right.values, right.counts, right.participants, right.factors)


def distance(trials: pd.DataFrame) -> Cells:
    """Mean distance from mark to target of T3, world units: transparency."""
    unique = trials[trials["task"] == "unique"]
    return means(
        unique, "distance", {"transparency": levels_present(unique, "transparency", TRANSPARENCY)}
    )


def rating(questionnaire: pd.DataFrame, items: Sequence[str] = RATINGS) -> Cells:
    """Ratings 0–4: item × scenario × transparency, of the items that were asked."""
    asked = questionnaire[questionnaire["item"].isin(items)]
    factors = {
        "item": levels_present(asked, "item", items),
        "scenario": levels_present(asked, "scenario", SCENARIO),
        "transparency": levels_present(asked, "transparency", TRANSPARENCY),
    }
    return means(asked, "value", factors)


def answers(questionnaire: pd.DataFrame, item: str) -> Array:
    """All values of an item asked once per participant."""
    values = questionnaire.loc[questionnaire["item"] == item, "value"].to_numpy(dtype=np.float64)
    return values[~np.isnan(values)]
