"""Data that have exactly the printed means, standard deviations and F.

With n participants and two conditions, F = n·d² / (s₁² + s₂² − 2·r·s₁·s₂): the printed numbers fix
the correlation r, and any data with these moments give F back by construction.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.random import Generator

from seethrough.analysis.published.numbers import Moments, PublishedMeasure
from seethrough.analysis.stats.arrays import Array


def implied_r(n: int, m1: float, s1: float, m2: float, s2: float, f: float) -> float:
    """The correlation between the conditions that F implies; outside [−1, 1] nothing fits."""
    return (s1**2 + s2**2 - n * (m1 - m2) ** 2 / f) / (2 * s1 * s2)


def r_of(measure: PublishedMeasure, n: int) -> float:
    """`implied_r` of the printed values."""
    a, b = measure.standard, measure.dynamic
    return implied_r(n, a.mean.value, a.sd.value, b.mean.value, b.sd.value, measure.f.value)


def r_interval(measure: PublishedMeasure, n: int) -> tuple[float, float]:
    """The r that some values rounding to the printed ones imply.

    r is monotone in F and in the difference of the means (which keeps its sign), and over the
    tiny box of s.d. its extremes lie at the corners.
    """
    a, b = measure.standard, measure.dynamic
    corners = itertools.product(*((p.low, p.high) for p in (a.mean, a.sd, b.mean, b.sd, measure.f)))
    values = [implied_r(n, *corner) for corner in corners]
    return min(values), max(values)


def exact_moments(
    n: int, first: Moments, second: Moments, r: float, rng: Generator, tries: int = 4000
) -> tuple[Array, Array]:
    """Positive data with exactly these moments and correlation; skewed, as times and errors are.

    Raises ValueError if none is found: the moments may not allow positive data.
    """
    for _ in range(tries):
        skew = rng.uniform(0.3, 1.6)
        shapes = np.exp(skew * rng.standard_normal((2, n)))
        z1 = _unit(shapes[0])
        other = shapes[1] - shapes[1].mean()
        z2 = _unit(other - z1 * (other @ z1) / (z1 @ z1))
        a = first.mean.value + first.sd.value * z1
        b = second.mean.value + second.sd.value * (r * z1 + np.sqrt(1 - r * r) * z2)
        if a.min() > 0 and b.min() > 0:
            return a, b
    raise ValueError("no positive data found with these moments")


def _unit(x: Array) -> Array:
    centred = x - x.mean()
    unit: Array = centred / np.std(centred, ddof=1)
    return unit
