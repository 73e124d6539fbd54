"""Where the people of drawn studies come from: a normal population, or people there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Source(Protocol):
    """Scores of people, drawn again and again."""

    @property
    def shares(self) -> tuple[float, ...]:
        """Which part of all people each group has."""

    def draw(self, rng: Generator, replications: int, n: int) -> list[Array]:
        """(replications, n_g, columns) scores of each group, of n people together."""


def sizes(shares: Sequence[float], n: int) -> list[int]:
    """n people over the groups, the largest remainders first; two in each at least."""
    exact = np.asarray(shares) / sum(shares) * n
    found = np.floor(exact).astype(int)
    for k in np.argsort(-(exact - found), kind="stable")[: n - int(found.sum())]:
        found[k] += 1
    return [max(2, k) for k in found.tolist()]


@dataclass(frozen=True, eq=False)
class Normal:
    """Independent normal scores: `means` and `sds` (groups, columns)."""

    means: Array
    sds: Array
    shares: tuple[float, ...] = (1.0,)

    def draw(self, rng: Generator, replications: int, n: int) -> list[Array]:
        """See Source."""
        return [
            mean + sd * rng.standard_normal((replications, k, len(mean)))
            for mean, sd, k in zip(self.means, self.sds, sizes(self.shares, n), strict=True)
        ]


@dataclass(frozen=True, eq=False)
class Sampled:
    """People drawn with replacement, whole, within their group: `scores` (people, columns)."""

    scores: tuple[Array, ...]
    shares: tuple[float, ...]

    def draw(self, rng: Generator, replications: int, n: int) -> list[Array]:
        """See Source."""
        return [
            own[rng.integers(len(own), size=(replications, k))]
            for own, k in zip(self.scores, sizes(self.shares, n), strict=True)
        ]

    @property
    def people(self) -> int:
        """How many there are."""
        return sum(len(own) for own in self.scores)
