"""Tail probabilities and the noncentral inversions behind intervals of effect sizes.

scipy.special rather than scipy.stats: it imports in a tenth of the time, and `scipy.stats.nct` is
NaN where we need it (t = −2.13, nc = 15), so the noncentral t is integrated here.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import special

from seethrough.analysis.stats.undefined import Interval, Undefined, no_interval

CAUCHY_SCALE = float(np.sqrt(0.5))
"""Scale of the Cauchy prior of the JZS Bayes factor, the usual "medium" one."""

# In units of the width of ln s; the lower tail is exponential, e^{df·x}, hence the long reach.
_NODES = np.linspace(-50.0, 12.0, 3101)


def f_tail(f: float, df1: float, df2: float) -> float:
    """P(F ≥ f)."""
    return float(special.fdtrc(df1, df2, f))


def t_two_sided(t: float, df: float) -> float:
    """P(|T| ≥ |t|)."""
    return float(2 * special.stdtr(df, -abs(t)))


def t_upper(t: float, df: float) -> float:
    """P(T ≥ t)."""
    return float(special.stdtr(df, -t))


def t_quantile(p: float, df: float) -> float:
    """The t below which a share `p` lies."""
    return float(special.stdtrit(df, p))


def chi2_tail(x: float, df: float) -> float:
    """P(χ² ≥ x)."""
    return float(special.chdtrc(df, x))


def studentized_range_tail(q: float, k: int) -> float:
    """P(range of k standard normals ≥ q): the studentised range with infinite df.

    1 − k ∫ φ(z) (Φ(z) − Φ(z − q))^{k−1} dz by trapezoid: smooth, and dead at both ends.
    """
    z = np.linspace(-9.0, 9.0 + q, 4001)
    density = np.exp(-z * z / 2) / np.sqrt(2 * np.pi)
    inside = (special.ndtr(z) - special.ndtr(z - q)) ** (k - 1)
    return float(np.clip(1 - k * np.sum(density * inside) * (z[1] - z[0]), 0.0, 1.0))


def normal_two_sided(z: float) -> float:
    """P(|Z| ≥ |z|)."""
    return float(2 * special.ndtr(-abs(z)))


def noncentral_t_cdf(t: float, df: float, nc: float) -> float:
    """P(T ≤ t) for noncentral T: the mean of Φ(t·s − nc) over s = √(χ²_df / df).

    Trapezoid over ln s, centred where its density peaks: the integrand is smooth and dies at both
    ends, so the rule converges geometrically (1e-12 and better at this spacing).
    """
    reach, weights = _spread_of_t(t, df)
    return float(weights @ special.ndtr(reach - nc))


@lru_cache(maxsize=4)  # searches for a noncentrality ask again and again for the same t and df
def _spread_of_t(t: float, df: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """t·s at the nodes of ln s, and the nodes' shares of the density of ln s."""
    # ln s has density ∝ exp(df·(x − e^{2x}/2)), its curvature at 0 is 2·df: width 1/√(2 df)
    x = _NODES / np.sqrt(2 * df)
    weights = np.exp(df * (x - np.exp(2 * x) / 2 + 0.5))
    return t * np.exp(x), weights / np.sum(weights)


def noncentral_f_cdf(f: float, df1: float, df2: float, nc: float) -> float:
    """P(F ≤ f) for noncentral F; with one df by the noncentral t, which is exact further out."""
    if df1 == 1:
        root, delta = float(np.sqrt(f)), float(np.sqrt(nc))
        return noncentral_t_cdf(root, df2, delta) - noncentral_t_cdf(-root, df2, delta)
    return float(special.ncfdtr(df1, df2, nc, f))


def _solve(cdf: Callable[[float], float], target: float, start: float, step: float) -> float:
    """The noncentrality at which a falling `cdf` meets `target`."""
    low = high = start
    while cdf(low) < target:
        low -= step
        step *= 2
    while cdf(high) > target:
        high += step
        step *= 2
    return _root(cdf, target, low, high)


def _root(cdf: Callable[[float], float], target: float, low: float, high: float) -> float:
    """Where a falling `cdf` meets `target` between low and high (Illinois regula falsi).

    A dozen steps; importing scipy's root finders would cost half a second.
    """
    f_low, f_high = cdf(low) - target, cdf(high) - target
    side = 0
    for _ in range(200):
        # the cdf is good to about 1e-14, so a closer meeting than that means nothing
        if high - low <= 1e-13 * max(1.0, abs(high)) or f_low == f_high:
            break
        middle = high - f_high * (high - low) / (f_high - f_low)
        f = cdf(middle) - target
        if abs(f) < 1e-15:
            return middle
        if f > 0:
            low, f_low = middle, f
            f_high = f_high / 2 if side == 1 else f_high
            side = 1
        else:
            high, f_high = middle, f
            f_low = f_low / 2 if side == -1 else f_low
            side = -1
    return low if abs(f_low) < abs(f_high) else high


