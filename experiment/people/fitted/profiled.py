"""Profile intervals: how far each fitted constant may move while the others make up for it.

The objective is squares of the standard errors that fitted rows and differences are off, and of how
far constants have moved from where they lie before a fit; that a fit counts rows more as they grow
(`fitting.steep`) says nothing of chance, and is left out. A constant's interval ends where the
least that all others can make of it has risen by what a 95 % interval allows, χ²₁ = 3.84 times the
spread that the fit leaves (squares over rows less constants): rows are not met to their standard
errors. The least is found with the slopes at the fit, and then played; where more happens than
slopes say, the end is moved nearer, and played again. What really happens at each end stands
beside it. An end may also be where the constant's own limits are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import brentq, lsq_linear

from seethrough.experiment.people.fitted.priors import FREE

Array = NDArray[np.float64]
Residuals = Callable[[Array], Array]

PLAYS = 3  # of an end, nearer each time, at most
NEAR = 1.5  # rise up to which an end that was played is one
CHI2 = float(stats.chi2.ppf(0.95, 1))


@dataclass(frozen=True)
class End:
    """An end of an interval: `x` of all free constants there; by how much the objective rises
    there, in units of what ends an interval, when played; whether the constant's limit ends it."""

    x: Array
    rise: float
    limit: bool


@dataclass(frozen=True)
class Profiled:
    """A constant's number in FREE, and the two ends."""

    number: int
    low: End
    high: End


def profile_intervals(
    residuals: Residuals, slopes: Array, here: Array, x: Array, rows: int
) -> list[Profiled]:
    """The interval of each constant at the fit `x` (logarithms of factors), where `residuals` are
    `here` (rows, then constants) and have these slopes (…, constants)."""
    bounds = np.log(list(FREE.values()))
    unit = CHI2 * float(here[:rows] @ here[:rows]) / max(rows - len(x), 1)
    lowest, at_best = _least(here, slopes, bounds, x)
    found = []
    for k in range(len(x)):
        ends = []
        for side in (-1.0, 1.0):
            value, limit = _end(here, slopes, bounds, x, k, side, at_best[k], lowest + unit)
            for _ in range(PLAYS):
                there = _least(here, slopes, bounds, x, k, value)[1]
                played = residuals(there)
                rise = (float(played @ played) - float(here @ here)) / unit
                end = End(there, rise, limit)
                if rise <= NEAR:
                    break
                # Squares rise with the square of the way: so much of it is left.
                value, limit = x[k] + (value - x[k]) * max(rise**-0.5, 0.2), False
            ends.append(end)
        found.append(Profiled(k, *ends))
    return found


def _least(
    here: Array, slopes: Array, bounds: Array, x: Array, k: int | None = None, value: float = 0.0
) -> tuple[float, Array]:
    """The least sum of squares that the linear model allows, and where; with constant `k` held."""
    low, high = -bounds, bounds.copy()
    there = x.copy()
    free = np.ones(len(x), dtype=bool)
    target = -here
    if k is not None:
        there[k], free[k] = value, False
        target = target - slopes[:, k] * (value - x[k])
    inside = np.clip(x[free], low[free], high[free])
    fit = lsq_linear(
        slopes[:, free], target, (low[free] - inside - 1e-9, high[free] - inside + 1e-9)
    )
    there[free] = inside + fit.x
    left = here + slopes @ (there - x)
    return float(left @ left), there


def _end(
    here: Array, slopes: Array, bounds: Array, x: Array, k: int, side: float, start: float,
    most: float,
) -> tuple[float, bool]:  # fmt: skip
    """Where constant `k` ends on one side, and whether its limit ends it."""

    def over(value: float) -> float:
        return _least(here, slopes, bounds, x, k, value)[0] - most

    limit = float(side * bounds[k])
    if abs(limit - start) < 1e-9 or over(limit) <= 0:
        return limit, True
    return float(brentq(over, start, limit, xtol=1e-4)), False


def report(start: object, best: object, found: Sequence[Profiled], seconds: float) -> list[str]:
    """A line for each constant: where it began, what was fitted, and its interval; at each end how
    much of what ends an interval the objective rose by when it was played."""
    said = [
        f"{'constant':20s}{'began':>9s}{'fitted':>9s}{'from':>9s}{'to':>9s}  rise when played at "
        f"the ends (1: an interval's end); {seconds:.0f} s of processor time"
    ]
    for own in found:
        name = list(FREE)[own.number]
        began, fitted = getattr(start, name), getattr(best, name)
        ends = [began * np.exp(end.x[own.number]) for end in (own.low, own.high)]
        rises = [f"{e.rise:+.1f}{' (its limit)' * e.limit}" for e in (own.low, own.high)]
        said.append(
            f"{name:20s}{began:9.3g}{fitted:9.3g}{ends[0]:9.3g}{ends[1]:9.3g}  "
            f"{' and '.join(rises)}"
        )
    return said
