"""What accuracy costs in time: changes side by side, and the usual combined scores."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Array, Cells, level_codes, sums
from seethrough.analysis.load.schema import TRANSPARENCY
from seethrough.analysis.measures import (
    design,
    distance,
    log_time_by_task,
    relative_error,
    share_wrong,
    time_by_task,
)
from seethrough.analysis.stats.distributions import t_two_sided
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import Interval, Number, Undefined, no_interval


@dataclass(frozen=True, slots=True)
class Change:
    """A task's time and error under both levels, participant by participant: (n, 2) each.

    `log_time`: the means of the trials' logarithms.
    """

    task: str
    error_label: str
    participants: tuple[str, ...]
    time: Array
    log_time: Array
    error: Array


ERROR_LABELS = {
    "count": "absolute relative error",
    "pattern": "share wrong",
    "unique": "distance (units)",
    "count_in_building": "absolute relative error",
}


def changes(trials: pd.DataFrame) -> list[Change]:
    """One per task that has both levels, with the participants who have both measures."""
    times, logs = time_by_task(trials), log_time_by_task(trials)
    if times.factors["transparency"] != ("standard", "dynamic"):
        return []
    found = []
    for task in times.factors["task"]:
        error = _errors(trials[trials["task"] == task], task)
        if error.factors["transparency"] != ("standard", "dynamic"):
            continue
        parts = [times.pick(task=task).values, logs.pick(task=task).values, error.values]
        has = np.isfinite(np.concatenate(parts, axis=1)).all(axis=1)
        if has.any():
            time, log, off = (part[has] for part in parts)
            names = tuple(p for p, h in zip(times.participants, has, strict=True) if h)
            found.append(Change(task, ERROR_LABELS[task], names, time, log, off))
    return found


def _errors(trials: pd.DataFrame, task: str) -> Cells:
    """The task's own error measure: (n, transparency)."""
    if task == "unique":
        return distance(trials)
    if task == "pattern":
        return share_wrong(trials).pick(task=task)
    return relative_error(trials, signed=False).pick(task=task)


@dataclass(frozen=True, slots=True)
class Correlation:
    """Pearson's r with Fisher's 95 % interval."""

    n: int
    r: Number
    interval: Interval
    p: Number


def correlation(x: Array, y: Array) -> Correlation:
    """Between two lists of values of the same participants."""
    n = len(x)
    why = "fewer than four participants" if n < 4 else ""
    if not why and (is_constant(x) or is_constant(y)):
        why = "one of the two does not change"
    if why:
        gone = Undefined(why)
        return Correlation(n, gone, no_interval(why), gone)
    r = float(np.clip(np.corrcoef(x, y)[0, 1], -1, 1))
    if abs(r) > 1 - 1e-12:
        why = "the correlation is perfect"
        return Correlation(n, r, no_interval(why), Undefined(why))
    half = 1.959963984540054 / np.sqrt(n - 3)
    ends = (float(np.tanh(np.arctanh(r) - half)), float(np.tanh(np.arctanh(r) + half)))
    return Correlation(n, r, ends, t_two_sided(r * np.sqrt((n - 2) / (1 - r * r)), n - 2))


@dataclass(frozen=True, slots=True)
class Scores:
    """Combined scores per participant and level, (n, 2); NaN-free, or Undefined as a whole."""

    participants: tuple[str, ...]
    bis: Array | Undefined
    ies: Array | Undefined
    rcs: Array


def scores(trials: pd.DataFrame) -> Scores | None:
    """BIS, IES and RCS over all tasks; None unless someone has both levels.

    BIS: z(share correct) − z(time), z over all participant × level cells (Liesefeld & Janczyk
    2019). IES: mean time of right answers / share correct. RCS: right answers / total time.
    """
    levels = design(trials)
    if levels["transparency"] != ("standard", "dynamic"):
        return None
    table = trials.assign(one=1.0, right_time=trials["time"] * trials["correct"])
    factors = {"transparency": levels["transparency"]}
    columns = ["one", "time", "correct", "right_time"]
    (count, time, right, right_time), _, names = sums(table, columns, factors)
    whole = (count > 0).all(axis=1)
    if not whole.any():
        return None
    count, time, right, right_time = (x[whole] for x in (count, time, right, right_time))
    people = tuple(n for n, w in zip(names, whole, strict=True) if w)
    share, mean_time = right / count, time / count
    ies: Array | Undefined = Undefined("someone has no right answer in a condition")
    if np.all(right > 0):
        ies = right_time / right / share
    return Scores(people, _bis(share, mean_time), ies, right / time)


def _bis(share: Array, time: Array) -> Array | Undefined:
    for values, what in ((share, "accuracy"), (time, "time")):
        if is_constant(values.ravel()):
            return Undefined(f"{what} does not vary")
    return (share - share.mean()) / share.std() - (time - time.mean()) / time.std()


def accuracy_by_speed(trials: pd.DataFrame, parts: int = 3) -> pd.DataFrame:
    """Conditional accuracy: share correct by speed within participant × task × transparency.

    Trials of a cell are ranked by time and split into `parts`, equal times into the same one;
    columns transparency, part, share, trials.
    """
    known = trials.dropna(subset=["correct"])
    keys = ["participant", "task", "transparency"]
    grouped = known.groupby(keys, observed=True)["time"]
    rank = grouped.rank(method="average") - 1
    size = grouped.transform("size")
    part = np.minimum((rank * parts / size).astype(int), parts - 1)
    by = known.assign(part=part)[size >= parts].groupby(["transparency", "part"], observed=True)
    table = by["correct"].agg(share="mean", trials="size").reset_index()
    order = level_codes(table["transparency"], TRANSPARENCY)
    return table.iloc[np.lexsort((table["part"], order))].reset_index(drop=True)
