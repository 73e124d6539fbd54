"""Ordinal and yes/no answers: Friedman's test for k ≥ 2, signed ranks, sign test.

Each has its exact (enumerated) or permutation p beside the asymptotic one; scipy's Friedman
refuses k = 2, and its χ² is off by half at 16 participants. Values that are equal up to rounding
are tied (`ties`).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import special

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import (
    chi2_tail,
    normal_two_sided,
    studentized_range_tail,
)
from seethrough.analysis.stats.multiplicity import holm_of_defined
from seethrough.analysis.stats.ties import STEPS, levels, signs, slack
from seethrough.analysis.stats.undefined import (
    EPS,
    ONE_PARTICIPANT,
    Interval,
    Number,
    Undefined,
    no_interval,
)

ALL_TIED = "every participant gives all conditions the same value"
DRAWS = 20_000
MOST_COUNTED = 2000
"""Answers up to which a sign test counts in whole numbers."""
_EXACT_BUDGET = 2e8


@dataclass(frozen=True, slots=True)
class Friedman:
    """`exact` is the permutation p; `method` says whether it was enumerated or drawn.

    Kendall's `w` has no interval: a bootstrap's covers no true W of 0, and .79 to .86 elsewhere.
    """

    n: int
    k: int
    chi2: Number
    df: int
    p: Number
    exact: Number
    method: str
    w: Number


def ranks(y: Array, largest: float = 0.0) -> Array:
    """Average ranks 1..k within each row of y, (n, k); `largest` as in `ties.slack`."""
    level = levels(y, slack(y, largest=largest)[:, None])
    below = (level[:, None, :] < level[:, :, None]).sum(axis=-1)
    same = (level[:, None, :] == level[:, :, None]).sum(axis=-1)
    found: Array = below + (same + 1) / 2
    return found


def friedman(y: Array, rng: Generator, largest: float = 0.0) -> Friedman:
    """Friedman's rank test with ties for y, (n, k ≥ 2), finite.

    χ² as in Hollander & Wolfe (tie-corrected); for k = 2 it is the sign test's χ² and the exact p
    is the sign test's. `rng` draws permutations where enumeration is too long; `largest` as in
    `ties.slack`.
    """
    n, k = y.shape
    r = ranks(y, largest)
    reason = ONE_PARTICIPANT if n < 2 else ALL_TIED if np.all(r == r[:, :1]) else ""
    if reason:
        gone = Undefined(reason)
        return Friedman(n, k, gone, k - 1, gone, gone, "", gone)
    spread = float(np.sum(r**2) - n * k * (k + 1) ** 2 / 4)
    statistic = float(np.sum((r.sum(axis=0) - n * (k + 1) / 2) ** 2))
    chi2 = (k - 1) * statistic / spread
    exact, method = _permutation_p(r, statistic, rng)
    w = chi2 / (n * (k - 1))
    return Friedman(n, k, chi2, k - 1, chi2_tail(chi2, k - 1), exact, method, w)


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
    return _share(states, value >= statistic - 1e-9)


def _share(chances: Array, far: NDArray[np.bool_]) -> float:
    """The part of all `chances` that is `far`; exactly 1 where all of it is."""
    return float(1 / (1 + chances[~far].sum() / chances[far].sum()))


def sign_test(wins: int, losses: int) -> float:
    """Two-sided exact binomial p of `wins` against `losses`, ties left out."""
    return _binomial(min(wins, losses), wins + losses)


@lru_cache(maxsize=4096)
def _binomial(fewer: int, total: int) -> float:
    """2 · P(X ≤ fewer) for a fair coin, at most 1: by counting, so that .0625 is .0625."""
    if 2 * fewer >= total - 1:
        return 1.0
    if total > MOST_COUNTED:
        return float(min(1.0, 2 * special.bdtr(fewer, total, 0.5)))
    ways = term = 1
    for i in range(fewer):
        term = term * (total - i) // (i + 1)
        ways += term
    return ways / (1 << total - 1)


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


def signed_rank(scores: Array, room: Array | None = None) -> SignedRank:
    """Wilcoxon's signed-rank test of one score per participant; exact, with ties, up to 200.

    `room` (n,): the rounding of each score (`ties.slack` of what it is the difference of); by
    default that of the largest score.
    """
    if room is None:
        room = np.full(len(scores), STEPS * EPS * np.max(np.abs(scores), initial=0.0))
    sign = signs(scores, room)
    left = sign != 0
    if not np.any(left):
        gone = Undefined("all differences are zero")
        return SignedRank(0, gone, gone, "")
    group = levels(np.abs(scores[left]), room[left])
    count = np.bincount(group)
    rank = (np.cumsum(count) - (count - 1) / 2)[group]
    v, m = float(rank[sign[left] == 1].sum()), len(rank)
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
    # sums and mean are multiples of 1/4, exact as they stand
    return SignedRank(m, v, _share(chances, np.abs(sums - mean) >= abs(v - mean)), "exact")


@dataclass(frozen=True, slots=True)
class Pair:
    """A post-hoc comparison of two levels after Friedman's test."""

    first: int
    second: int
    rank_difference: float
    nemenyi_p: float
    signed: SignedRank
    holm_p: Number


def post_hoc(y: Array, largest: float = 0.0) -> list[Pair]:
    """All pairs of the k ≥ 3 columns: Nemenyi's p and Holm-corrected signed ranks; `largest` as in
    `ties.slack`."""
    n, k = y.shape
    means = ranks(y, largest).mean(axis=0)
    error = np.sqrt(k * (k + 1) / (12 * n))
    pairs = list(itertools.combinations(range(k), 2))
    tests = [
        signed_rank(y[:, a] - y[:, b], slack(y[:, a], y[:, b], largest=largest)) for a, b in pairs
    ]
    adjusted = holm_of_defined([t.p for t in tests])
    return [
        Pair(
            a,
            b,
            float(means[a] - means[b]),
            # df → ∞: Nemenyi 1963 compares mean ranks with the studentised range
            studentized_range_tail(abs(means[a] - means[b]) / error, k),
            test,
            p,
        )
        for (a, b), test, p in zip(pairs, tests, adjusted, strict=True)
    ]
