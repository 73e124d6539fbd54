"""What simulated people are compared with: every measure of the published study, with its doubt.

Rows of the counting tasks (T1, T4) are fitted. Those of T2 and T3 are never fitted, but earlier
versions of the model looked at them: they are called *seen*. Sixteen people leave a printed mean a
standard error of s.d. / √16, an s.d. one of s.d. / √30 (normal values), a correlation 1 / √13 in
Fisher's z. What one condition gains over the other is the difference of their means: it is fitted
as well, but it follows from two rows, and is not counted among them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import atanh, sqrt
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from seethrough.analysis.published.numbers import load_published
from seethrough.experiment.power.power import implied_r

LEVELS = ("standard", "dynamic")
TASKS = {"count": "T1", "pattern": "T2", "unique": "T3", "count_in_building": "T4"}
FITTED = ("count", "count_in_building")
SEEN = ("pattern", "unique")
PEOPLE = 16  # that the published study had
ENOUGH = 2.0  # standard errors within which a fitted row counts as met

Key = tuple[str, str]  # a task and what is measured in it: time, error, correct, distance


class TrialRow(TypedDict, total=False):
    """A trial: who, what, how long, how far off; what a task does not measure is None or absent."""

    participant: str | int
    task: str
    transparency: str
    time: float
    truth: str
    count_error: int | None
    distance: float | None
    correct: bool | float | None


Part = tuple[float, float]  # what is added up, and of how much
Person = str | int


@dataclass(frozen=True)
class Moments:
    """A measure over participants: mean and s.d. at each level; their correlation, if known."""

    means: tuple[float, float]
    sds: tuple[float, float]
    r: float | None = None
    people: int = PEOPLE

    def values(self) -> dict[str, float]:
        """Each row's number on the scale on which it is compared."""
        named = {f"mean, {lv}": m for lv, m in zip(LEVELS, self.means, strict=True)}
        named |= {f"s.d., {lv}": s for lv, s in zip(LEVELS, self.sds, strict=True)}
        return named if self.r is None else named | {"r": self.r}

    def errors(self) -> dict[str, float]:
        """Each row's standard error; that of r in Fisher's z."""
        n = self.people
        named = {f"mean, {lv}": s / sqrt(n) for lv, s in zip(LEVELS, self.sds, strict=True)}
        named |= {
            f"s.d., {lv}": s / sqrt(2 * (n - 1)) for lv, s in zip(LEVELS, self.sds, strict=True)
        }
        if self.r is None:
            return named
        return named | {"r": 1 / sqrt(n - 3) if n > 3 else np.inf}  # three say nothing of it

    def difference(self) -> tuple[float, float]:
        """Dynamic less standard, and its standard error: each person was in both, so that it falls
        with the correlation. Published, it is the difference / √F, as r is what F implies."""
        (a, b), r = self.sds, self.r or 0.0
        variance = max(a * a + b * b - 2 * r * a * b, 0.0)
        return self.means[1] - self.means[0], sqrt(variance / self.people)


@cache
def published() -> Mapping[Key, Moments]:
    """The paper's numbers; r is what each F implies."""
    numbers = load_published()
    printed = {m.name: m for m in numbers.measures}
    found: dict[Key, Moments] = {}
    for task, code in TASKS.items():
        for what in ("time", "error", "distance"):
            measure = printed.get(f"{what}_{code}")
            if measure is None:
                continue
            both = (measure.standard, measure.dynamic)
            means = (both[0].mean.value, both[1].mean.value)
            sds = (both[0].sd.value, both[1].sd.value)
            r = implied_r(means, sds, measure.f.value, PEOPLE)
            found[task, what] = Moments(means, sds, r)
    right = numbers.correct
    found["pattern", "correct"] = Moments(
        (right[0].mean.value, right[1].mean.value), (right[0].sd.value, right[1].sd.value)
    )
    return found


def measured(rows: Iterable[TrialRow]) -> dict[Key, Moments]:
    """The same from trials: one value per participant, task and level first."""
    cells: dict[Key, dict[str, dict[Person, list[Part]]]] = {}
    for row in rows:
        for what, value in _values(row):
            levels = cells.setdefault((row["task"], what), {lv: {} for lv in LEVELS})
            levels[row["transparency"]].setdefault(row["participant"], []).append(value)
    return {key: _moments(levels, key[1] == "error") for key, levels in cells.items()}


def _values(row: TrialRow) -> Iterable[tuple[str, Part]]:
    """What a trial is measured by: (what, (part, whole)); a count's errors add up with their
    signs, and so do its truths."""
    yield "time", (float(row["time"]), 1.0)
    error, distance, correct = (row.get("count_error"), row.get("distance"), row.get("correct"))
    if error is not None:
        yield "error", (float(error), float(row["truth"]))
    elif distance is not None:
        yield "distance", (float(distance), 1.0)
    elif correct is not None:
        yield "correct", (float(correct), 1.0)


