"""The report's own decisions, for many drawn studies at once.

A prediction is answered by tests of one score per person: a difference (baseline − level, of
logarithms where a measure is analysed so), one less a margin, or a value that was asked once.
Groups are set against each other without assuming that they spread alike (Welch), as in the report.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from seethrough.analysis.stats.multiplicity import holm
from seethrough.analysis.stats.ranks import sign_test

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Part:
    """One-sided: is sign · (Σ weight · mean of the column, by group) + shift above 0?"""

    column: int
    sign: float = 1.0
    shift: float = 0.0


@dataclass(frozen=True)
class Test:
    """One test. Two-sided with a predicted `sign` (0: either) of `column`, by t or by the order
    alone (`ranked`); or the largest p of one-sided `parts`. `weights` are the groups'.

    `log`: whether scores are differences of logarithms; `unit` of others. `single`: a value that
    was asked once, no difference.
    """

    __test__ = False  # no test of pytest's

    name: str
    column: int
    sign: float = 0.0
    parts: tuple[Part, ...] = ()
    weights: tuple[float, ...] = (1.0,)
    ranked: bool = False
    log: bool = False
    unit: str = ""
    single: bool = False

    @property
    def directed(self) -> bool:
        """Whether it may be significant in the wrong direction."""
        return not self.parts


@dataclass(frozen=True)
class Planned:
    """A prediction as the study states it: `tests`, all needed or any (then Holm's)."""

    name: str
    said: str
    tests: tuple[Test, ...]
    any: bool = False


@dataclass(frozen=True, eq=False)
class Results:
    """Of each drawn study: p (R,), the estimate in the scores' unit, its sign against the
    predicted one (1, −1; 0 undefined), and whether it can be tested at all."""

    p: Array
    estimate: Array
    fits: NDArray[np.int64]
    there: Bools


def run(test: Test, groups: Sequence[Array]) -> Results:
    """A test of (R, n, columns) scores of each group; NaN where somebody lacks one."""
    if test.ranked and test.directed:
        return _signs(test, groups)
    if test.directed:
        estimate, error, df = _estimate(groups, test.column, test.weights)
        there = error > 0
        t = np.divide(estimate, error, out=np.zeros_like(estimate), where=there)
        p = 2 * special.stdtr(df, -np.abs(t))
        fits = np.sign(estimate) * (test.sign or np.sign(estimate))
        return Results(np.where(there, p, 1.0), estimate, fits.astype(np.int64), there)
    shown = []
    for part in test.parts:
        estimate, error, df = _estimate(groups, part.column, test.weights)
        there = error > 0
        gap = part.sign * estimate + part.shift
        t = np.divide(gap, error, out=np.zeros_like(gap), where=there)
        shown.append((np.where(there, special.stdtr(df, -t), 1.0), estimate, there))
    p = np.max([s[0] for s in shown], axis=0)
    there = np.all([s[2] for s in shown], axis=0)
    return Results(p, shown[0][1], np.ones(len(p), dtype=np.int64), there)


def _estimate(
    groups: Sequence[Array], column: int, weights: Sequence[float]
) -> tuple[Array, Array, Array]:
    """ψ, its standard error and Satterthwaite's df (analysis/stats/contrasts.py), of each study."""
    value = parts = below = np.zeros(groups[0].shape[0])
    for group, weight in zip(groups, weights, strict=True):
        if not weight:
            continue
        scores = group[:, :, column]
        known = np.isfinite(scores)
        n = known.sum(axis=1)
        mean = np.where(known, scores, 0.0).sum(axis=1) / np.maximum(n, 1)
        apart = np.where(known, scores - mean[:, None], 0.0)
        # Rounding leaves 1e-32 of what is equal: as the report has it, that is no spread.
        size = np.abs(np.where(known, scores, 0.0)).max(axis=1)
        variance = (apart**2).sum(axis=1) / np.maximum(n - 1, 1)
        variance = np.where((n > 1) & (variance > (1e-12 * size) ** 2), variance, 0.0)
        part = weight**2 * variance / np.maximum(n, 1)
        value, parts = value + weight * mean, parts + part
        below = below + part**2 / np.maximum(n - 1, 1)
    df = np.divide(parts**2, below, out=np.ones_like(parts), where=below > 0)
    return value, np.sqrt(parts), df


def _signs(test: Test, groups: Sequence[Array]) -> Results:
    """Friedman's exact test of two levels: the sign test; groups are taken together.

    Scores of tied levels are 0 (power_data.py).
    """
    scores = np.concatenate([g[:, :, test.column] for g in groups], axis=1)
    wins, losses = (scores > 0).sum(axis=1), (scores < 0).sum(axis=1)
    p = _sign_table(scores.shape[1])[wins, losses]
    way = np.sign(wins - losses)
    known = np.isfinite(scores).sum(axis=1)
    estimate = np.where(np.isfinite(scores), scores, 0.0).sum(axis=1) / np.maximum(known, 1)
    fits = way * (test.sign or way)
    return Results(p, estimate, fits.astype(np.int64), wins + losses > 0)


@cache
def _sign_table(n: int) -> Array:
    table = np.ones((n + 1, n + 1))
    for wins in range(n + 1):
        for losses in range(n + 1 - wins):
            table[wins, losses] = sign_test(wins, losses)
    return table


@dataclass(frozen=True, eq=False)
class Decided:
    """Of each drawn study (R,): whether the prediction is supported, and whether something that it
    is about is significant against it."""

    supported: Bools
    against: Bools


def decide(planned: Planned, results: Sequence[Results], alpha: float) -> Decided:
    """All tests needed, or one by Holm's p. What nobody can test where others can says nothing."""
    p = np.stack([r.p for r in results])
    there = np.stack([r.there for r in results])
    fits = np.stack([r.fits for r in results])
    used = holm(p) if planned.any else p
    shown = there & (used < alpha)
    reached = shown & (fits > 0)
    against = (shown & (fits < 0)).any(axis=0)
    some, every = reached.any(axis=0), (reached | ~there).all(axis=0) & there.any(axis=0)
    return Decided(np.asarray(some if planned.any else every), np.asarray(against))
