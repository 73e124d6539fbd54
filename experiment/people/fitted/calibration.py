"""What simulated times are compared with: the published ones, half of them for fitting.

Half of the measures is fitted (T1 and T4, the counting tasks), the other half (T2 and T3) is held
out and only reported: it tells whether the profile generalises.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.undefined import number_in
from seethrough.experiment.power.power import implied_r

LEVELS = ("standard", "dynamic")
FITTED = ("count", "count_in_building")
HELD_OUT = ("pattern", "unique")

# Elmqvist2009, table 3: mean and s.d. without and with dynamic transparency, and F(1, 15).
PUBLISHED = {
    "count": (56.26, 38.72, 40.44, 20.99, 7.54),
    "pattern": (22.30, 16.20, 15.80, 10.21, 5.28),
    "unique": (62.78, 35.63, 23.21, 12.01, 22.98),
    "count_in_building": (140.0, 61.75, 40.80, 24.16, 48.61),
}

TOLERANCE = {"mean": 0.05, "sd": 0.15, "r": 0.1}  # the benchmark's aims: what counts as 1


@dataclass(frozen=True)
class TimeMeasure:
    """A task's times over participants: mean and s.d. at each level, their correlation."""

    means: tuple[float, float]
    sds: tuple[float, float]
    r: float


def published() -> dict[str, TimeMeasure]:
    """The paper's times; r is what each F implies."""
    measures = {}
    for task, (m1, s1, m2, s2, f) in PUBLISHED.items():
        r = implied_r((m1, m2), (s1, s2), f, 16)
        measures[task] = TimeMeasure((m1, m2), (s1, s2), r)
    return measures


def measured(rows: Iterable[Mapping[str, object]]) -> dict[str, TimeMeasure]:
    """The same from rows of a trial table: one mean per participant, task and level first."""
    times: dict[tuple[str, str], dict[str, list[float]]] = {}
    for row in rows:
        cell = times.setdefault((str(row["task"]), str(row["transparency"])), {})
        cell.setdefault(str(row["participant"]), []).append(number_in(row, "time"))
    measures = {}
    for task in dict.fromkeys(task for task, _ in times):
        people = sorted(times[task, LEVELS[0]])
        values = np.array([[np.mean(times[task, lv][p]) for lv in LEVELS] for p in people])
        measures[task] = _measure(values)
    return measures


def _measure(values: NDArray[np.float64]) -> TimeMeasure:
    sds = np.std(values, axis=0, ddof=1)
    r = float(np.asarray(np.corrcoef(values.T))[0, 1]) if (sds > 0).all() else 0.0
    means = values.mean(axis=0)
    return TimeMeasure((float(means[0]), float(means[1])), (float(sds[0]), float(sds[1])), r)


def residuals(
    simulated: Mapping[str, TimeMeasure], tasks: Sequence[str] = FITTED
) -> NDArray[np.float64]:
    """Distances from the published times of `tasks`, each in tolerances."""
    terms = []
    for task in tasks:
        ours, theirs = simulated[task], published()[task]
        for a, b in zip(ours.means, theirs.means, strict=True):
            terms.append(log(a / b) / TOLERANCE["mean"])
        for a, b in zip(ours.sds, theirs.sds, strict=True):
            terms.append(log(max(a, 1e-9) / b) / TOLERANCE["sd"])
        terms.append((ours.r - theirs.r) / TOLERANCE["r"])
    return np.array(terms)


def misfit(simulated: Mapping[str, TimeMeasure], tasks: Sequence[str] = FITTED) -> float:
    """Mean squared distance from the published times of `tasks`, in tolerances."""
    return float(np.mean(np.square(residuals(simulated, tasks))))


def table(simulated: Mapping[str, TimeMeasure]) -> list[str]:
    """Published beside simulated, a line each measure, the held-out half last."""
    lines = [f"{'measure':32s}{'published':>11s}{'simulated':>11s}{'ratio':>8s}  half"]
    for half, tasks in (("fitted", FITTED), ("held out", HELD_OUT)):
        for task in tasks:
            ours, theirs = simulated[task], published()[task]
            for k, level in enumerate(LEVELS):
                lines.append(_line(f"{task} {level} mean", theirs.means[k], ours.means[k], half))
                lines.append(_line(f"{task} {level} s.d.", theirs.sds[k], ours.sds[k], half))
            lines.append(
                f"{task + ' r':32s}{theirs.r:11.3f}{ours.r:11.3f}{ours.r - theirs.r:+8.3f}  {half}"
            )
    return lines


def _line(name: str, theirs: float, ours: float, half: str) -> str:
    return f"{name:32s}{theirs:11.2f}{ours:11.2f}{ours / theirs:8.2f}  {half}"
