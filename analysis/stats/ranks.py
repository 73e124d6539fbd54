"""Ordinal and yes/no answers: Friedman's test for k ≥ 2, signed ranks, sign test.

Each has its exact (enumerated) or permutation p beside the asymptotic one; scipy's Friedman
refuses k = 2, and its χ² is off by half at 16 participants.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import special

from analysis.stats.distributions import (
    chi2_tail,
    holm,
    normal_two_sided,
    studentized_range_tail,
)
from analysis.stats.undefined import ONE_PARTICIPANT, Interval, Number, Undefined, no_interval

Array = NDArray[np.float64]

ALL_TIED = "every participant gives all conditions the same value"
DRAWS = 20_000
_EXACT_BUDGET = 2e8


@dataclass(frozen=True, slots=True)
class Friedman:
    """`exact` is the permutation p; `method` says whether it was enumerated or drawn."""

    n: int
    k: int
    rank_means: tuple[float, ...]
    chi2: Number
    df: int
    p: Number
    exact: Number
    method: str
    w: Number
    w_interval: Interval


def ranks(y: Array) -> Array:
    """Average ranks 1..k within each row of y, (n, k)."""
    below = (y[:, None, :] < y[:, :, None]).sum(axis=-1)
    same = (y[:, None, :] == y[:, :, None]).sum(axis=-1)
    return below + (same + 1) / 2


def friedman(y: Array, rng: Generator) -> Friedman:
    """Friedman's rank test with ties for y, (n, k ≥ 2), finite; Kendall's W by bootstrap.

    χ² as in Hollander & Wolfe (tie-corrected); for k = 2 it is the sign test's χ² and the exact p
    is the sign test's. `rng` draws permutations where enumeration is too long, and the bootstrap.
    """
    n, k = y.shape
    r = ranks(y)
    means = tuple(float(m) for m in r.mean(axis=0))
    reason = ONE_PARTICIPANT if n < 2 else ALL_TIED if np.all(y == y[:, :1]) else ""
    if reason:
        gone = Undefined(reason)
        return Friedman(n, k, means, gone, k - 1, gone, gone, "", gone, no_interval(reason))
    spread = float(np.sum(r**2) - n * k * (k + 1) ** 2 / 4)
    statistic = float(np.sum((r.sum(axis=0) - n * (k + 1) / 2) ** 2))
    chi2 = (k - 1) * statistic / spread
    exact, method = _permutation_p(r, statistic, rng)
    w = chi2 / (n * (k - 1))
    return Friedman(
        n, k, means, chi2, k - 1, chi2_tail(chi2, k - 1), exact, method, w, _w_interval(r, rng)
    )


def _permutation_p(r: Array, statistic: float, rng: Generator) -> tuple[float, str]:
    """P(Σ(R_j − mean)² ≥ statistic) when each participant's ranks are shuffled."""
    n, k = r.shape
    if k == 2:
        wins, losses = int(np.sum(r[:, 0] > r[:, 1])), int(np.sum(r[:, 0] < r[:, 1]))
        return sign_test(wins, losses), "exact"
    states = (2 * n * k + 1.0) ** (k - 1)
    if states * n * np.prod(np.arange(1.0, k + 1)) <= _EXACT_BUDGET:
        return _enumerate(r, statistic), "exact"
    hits, draws = 0, max(1000, min(DRAWS, int(4e7 / (n * k))))
    step = max(1, int(2e6 / (n * k)))
    for start in range(0, draws, step):
        order = rng.random((min(step, draws - start), n, k)).argsort(axis=2)
        sums = np.take_along_axis(r[None], order, axis=2).sum(axis=1)
        # the half ranks' sums are exact: 1e-9 only absorbs n·(k + 1)/2
        far = np.sum((sums - n * (k + 1) / 2) ** 2, axis=1) >= statistic - 1e-9
        hits += int(far.sum())
    return (hits + 1) / (draws + 1), f"{draws} permutations"


def _enumerate(r: Array, statistic: float) -> float:
    """The exact distribution of the rank sums, participant by participant.

    State: the sums of the first k − 1 columns, in half ranks; the last column follows.
    """
    n, k = r.shape
    half = np.rint(2 * r).astype(int)
    size = 2 * n * k + 1
    states = np.zeros((size,) * (k - 1))
    states[(0,) * (k - 1)] = 1.0
    for row in half:
        new = np.zeros_like(states)
        orders = list(itertools.permutations(row.tolist()))
        for order in orders:
            to = tuple(slice(shift, None) for shift in order[:-1])
            come = tuple(slice(None, size - shift) for shift in order[:-1])
            new[to] += states[come]
        states = new / len(orders)
    sums = np.indices(states.shape) / 2
    last = n * k * (k + 1) / 2 - sums.sum(axis=0)
    centre = n * (k + 1) / 2
    value = np.sum((sums - centre) ** 2, axis=0) + (last - centre) ** 2
    # sums are multiples of 1/2, so their squares are exact: 1e-9 only absorbs n·(k+1)/2
    return float(min(1.0, states[value >= statistic - 1e-9].sum()))