def _moments(levels: Mapping[str, Mapping[Person, Sequence[Part]]], sizes: bool) -> Moments:
    people = sorted(set(levels[LEVELS[0]]) & set(levels[LEVELS[1]]), key=str)
    sums = np.array([[np.sum(levels[lv][p], axis=0) for lv in LEVELS] for p in people])
    values = (np.abs(sums[..., 0]) if sizes else sums[..., 0]) / sums[..., 1]
    sds = np.std(values, axis=0, ddof=1)
    r = float(np.asarray(np.corrcoef(values.T))[0, 1]) if (sds > 0).all() else 0.0
    means = values.mean(axis=0)
    pair = (float(means[0]), float(means[1])), (float(sds[0]), float(sds[1]))
    return Moments(*pair, r, len(people))


@dataclass(frozen=True)
class Line:
    """A published number beside a simulated one; `off` in published standard errors."""

    task: str
    name: str
    published: float
    simulated: float
    off: float
    verdict: str

    @property
    def fitted(self) -> bool:
        """Whether the row was fitted."""
        return self.task in FITTED


def lines(simulated: Mapping[Key, Moments]) -> list[Line]:
    """Every published row that was simulated, the fitted ones first."""
    found: list[Line] = []
    for task in (*FITTED, *SEEN):
        for (own, what), theirs in published().items():
            if own == task and (task, what) in simulated:
                found += _lines(task, what, theirs, simulated[task, what])
    return found


def differences(simulated: Mapping[Key, Moments]) -> list[Line]:
    """What dynamic transparency changes, of every published measure whose s.e. F tells, the fitted
    ones first."""
    found: list[Line] = []
    for task in (*FITTED, *SEEN):
        for (own, what), theirs in published().items():
            if own == task and (task, what) in simulated and theirs.r is not None:
                (value, error), (here, mine) = (
                    m.difference() for m in (theirs, simulated[task, what])
                )
                off = (here - value) / error
                verdict = _counted(task, off) or _verdict(here - value, error, mine)
                name = f"{TASKS[task]} {what}, dynamic − standard"
                found.append(Line(task, name, value, here, off, verdict))
    return found


def _lines(task: str, what: str, theirs: Moments, ours: Moments) -> Iterable[Line]:
    values, errors, mine = theirs.values(), theirs.errors(), ours.errors()
    for name, value in values.items():
        here = ours.values()[name]
        apart = here - value if name != "r" else atanh(_inside(here)) - atanh(_inside(value))
        off = apart / errors[name]
        verdict = _counted(task, off) or _verdict(apart, errors[name], mine[name])
        yield Line(task, f"{TASKS[task]} {what}, {name}", value, here, off, verdict)


def _counted(task: str, off: float) -> str:
    """Whether a fitted row is met; nothing of others."""
    return ("met" if abs(off) <= ENOUGH else "not met") if task in FITTED else ""


def _inside(r: float) -> float:
    return min(max(r, -0.999), 0.999)


def _verdict(apart: float, theirs: float, ours: float) -> str:
    """agrees: the simulated 95 % interval lies within the published one; contradicts: they do not
    meet; cannot tell: anything else."""
    published_half = float(stats.t.ppf(0.975, PEOPLE - 1)) * theirs
    half = 1.96 * ours
    if abs(apart) + half <= published_half:
        return "agrees"
    return "contradicts" if abs(apart) - half > published_half else "cannot tell"


def residuals(simulated: Mapping[Key, Moments]) -> NDArray[np.float64]:
    """How far the fitted rows are off, in published standard errors."""
    return np.array([line.off for line in lines(simulated) if line.fitted])


def gains(simulated: Mapping[Key, Moments]) -> NDArray[np.float64]:
    """The same of the fitted differences."""
    return np.array([line.off for line in differences(simulated) if line.fitted])


def misfit(simulated: Mapping[Key, Moments]) -> float:
    """Mean square of how far the fitted rows are off."""
    return float(np.mean(np.square(residuals(simulated))))


def table(simulated: Mapping[Key, Moments], prior: Mapping[Key, Moments]) -> list[str]:
    """Published beside simulated, beside what the profile gives that the fit began with."""
    return _table(lines(simulated), lines(prior))


def gained(simulated: Mapping[Key, Moments], prior: Mapping[Key, Moments]) -> list[str]:
    """The same of the differences."""
    return _table(differences(simulated), differences(prior))


def _table(after: Sequence[Line], prior: Sequence[Line]) -> list[str]:
    before = {line.name: line for line in prior}
    found = [
        f"{'measure':32s}{'published':>10s}{'simulated':>10s}{'s.e. off':>9s}{'before':>10s}  "
    ]
    for line in after:
        digits = 3 if abs(line.published) < 2 else 2
        found.append(
            f"{line.name:32s}{line.published:10.{digits}f}{line.simulated:10.{digits}f}"
            f"{line.off:+9.1f}{before[line.name].simulated:10.{digits}f}"
            f"  {'fitted' if line.fitted else 'seen'}: {line.verdict}"
        )
    return found
