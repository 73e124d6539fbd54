"""Two conditions, one value each per participant: the test of their difference, and its size.

Differences are `first − second`, a baseline less a level: positive means less (time, error) under
the level. Ratios are second / first.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.analysis.stats.arrays import Array, mean_of
from seethrough.analysis.stats.distributions import (
    bayes_factor_t,
    noncentral_t_interval,
    t_quantile,
    t_two_sided,
    t_upper,
)
from seethrough.analysis.stats.undefined import (
    ALL_EQUAL,
    ONE_PARTICIPANT,
    Interval,
    Number,
    Undefined,
    no_interval,
    spread_is_noise,
)


@dataclass(frozen=True, slots=True)
class Paired:
    """All that is said about one difference; d_z = mean / s.d. of the differences."""

    n: int
    difference: float
    sd: Number
    interval: Interval
    t: Number
    p: Number
    dz: Number
    dz_interval: Interval
    bf10: Number
    shapiro_w: Number
    shapiro_p: Number


def paired(first: Array, second: Array, level: float = 0.95) -> Paired:
    """Test `first − second` (n values each, finite) against 0 with Student's t."""
    return one_sample(first - second, _scale(first, second), level)


def one_sample(scores: Array, scale: float | None = None, level: float = 0.95) -> Paired:
    """Test one contrast score per participant against 0.

    `scale`: the largest absolute value among the data the scores were made from, which bounds
    their rounding; the scores' own by default.
    """
    n = len(scores)
    if n == 0:
        raise ValueError("no participants")
    scale = float(np.max(np.abs(scores))) if scale is None else scale
    mean = mean_of(scores)
    reason = ONE_PARTICIPANT if n < 2 else ALL_EQUAL if spread_is_noise(scores, scale) else ""
    if reason:
        gone, ends = Undefined(reason), no_interval(reason)
        sd: Number = 0.0 if n >= 2 else gone
        return Paired(n, mean, sd, ends, gone, gone, gone, ends, gone, gone, gone)
    sd = float(np.sqrt(np.sum((scores - mean) ** 2) / (n - 1)))
    half = t_quantile((1 + level) / 2, n - 1) * sd / np.sqrt(n)
    t = mean / (sd / np.sqrt(n))
    low, high = noncentral_t_interval(t, n - 1, level)
    w, w_p = shapiro(scores)
    return Paired(
        n,
        mean,
        sd,
        (float(mean - half), float(mean + half)),
        float(t),
        t_two_sided(t, n - 1),
        mean / sd,
        (float(low / np.sqrt(n)), float(high / np.sqrt(n))),
        bayes_factor_t(t, n),
        w,
        w_p,
    )


def shapiro(scores: Array) -> tuple[Number, Number]:
    """Shapiro–Wilk's W and p for normality of the differences."""
    if not 3 <= len(scores) <= 5000:
        out = Undefined("Shapiro–Wilk is made for 3 to 5000 values")
        return out, out
    from scipy.stats import shapiro as shapiro_wilk  # imports slowly, so only where it is needed

    centred = scores - scores.mean()
    result = shapiro_wilk(centred / np.max(np.abs(centred)))
    return float(result.statistic), float(result.pvalue)


def mean_interval(values: Array, level: float = 0.95) -> Interval:
    """Student's interval of the mean of n values."""
    n = len(values)
    if n < 2:
        return no_interval(ONE_PARTICIPANT)
    mean = mean_of(values)
    half = t_quantile((1 + level) / 2, n - 1) * float(np.std(values - values[0], ddof=1)) / n**0.5
    return mean - half, mean + half


def ratio_of_means(first: Array, second: Array, level: float = 0.95) -> tuple[Number, Interval]:
    """mean(second) / mean(first) with Fieller's interval for paired data."""
    n = len(first)
    a, b = mean_of(second), mean_of(first)
    if b == 0:
        why = "the baseline's mean is zero"
        return Undefined(why), no_interval(why)
    if n < 2:
        return a / b, no_interval(ONE_PARTICIPANT)
    t2 = t_quantile((1 + level) / 2, n - 1) ** 2 / n
    cov = np.cov(second, first)
    lead = b * b - t2 * cov[1, 1]
    if lead <= 0:
        return a / b, no_interval("the baseline's mean is not clearly different from zero")
    middle = a * b - t2 * cov[0, 1]
    root = np.sqrt(max(0.0, middle**2 - lead * (a * a - t2 * cov[0, 0])))
    return a / b, (float((middle - root) / lead), float((middle + root) / lead))


@dataclass(frozen=True, slots=True)
class Equivalence:
    """Two one-sided tests; `p` is the larger one.

    `p_low`: that the difference first − second lies above the lower end, that is, that the second
    is not larger by the margin; `p_high`: that it lies below the upper one.
    """

    margin: float
    p_low: Number
    p_high: Number
    p: Number
    interval90: Interval


def tost(scores: Array, margin: float, scale: float | None = None) -> Equivalence:
    """Is the mean difference inside ±margin (> 0)? (Schuirmann 1987.)"""
    result = one_sample(scores, scale, level=0.90)
    if isinstance(result.sd, Undefined) or isinstance(result.t, Undefined):
        reason = result.t.reason if isinstance(result.t, Undefined) else ALL_EQUAL
        gone = Undefined(reason)
        return Equivalence(margin, gone, gone, gone, no_interval(reason))
    error = result.sd / np.sqrt(result.n)
    low = t_upper((result.difference + margin) / error, result.n - 1)
    high = t_upper((margin - result.difference) / error, result.n - 1)
    return Equivalence(margin, low, high, max(low, high), result.interval)


def ratio_within(first: Array, second: Array, theta: float, level: float = 0.90) -> Equivalence:
    """Is mean(second) / mean(first) inside (1/θ, θ), θ > 1, for n pairs of positive values?

    One-sided t tests of second − θ·first < 0 and second − first/θ > 0: exact where a test against a
    share of the observed mean is not, for here nothing that was estimated is taken as known.
    """
    upper = one_sample(second - theta * first, _scale(second, theta * first))
    lower = one_sample(second - first / theta, _scale(second, first))
    if isinstance(upper.t, Undefined) or isinstance(lower.t, Undefined):
        gone = next(r.t for r in (upper, lower) if isinstance(r.t, Undefined))
        return Equivalence(theta, gone, gone, gone, no_interval(gone.reason))
    p_low, p_high = t_upper(-upper.t, upper.n - 1), t_upper(lower.t, lower.n - 1)
    ends = ratio_of_means(first, second, level)[1]
    return Equivalence(theta, p_low, p_high, max(p_low, p_high), ends)


def _scale(*parts: Array) -> float:
    return float(max(np.max(np.abs(p), initial=0.0) for p in parts))


def within_halfwidths(y: Array, level: float = 0.95) -> list[Number]:
    """Half-widths of Cousineau–Morey intervals for the k columns of y, (n, k).

    Cousineau 2005 removes the participants' means; Morey 2008's √(k/(k − 1)) mends the bias.
    """
    n, k = y.shape
    if n < 2:
        return [Undefined(ONE_PARTICIPANT)] * k
    if k < 2:
        return [Undefined("one condition has no within-participant spread")]
    centred = y - y[:, :1]
    centred = centred - centred.mean(axis=1, keepdims=True)
    sd = np.std(centred, axis=0, ddof=1) * np.sqrt(k / (k - 1))
    widths: list[Number] = (t_quantile((1 + level) / 2, n - 1) * sd / np.sqrt(n)).tolist()
    return widths
