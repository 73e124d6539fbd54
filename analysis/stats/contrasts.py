"""Contrasts with their own error: within people, between groups, and of one between the other.

One score per person is made first (a within contrast, or the person's mean); groups are then set
against each other without assuming that they spread alike (Welch 1947, Satterthwaite's df). Always:
a test of spreads that chooses the test makes it worse.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seethrough.analysis.stats.arrays import Array, mean_of
from seethrough.analysis.stats.distributions import t_quantile, t_two_sided, t_upper
from seethrough.analysis.stats.undefined import (
    ALL_EQUAL,
    Interval,
    Number,
    Undefined,
    no_interval,
    spread_is_noise,
)

LEAST = 3
"""People a group needs for a contrast between groups; two reject in .11 of studies, for .05."""
FEW = 5
"""Below so many in a group, a contrast is flagged: .05 to .06, where skewed .10."""
TOO_FEW = f"a group of fewer than {LEAST}"


@dataclass(frozen=True, slots=True)
class Estimate:
    """Σ w·mean over the groups, with Satterthwaite's df; `least`: the smallest group."""

    n: int
    least: int
    estimate: float
    error: Number
    df: Number
    t: Number
    p: Number
    interval: Interval


def estimate(
    groups: Sequence[Array], weights: Sequence[float], scale: float | None = None,
    level: float = 0.95,
) -> Estimate:  # fmt: skip
    """ψ = Σ w_g mean(d_g) of one score per person, by group; tested against 0.

    SE² = Σ w_g² s_g²/n_g; df = SE⁴ / Σ[(w_g² s_g²/n_g)²/(n_g − 1)]. One group of weight 1 is
    Student's t of the scores. `scale`: the largest absolute value that the scores were made from.
    Raises ValueError for a group without anybody.
    """
    used = [(np.asarray(g, dtype=np.float64), w) for g, w in zip(groups, weights, strict=True) if w]
    if not used or any(len(g) == 0 for g, _ in used):
        raise ValueError("a group has nobody")
    n, least = sum(len(g) for g, _ in used), min(len(g) for g, _ in used)
    value = float(sum(w * mean_of(g) for g, w in used))
    needed = LEAST if len(used) > 1 else 2
    why = ""
    if least < needed:
        why = TOO_FEW if len(used) > 1 else "fewer than two participants"
    else:
        size = max(float(np.max(np.abs(g))) for g, _ in used) if scale is None else scale
        if all(spread_is_noise(g, size) for g, _ in used):
            why = ALL_EQUAL
    if why:
        gone = Undefined(why)
        return Estimate(n, least, value, gone, gone, gone, gone, no_interval(why))
    parts = [w * w * float(np.var(g - g[0], ddof=1)) / len(g) for g, w in used]
    error = float(np.sqrt(sum(parts)))
    df = sum(parts) ** 2 / sum(
        part**2 / (len(g) - 1) for part, (g, _) in zip(parts, used, strict=True)
    )
    half = t_quantile((1 + level) / 2, df) * error
    t = value / error
    ends = (value - half, value + half)
    return Estimate(n, least, value, error, df, t, t_two_sided(t, df), ends)


def within_margin(found: Estimate, margin: float) -> tuple[Number, Number, Number]:
    """p of lying above −margin, of lying below it, and of both: two one-sided tests."""
    if isinstance(found.error, Undefined) or isinstance(found.df, Undefined):
        assert isinstance(found.t, Undefined)
        return found.t, found.t, found.t
    above = t_upper((found.estimate + margin) / found.error, found.df)
    below = t_upper((margin - found.estimate) / found.error, found.df)
    return above, below, max(above, below)


def trend(x: Sequence[float], degree: int = 1) -> Array:
    """Weights of a polynomial trend over levels at `x`, (k,).

    The linear one is a slope, (x − x̄) / Σ(x − x̄)²; the quadratic one is orthogonal to it and of
    unit length, as `contr.poly(k, scores = x)`. Raises ValueError where there are too few levels.
    """
    at = np.asarray(x, dtype=np.float64)
    if len(np.unique(at)) <= degree:
        raise ValueError(f"a trend of degree {degree} needs {degree + 1} different levels")
    centred = at - at.mean()
    if degree == 1:
        return np.asarray(centred / np.sum(centred**2))
    basis, triangle = np.linalg.qr(np.vander(centred, degree + 1, increasing=True))
    return np.asarray(basis[:, degree] * np.sign(triangle[degree, degree]))
