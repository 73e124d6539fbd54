"""Power in closed form, where scores are normal: Student's t with its noncentrality.

`delta` is a standardised effect, the noncentrality over √n, positive in the predicted direction.
"""

from __future__ import annotations

from math import inf, sqrt

from scipy import special

from seethrough.analysis.stats.distributions import noncentral_t_interval, t_quantile

ENOUGH = 0.8
FAR = 35.0
MOST = 10_000  # people; who needs more is told ∞


def signed_power(
    delta: float, n: int, alpha: float, df: float | None = None, sides: int = 2
) -> float:
    """P(p < α and the predicted sign) with n people."""
    df = n - 1 if df is None else df
    critical, far = t_quantile(1 - alpha / sides, df), delta * sqrt(n)
    if abs(far) > FAR:
        return float(far > 0)  # nctdtr has no digits there
    return float(1 - special.nctdtr(df, far, critical))


def needed(delta: float, alpha: float, sides: int = 2, least: int = 3) -> float:
    """The smallest n with a signed power of 80 %; ∞ for what would take more than `MOST`."""
    if not delta > 0 or signed_power(delta, MOST, alpha, None, sides) < ENOUGH:
        return inf
    low, high = least - 1, MOST  # power grows with n
    while high - low > 1:
        middle = (low + high) // 2
        enough = signed_power(delta, middle, alpha, None, sides) >= ENOUGH
        low, high = (low, middle) if enough else (middle, high)
    return high


def interval_of(delta: float, n: float, df: float) -> tuple[float, float]:
    """95 % interval of a standardised effect that n people showed (noncentral t)."""
    low, high = noncentral_t_interval(delta * sqrt(n), df)
    return float(low) / sqrt(n), float(high) / sqrt(n)