def noncentral_t_interval(t: float, df: float, level: float = 0.95) -> tuple[float, float]:
    """The noncentralities for which `t` lies at the two tails (the pivot method)."""
    tail = (1 - level) / 2
    return (
        _solve(lambda nc: noncentral_t_cdf(t, df, nc), 1 - tail, t, 1.0),
        _solve(lambda nc: noncentral_t_cdf(t, df, nc), tail, t, 1.0),
    )


def noncentral_f_interval(f: float, df1: float, df2: float, level: float = 0.90) -> Interval:
    """Noncentralities λ ≥ 0 for which `f` lies at the two tails; 0 where none reaches the tail."""

    def cdf(nc: float) -> float:
        return noncentral_f_cdf(f, df1, df2, nc)

    ends = []
    for target in ((1 + level) / 2, (1 - level) / 2):
        if cdf(0.0) <= target:
            ends.append(0.0)
            continue
        high = max(1.0, f * df1)
        while cdf(high) > target:
            high *= 2
        ends.append(_root(cdf, target, 0.0, high))
    if not np.all(np.isfinite(ends)):
        return no_interval("the noncentral F distribution cannot be inverted here")
    return ends[0], ends[1]


def bayes_factor_t(t: float, n: int, scale: float = CAUCHY_SCALE) -> float | Undefined:
    """JZS Bayes factor BF10 of a one-sample t (Rouder et al. 2009, equation 1, with a scale)."""
    return bayes_factor_f(t * t, 1, n, scale)


def bayes_factor_f(f: float, df1: int, n: int, scale: float = CAUCHY_SCALE) -> float | Undefined:
    """JZS Bayes factor BF10 of a within-participant effect with F(df1, df1·(n − 1)).

    Rouder et al. 2012 (section "Fixed effects") for one effect, the participants' levels projected
    out as the F test does: the df1 standardised orthonormal contrasts have normal priors of one
    variance g·scale², g inverse χ²₁, together a multivariate Cauchy; p(σ²) ∝ 1/σ². Like the
    uncorrected F it takes the contrasts to be spherical. With df1 = 1 it is the JZS factor of the
    paired t. The integral over g is taken on ln g by trapezoid, everything as logarithms, so that
    t = 100 does not overflow before the end.
    """
    ratio = f / (n - 1)  # sum of squares of the effect over that of the error
    x = np.linspace(-12.0, 90.0, 6001)
    spread = 1 + n * scale**2 * np.exp(x)
    log_integrand = (
        -df1 / 2 * np.log(spread)
        - df1 * n / 2 * np.log1p(ratio / spread)
        - 0.5 * np.log(2 * np.pi)
        - 0.5 * x
        - 0.5 * np.exp(-x)
    )
    peak = float(np.max(log_integrand))
    log_area = peak + np.log(np.sum(np.exp(log_integrand - peak)) * (x[1] - x[0]))
    log_bf = log_area + df1 * n / 2 * np.log1p(ratio)
    if log_bf > 700:
        return Undefined("larger than 10^304")
    return float(np.exp(log_bf))


def negligible_p(f: float, df1: int, df2: int, pes: float) -> float:
    """p of the hypothesis that partial η² is `pes` or more: small means the effect is negligible.

    The non-inferiority test of an omnibus F (Campbell & Lakens 2021, equation 6), with λ from
    η²p = λ / (λ + df₂), the convention of the intervals here.
    """
    return noncentral_f_cdf(f, df1, df2, df2 * pes / (1 - pes))


def detectable(n: int, alpha: float, power: float) -> float:
    """The |d_z| that a two-sided paired t test of n ≥ 2 finds with this power."""
    return _shift(n - 1, alpha, power) / float(np.sqrt(n))


def detectable_between(first: int, second: int, alpha: float, power: float) -> float:
    """The |d| that a two-sided t test of two groups, n ≥ 2 each, finds with this power where they
    spread alike."""
    return _shift(first + second - 2, alpha, power) * float(np.sqrt(1 / first + 1 / second))


def _shift(df: int, alpha: float, power: float) -> float:
    """The noncentrality that t of `df` finds with this power."""
    critical = t_quantile(1 - alpha / 2, df) ** 2
    return _solve(lambda nc: noncentral_f_cdf(critical, 1, df, nc**2), 1 - power, 3.0, 1.0)