def _w_interval(r: Array, rng: Generator, level: float = 0.95, draws: int = 2000) -> Interval:
    """Bootstrap interval (percentile) of Kendall's W over participants.

    Participants with the same ranks are alike, so what is drawn is how often each pattern comes.
    """
    n, k = r.shape
    patterns, counts = np.unique(r, axis=0, return_counts=True)
    own = np.sum(patterns**2, axis=1) - k * (k + 1) ** 2 / 4
    values = []
    for start in range(0, draws, 100):
        weights = rng.multinomial(n, counts / n, size=min(100, draws - start))
        sums = weights @ patterns - n * (k + 1) / 2
        spread = weights @ own
        good = spread > 0
        values.append(np.sum(sums[good] ** 2, axis=1) / (n * spread[good]))
    low, high = np.quantile(np.concatenate(values), [(1 - level) / 2, (1 + level) / 2])
    return float(low), float(high)


def sign_test(wins: int, losses: int) -> float:
    """Two-sided exact binomial p of `wins` against `losses`, ties left out."""
    total = wins + losses
    return float(min(1.0, 2 * special.bdtr(min(wins, losses), total, 0.5))) if total else 1.0


def share_interval(hits: int, n: int, level: float = 0.95) -> Interval:
    """Clopper–Pearson interval of a share."""
    if n == 0:
        return no_interval("no answers")
    tail = (1 - level) / 2
    low = 0.0 if hits == 0 else float(special.betaincinv(hits, n - hits + 1, tail))
    high = 1.0 if hits == n else float(special.betaincinv(hits + 1, n - hits, 1 - tail))
    return low, high


@dataclass(frozen=True, slots=True)
class SignedRank:
    """Wilcoxon's V (sum of positive ranks, zeros left out) with its p."""

    n: int
    v: Number
    p: Number
    method: str


def signed_rank(scores: Array) -> SignedRank:
    """Wilcoxon's signed-rank test of one score per participant; exact, with ties, up to 200."""
    left = scores[scores != 0]
    if len(left) == 0:
        gone = Undefined("all differences are zero")
        return SignedRank(0, gone, gone, "")
    size = np.abs(left)
    _, group, count = np.unique(size, return_inverse=True, return_counts=True)
    rank = (np.cumsum(count) - (count - 1) / 2)[group]
    v, m = float(rank[left > 0].sum()), len(left)
    mean = m * (m + 1) / 4
    if m > 200:
        variance = np.sum(rank**2) / 4
        return SignedRank(m, v, normal_two_sided((v - mean) / np.sqrt(variance)), "normal")
    half = np.rint(2 * rank).astype(int)
    chances = np.zeros(int(half.sum()) + 1)
    chances[0] = 1.0
    for step in half:
        moved = np.zeros_like(chances)
        moved[step:] = chances[: len(chances) - step]
        chances = (chances + moved) / 2
    sums = np.arange(len(chances)) / 2
    p = float(chances[np.abs(sums - mean) >= abs(v - mean) - 1e-9].sum())
    return SignedRank(m, v, min(1.0, p), "exact")


@dataclass(frozen=True, slots=True)
class Pair:
    """A post-hoc comparison of two levels after Friedman's test."""

    first: int
    second: int
    rank_difference: float
    nemenyi_p: float
    signed: SignedRank
    holm_p: Number


def post_hoc(y: Array) -> list[Pair]:
    """All pairs of the k ≥ 3 columns: Nemenyi's p and Holm-corrected signed ranks."""
    n, k = y.shape
    means = ranks(y).mean(axis=0)
    error = np.sqrt(k * (k + 1) / (12 * n))
    pairs = list(itertools.combinations(range(k), 2))
    tests = [signed_rank(y[:, a] - y[:, b]) for a, b in pairs]
    known = [t.p for t in tests if not isinstance(t.p, Undefined)]
    adjusted = iter(holm(known))
    return [
        Pair(
            a,
            b,
            float(means[a] - means[b]),
            # df → ∞: Nemenyi 1963 compares mean ranks with the studentised range
            studentized_range_tail(abs(means[a] - means[b]) / error, k),
            test,
            test.p if isinstance(test.p, Undefined) else next(adjusted),
        )
        for (a, b), test in zip(pairs, tests, strict=True)
    ]
