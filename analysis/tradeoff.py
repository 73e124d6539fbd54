"""What accuracy costs in time: changes side by side, and the usual combined scores."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells, level_codes, sums
from seethrough.analysis.comparison import SIDES
from seethrough.analysis.design import Contrast, Design, Factor, Measured, Task
from seethrough.analysis.measures import TASK, cells_of, levels_present, wrong
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import t_two_sided
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import Interval, Number, Undefined, no_interval


@dataclass(frozen=True, slots=True)
class Change:
    """A task's time and error under baseline and level, participant by participant: (n, 2) each.

    `log_time`: the means of the trials' logarithms; `label`: the task in words; `less_is_worse`:
    of a measure that is no error, of which more is better.
    """

    task: str
    error_label: str
    participants: tuple[str, ...]
    time: Array
    log_time: Array
    error: Array
    label: str = ""
    contrast: Contrast | None = None
    several: bool = False
    less_is_worse: bool = False

    @property
    def worse(self) -> Array:
        """(n, 2) what grows as people do worse."""
        return -self.error if self.less_is_worse else self.error

    @property
    def key(self) -> str:
        return f"{self.task}/{self.contrast.key}" if self.several and self.contrast else self.task

    @property
    def said(self) -> str:
        """The task, and the levels where there are several contrasts."""
        name = self.label or self.task
        if self.several and self.contrast:
            return f"{name} ({self.contrast.baseline} → {self.contrast.level})"
        return name

    @property
    def names(self) -> tuple[str, str]:
        return (self.contrast.baseline, self.contrast.level) if self.contrast else SIDES


def price_of(task: Task) -> Measured | None:
    """The measure of a task that its time is set against: what the task declares, else its last
    measure that is not time and lies in the open (right or wrong, where there is no other)."""
    others = [m for m in task.measures if not m.log]
    declared = [m for m in others if m.price]
    finer = [m for m in others if not m.ranked]
    right = [m for m in others if m.scale == "binary"]
    return next(iter([*declared, *finer, *right, *others]), None)


def speed_of(design: Design) -> Measured | None:
    """The measure that is time: the first that is analysed as logarithms."""
    return next((m for m in design.measures() if m.log), None)


def changes(trials: pd.DataFrame, design: Design) -> list[Change]:
    """One per task and contrast of the main factor, of the participants who have both measures."""
    speed, factor = speed_of(design), design.main
    if speed is None or factor is None:
        return []
    times = cells_of(trials, design, speed)
    logs = cells_of(trials, design, speed, log=True)
    contrasts = factor.contrasts()
    found = []
    for contrast in contrasts:
        for task in times.factors[TASK]:
            own = design.task(task)
            price = price_of(own) if own else None
            if own is None or price is None:
                continue
            change = _change(trials, design, own, price, contrast, (times, logs))
            if change is not None:
                found.append(replace(change, several=len(contrasts) > 1))
    return found


def _change(
    trials: pd.DataFrame,
    design: Design,
    task: Task,
    price: Measured,
    contrast: Contrast,
    timed: tuple[Cells, Cells],
) -> Change | None:
    only = trials[trials[TASK] == task.name]
    errors = cells_of(only, design, price)
    label = price.said
    less_is_worse = price.direction == "more" and price.scale != "binary"
    if price.direction == "more" and price.scale == "binary":
        errors, label = wrong(errors), "share wrong"
    if price.unit:
        label = f"{label} ({price.unit})"
    levels = (contrast.baseline, contrast.level)
    every = (*timed, errors)
    if any(not set(levels) <= set(c.factors[contrast.factor]) for c in every):
        return None
    parts = [np.stack(c.pick(task=task.name).both(contrast.factor, *levels), axis=1) for c in every]
    has = np.all(np.isfinite(np.concatenate(parts, axis=1)), axis=1)
    if not has.any():
        return None
    time, log, off = (part[has] for part in parts)
    names = tuple(p for p, h in zip(timed[0].participants, has, strict=True) if h)
    label = f"{label}, less is worse" if less_is_worse else label
    return Change(task.name, label, names, time, log, off, task.said, contrast,
                  less_is_worse=less_is_worse)  # fmt: skip


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
    """Combined scores per participant and level, (n, k); NaN-free, or Undefined as a whole."""

    participants: tuple[str, ...]
    bis: Array | Undefined
    ies: Array | Undefined
    rcs: Array
    levels: tuple[str, ...] = ()


def scores(trials: pd.DataFrame, factor: Factor) -> Scores | None:
    """BIS, IES and RCS over all tasks, by level; None unless someone has every level.

    BIS: z(share correct) − z(time), z over all participant × level cells (Liesefeld & Janczyk
    2019). IES: mean time of right answers / share correct. RCS: right answers / total time.
    """
    levels = levels_present(trials, factor.name, factor.levels)
    if levels != factor.levels or len(levels) < 2:
        return None
    table = trials.assign(one=1.0, right_time=trials["time"] * trials["correct"])
    factors = {factor.name: levels}
    columns = ["one", "time", "correct", "right_time"]
    (count, time, right, right_time), _, names = sums(table, columns, factors)
    whole = np.all(count > 0, axis=1)
    if not whole.any():
        return None
    count, time, right, right_time = (x[whole] for x in (count, time, right, right_time))
    people = tuple(n for n, w in zip(names, whole, strict=True) if w)
    share, mean_time = right / count, time / count
    ies: Array | Undefined = Undefined("someone has no right answer in a condition")
    if np.all(right > 0):
        ies = right_time / right / share
    return Scores(people, _bis(share, mean_time), ies, right / time, levels)


def _bis(share: Array, time: Array) -> Array | Undefined:
    for values, what in ((share, "accuracy"), (time, "time")):
        if is_constant(values.ravel()):
            return Undefined(f"{what} does not vary")
    score: Array = (share - share.mean()) / share.std() - (time - time.mean()) / time.std()
    return score


def accuracy_by_speed(trials: pd.DataFrame, factor: Factor, parts: int = 3) -> pd.DataFrame:
    """Conditional accuracy: share correct by speed within participant × task × level.

    Trials of a cell are ranked by time and split into `parts`, equal times into the same one;
    columns level, part, share, trials.
    """
    known = trials.dropna(subset=["correct"])
    keys = ["participant", "task", factor.name]
    grouped = known.groupby(keys, observed=True)["time"]
    rank = grouped.rank(method="average") - 1
    size = grouped.transform("size")
    part = np.minimum((rank * parts / size).astype(int), parts - 1)
    by = known.assign(part=part)[size >= parts].groupby([factor.name, "part"], observed=True)
    table = by["correct"].agg(share="mean", trials="size").reset_index()
    table = table.rename(columns={factor.name: "level"})
    order = level_codes(table["level"], factor.levels)
    return table.iloc[np.lexsort((table["part"], order))].reset_index(drop=True)
