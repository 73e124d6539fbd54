"""Power: how often the study's tests would find an effect with n participants.

Each replication draws n participants, reduces them to one value per transparency level as the
analysis does, and tests the contrast with `analysis`'s own scores. Where the effect is a normal
one the noncentral F gives the same number in closed form.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.random import Generator, SeedSequence
from numpy.typing import NDArray
from scipy import special

from seethrough.analysis.stats.anova import contrast_scores
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import t_quantile
from seethrough.analysis.stats.ranks import share_interval
from seethrough.analysis.stats.undefined import is_defined

ANALYSIS = 3  # first word of the streams (CONVENTIONS.md)
ENOUGH = 0.8


class Effect(Protocol):
    """Where participants come from: n of them, (replications, n, 2) values standard, dynamic."""

    @property
    def name(self) -> str:
        """What is tested."""

    def draw(self, rng: Generator, replications: int, n: int) -> Array:
        """Values of n participants, again and again."""

    def found(self, values: Array, alpha: float) -> NDArray[np.bool_]:
        """(replications,) whether the study's test is significant; `values` (…, n, 2)."""

    def exact(self, n: int, alpha: float) -> float | None:
        """Power with n participants in closed form, where there is one."""


@dataclass(frozen=True)
class NormalEffect:
    """Two normal values per participant with these means, s.d. and correlation."""

    name: str
    means: tuple[float, float]
    sds: tuple[float, float]
    r: float

    def __post_init__(self) -> None:
        if not -1 <= self.r <= 1:
            raise ValueError(f"{self.name}: r = {self.r:.3f}, expected a correlation")
        if min(self.sds) <= 0:
            raise ValueError(f"{self.name}: sd = {self.sds}, expected numbers > 0")

    def draw(self, rng: Generator, replications: int, n: int) -> Array:
        """Bivariate normal values."""
        z = rng.standard_normal((replications, n, 2))
        second = self.r * z[..., 0] + (1 - self.r**2) ** 0.5 * z[..., 1]
        return np.stack([z[..., 0], second], axis=-1) * self.sds + self.means

    def dz(self) -> float:
        """Mean over s.d. of the difference."""
        a, b = self.sds
        spread: float = (a * a + b * b - 2 * self.r * a * b) ** 0.5
        return (self.means[0] - self.means[1]) / spread

    def found(self, values: Array, alpha: float) -> NDArray[np.bool_]:
        """By the F test of the contrast."""
        return rejections(values, alpha)

    def exact(self, n: int, alpha: float) -> float:
        """By the noncentral F."""
        return closed_form(self.dz(), n, alpha)


@dataclass(frozen=True, eq=False)
class SampledEffect:
    """Participants drawn, with replacement, from those of a data folder: `values` (people, 2)."""

    name: str
    values: Array

    def draw(self, rng: Generator, replications: int, n: int) -> Array:
        """Whole participants, so that their two values stay together."""
        return self.values[rng.integers(len(self.values), size=(replications, n))]

    def found(self, values: Array, alpha: float) -> NDArray[np.bool_]:
        """By the F test of the contrast."""
        return rejections(values, alpha)

    def exact(self, n: int, alpha: float) -> None:
        """Unknown: nothing says that the differences are normal."""
        return


@dataclass(frozen=True)
class Power:
    """Share of replications that found the effect, with its 95 % interval; `exact` if known."""

    effect: str
    n: int
    found: float
    low: float
    high: float
    exact: float | None


def implied_r(means: Sequence[float], sds: Sequence[float], f: float, n: int) -> float:
    """Correlation of the two conditions that F(1, n − 1) implies (study.md, published results)."""
    d = means[0] - means[1]
    return (sds[0] ** 2 + sds[1] ** 2 - n * d * d / f) / (2 * sds[0] * sds[1])


def closed_form(dz: float, n: int, alpha: float) -> float:
    """Power of the F test of one contrast: 1 − F′(F_crit; 1, n − 1, n · dz²)."""
    critical = t_quantile(1 - alpha / 2, n - 1) ** 2
    return float(1 - special.ncfdtr(1, n - 1, n * dz * dz, critical))


def rejections(values: Array, alpha: float) -> NDArray[np.bool_]:
    """(replications,) whether the contrast of (replications, n, 2) values is significant.

    The scores are the analysis's; F = n · mean² / variance against its critical value.
    """
    count, n, _ = values.shape
    scores = contrast_scores(values.reshape(-1, 2), (0,))[0].reshape(count, n)
    variance = scores.var(axis=1, ddof=1)
    f = np.divide(n * scores.mean(axis=1) ** 2, variance, out=np.zeros(count), where=variance > 0)
    significant: NDArray[np.bool_] = f > t_quantile(1 - alpha / 2, n - 1) ** 2
    return significant


def power(effect: Effect, n: int, replications: int, alpha: float, rng: Generator) -> Power:
    """Power with n participants. Raises ValueError for n < 2."""
    if n < 2:
        raise ValueError(f"participants = {n}, expected at least 2")
    found = int(effect.found(effect.draw(rng, replications, n), alpha).sum())
    low, high = share_interval(found, replications)
    assert is_defined(low) and is_defined(high)  # of one replication or more they are
    return Power(effect.name, n, found / replications, low, high, effect.exact(n, alpha))


def curve(
    effects: Sequence[Effect], sizes: Sequence[int], replications: int, alpha: float, seed: int
) -> list[Power]:
    """Power of each effect at each size; every point has a stream of its own."""
    points = []
    for k, effect in enumerate(effects):
        for n in sizes:
            stream = SeedSequence(seed, spawn_key=(ANALYSIS, k, n))
            rng = np.random.Generator(np.random.PCG64(stream))
            points.append(power(effect, n, replications, alpha, rng))
    return points


def enough(points: Sequence[Power]) -> Mapping[str, int | None]:
    """For each effect the smallest n from which on power stays at 80 %; None if none does."""
    answer: dict[str, int | None] = {}
    for name in dict.fromkeys(p.effect for p in points):
        own = sorted((p for p in points if p.effect == name), key=lambda p: -p.n)
        least = None
        for point in own:
            if (point.found if point.exact is None else point.exact) < ENOUGH:
                break
            least = point.n
        answer[name] = least
    return answer


# Elmqvist2009, tables 3 and 4: (name, standard mean and s.d., dynamic mean and s.d., F(1, 15)).
PUBLISHED = (
    ("time, overall", 65.17, 27.75, 28.69, 11.02, 49.54),
    ("time T1 count", 56.26, 38.72, 40.44, 20.99, 7.54),
    ("time T2 pattern", 22.30, 16.20, 15.80, 10.21, 5.28),
    ("time T3 unique", 62.78, 35.63, 23.21, 12.01, 22.98),
    ("time T4 count in building", 140.0, 61.75, 40.80, 24.16, 48.61),
    ("relative error T1", 0.042, 0.046, 0.017, 0.018, 4.74),
    ("relative error T4", 0.123, 0.184, 0.034, 0.074, 4.12),
    ("distance T3", 16.99, 14.44, 16.21, 8.78, 0.068),  # s.d. 8.78: the scan shows "8T8"
)


def published() -> list[NormalEffect]:
    """The paper's effects as populations; each r is what the printed F implies."""
    effects = []
    for name, m1, s1, m2, s2, f in PUBLISHED:
        effects.append(NormalEffect(name, (m1, m2), (s1, s2), implied_r((m1, m2), (s1, s2), f, 16)))
    return effects
