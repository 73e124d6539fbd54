"""Groups compared by ranks: Kruskal and Wallis's test, of two groups Mann and Whitney's.

With its permutation p, for χ² is far off in small groups with ties; equal up to rounding is tied.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import chi2_tail
from seethrough.analysis.stats.ties import levels, slack
from seethrough.analysis.stats.undefined import Number, Undefined

DRAWS = 20_000
MOST_EXACT = 200
"""People up to whom two groups are enumerated."""


@dataclass(frozen=True, slots=True)
class KruskalWallis:
    """`exact` is the permutation p; `method` says whether it was enumerated or drawn."""

    n: int
    h: Number
    p: Number
    exact: Number
    method: str


def kruskal_wallis(groups: Sequence[Array], rng: Generator, largest: float = 0.0) -> KruskalWallis:
    """H with ties corrected (Hollander & Wolfe), for two or more groups of finite values.

    `rng` draws permutations where there are more than two groups; `largest` as in `ties.slack`.
    """
    sizes = [len(g) for g in groups]
    values = np.concatenate(groups)
    n = len(values)
    level = levels(values, slack(values[:, None], largest=largest))
    count = np.bincount(level)
    # from their mean, in halves, exact: what is the same for two orders comes out (almost) the same
    away = (np.cumsum(count) - (count - 1) / 2)[level] - (n + 1) / 2
    if len(count) < 2:
        gone = Undefined("all values are equal")
        return KruskalWallis(n, gone, gone, gone, "")
    ends = np.cumsum([0, *sizes])
    sums = np.add.reduceat(away, ends[:-1])
    between = float(np.sum(sums**2 / sizes))
    h = between * (n - 1) / float(np.sum(away**2))
    if len(groups) == 2 and n <= MOST_EXACT:
        exact, method = _enumerate(away, sizes[0], float(sums[0])), "exact"
    else:
        exact, method = _drawn(away, ends, between, rng)
    return KruskalWallis(n, h, chi2_tail(h, len(groups) - 1), exact, method)


def _enumerate(away: Array, first: int, observed: float) -> float:
    """P of a sum over `first` people as far from 0 as the observed one."""
    half = np.rint(2 * (away - away.min())).astype(int)
    ways = np.zeros((first + 1, int(half.sum()) + 1))
    ways[0, 0] = 1.0
    for done, step in enumerate(half, start=1):
        for size in range(min(first, done), 0, -1):
            ways[size, step:] += ways[size - 1, : ways.shape[1] - step]
        ways /= ways.max()  # shares are all that counts: 200 people have 10⁵⁹ groups
    chances = ways[first]
    sums = np.arange(len(chances)) / 2 + first * away.min()
    far = np.abs(sums) >= abs(observed)  # in halves, exact as they stand
    return float(1 / (1 + chances[~far].sum() / chances[far].sum()))


def _drawn(
    away: Array, ends: NDArray[np.intp], between: float, rng: Generator
) -> tuple[float, str]:
    n = len(away)
    draws = max(1000, min(DRAWS, int(4e7 / n)))
    sizes = np.diff(ends)
    hits, step = 0, max(1, int(2e6 / n))
    for start in range(0, draws, step):
        order = rng.random((min(step, draws - start), n)).argsort(axis=1)
        sums = np.add.reduceat(away[order], ends[:-1], axis=1)
        own = np.sum(sums**2 / sizes, axis=1)
        hits += int(np.sum(own >= between * (1 - 1e-9)))  # equal up to rounding is as far
    return (hits + 1) / (draws + 1), f"{draws} permutations"
