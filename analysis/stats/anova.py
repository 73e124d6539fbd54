"""Repeated-measures analysis of variance by contrast scores.

Every effect becomes one score per participant (or df₁ scores, on orthogonal contrasts), formed
after subtracting within the participant, and is tested against the scores' own spread. Nothing is
ever squared before the participant's level is gone, so an offset of 10¹⁵ costs no digit, and a
missing cell cannot slip in: the input is a full array.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import chi2_tail, f_tail, noncentral_f_interval
from seethrough.analysis.stats.undefined import (
    ALL_EQUAL,
    ONE_PARTICIPANT,
    Interval,
    Number,
    Undefined,
    is_defined,
    no_interval,
    spread_is_noise,
)

NO_HF: Number = Undefined("not computed")


@dataclass(frozen=True, slots=True)
class Effect:
    """One row of an ANOVA table; `p_gg` uses Greenhouse–Geisser's ε (1 for one-df effects), `p_hf`
    Huynh and Feldt's (Lecoutre's form, at most 1), `p_lower` the least that ε can be.

    `ges` is generalised η² (Olejnik & Algina 2003, all factors within), `pes` partial η² with its
    90 % interval λ/(λ + df₂) from the noncentral F; that interval is undefined where F is so small
    that it does not hold its own estimate.
    """

    name: str
    n: int
    df1: int
    df2: int
    ss_effect: float
    ss_error: float
    f: Number
    p: Number
    eps: Number
    p_gg: Number
    mauchly_w: Number
    mauchly_p: Number
    ges: Number
    pes: Number
    pes_interval: Interval
    eps_hf: Number = NO_HF
    p_hf: Number = NO_HF
    p_lower: Number = NO_HF
    error_df: int = 0

    @property
    def few(self) -> bool:
        """Whether the error has no more df than the effect has contrasts within people.

        ε cannot be estimated then, and the lower bound decides.
        """
        q = self.df2 // self.error_df if self.error_df else 1
        return q > 1 and self.error_df <= q

    @property
    def decisive(self) -> Number:
        """The p that decides: by Greenhouse and Geisser's ε, by the lower bound where few."""
        return self.p_lower if self.few else self.p_gg


def helmert(k: int) -> tuple[Array, Array]:
    """Orthogonal integer contrasts of k levels, (k, k − 1), and their squared lengths (k − 1,).

    Integers, because then sums of exactly representable data stay exact; lengths are divided out
    at the end.
    """
    contrasts = np.zeros((k, k - 1))
    for j in range(1, k):
        contrasts[:j, j - 1] = -1
        contrasts[j, j - 1] = j
    return contrasts, np.array([j * (j + 1.0) for j in range(1, k)])


def contrast_scores(y: Array, inside: Sequence[int]) -> tuple[Array, Array]:
    """Scores (n, q) of the effect of the factors `inside`, and their contrasts' squared lengths.

    `y`: (n, k₁, …, k_m). Factors not `inside` are summed over.
    """
    n, levels = y.shape[0], y.shape[1:]
    flat = y.reshape(n, -1)
    matrix: Array = np.ones((1, 1))
    lengths: Array = np.ones(1)
    for factor, k in enumerate(levels):
        own = helmert(k) if factor in inside else (np.ones((k, 1)), np.array([float(k)]))
        matrix = np.kron(matrix, own[0]).astype(float, copy=False)
        lengths = np.kron(lengths, own[1]).astype(float, copy=False)
    return (flat - flat[:, :1]) @ matrix, lengths


def repeated_measures(y: Array, factors: Sequence[str]) -> dict[str, Effect]:
    """All main effects and interactions of a fully within-participant design.

    `y`: (n, k₁, …, k_m), one finite value per participant and cell; names like `a × b`.
    Raises ValueError for missing or non-finite values.
    """
    if y.ndim != len(factors) + 1 or not np.all(np.isfinite(y)):
        raise ValueError("y must be finite with one axis per factor after the participants")
    names = [
        inside
        for size in range(1, len(factors) + 1)
        for inside in itertools.combinations(range(len(factors)), size)
    ]
    scale = float(np.max(np.abs(y), initial=0.0))
    raw = {inside: _sums(*contrast_scores(y, inside)) for inside in names}
    within_error = sum(error for _, error, _ in raw.values())
    residual = _between(y) + within_error
    return {
        (name := " × ".join(factors[f] for f in inside)): _effect(
            name, raw[inside], len(y), scale, residual
        )
        for inside in names
    }


def _sums(scores: Array, lengths: Array) -> tuple[float, float, Array]:
    """Sums of squares of effect and error, and the scores on unit contrasts."""
    n = len(scores)
    mean = scores.mean(axis=0)
    mean = mean + (scores - mean).mean(axis=0)
    effect = float(np.sum(n * mean**2 / lengths))
    centred = (scores - mean) / np.sqrt(lengths)
    return effect, float(np.sum(centred**2)), centred


def _between(y: Array) -> float:
    """Sum of squares between participants, on the scale of the cells."""
    flat = y.reshape(len(y), -1)
    means = (flat - flat[0, 0]).mean(axis=1)
    return float(flat.shape[1] * np.sum((means - means.mean()) ** 2))


def _effect(
    name: str, sums: tuple[float, float, Array], n: int, scale: float, residual: float
) -> Effect:
    """Test one effect from its sums of squares and centred unit scores (n, q)."""
    ss_effect, ss_error, centred = sums
    df1, df2 = centred.shape[1], centred.shape[1] * (n - 1)
    total = ss_effect + residual
    ges: Number = ss_effect / total if total > 0 else Undefined("nothing varies")
    reason = ONE_PARTICIPANT if n < 2 else ALL_EQUAL if spread_is_noise(centred, scale) else ""
    if reason:
        gone, ends = Undefined(reason), no_interval(reason)
        size = ges if n >= 2 else gone
        same = (gone, gone, gone, gone, gone, gone)
        return Effect(
            name, n, df1, df2, ss_effect, ss_error, *same, size, gone, ends, gone, gone, gone, n - 1
        )
    return tested(name, n, 1, n - 1, (ss_effect, ss_error), centred, ges)


def tested(
    name: str, n: int, rank: int, free: int, ss: tuple[float, float], centred: Array, ges: Number
) -> Effect:
    """An effect's tests from its sums of squares (effect, error) and the residuals (n, q).

    `rank`: the between effect's df, 1 where there is none; `free`: the error's df in each contrast.
    """
    q = centred.shape[1]
    df1, df2 = q * rank, q * free
    f = (ss[0] / df1) / (ss[1] / df2)
    eps = _greenhouse_geisser(centred)
    hf = huynh_feldt(eps, q, free)
    w, w_p = _mauchly(centred, free)
    pes = ss[0] / (ss[0] + ss[1])
    return Effect(
        name,
        n,
        df1,
        df2,
        ss[0],
        ss[1],
        f,
        f_tail(f, df1, df2),
        eps,
        f_tail(f, df1 * eps, df2 * eps),
        w,
        w_p,
        ges,
        pes,
        _pes_interval(pes, f, df1, df2),
        hf,
        f_tail(f, df1 * hf, df2 * hf) if is_defined(hf) else hf,
        f_tail(f, rank, free),
        free,
    )


def huynh_feldt(eps: float, q: int, free: int) -> Number:
    """Huynh and Feldt's ε as Lecoutre corrected it, at most 1; `free`: N less the groups."""
    if q == 1:
        return 1.0
    below = q * (free - q * eps)
    if below <= 0:
        return Undefined("too few participants for its contrasts")
    return float(min(1.0, ((free + 1) * q * eps - 2) / below))


def _pes_interval(pes: float, f: float, df1: int, df2: int) -> Interval:
    low, high = (e / (e + df2) if is_defined(e) else e for e in noncentral_f_interval(f, df1, df2))
    if is_defined(high) and high < pes:
        return no_interval("F is so small that the interval does not hold its estimate")
    return low, high


def _greenhouse_geisser(centred: Array) -> float:
    """ε = tr(Σ)² / (q · tr(Σ²)); 1 for one contrast."""
    q = centred.shape[1]
    if q == 1:
        return 1.0
    cov = centred.T @ centred
    return float(np.trace(cov) ** 2 / (q * np.sum(cov**2)))


def _mauchly(centred: Array, df: int) -> tuple[Number, Number]:
    """Mauchly's W and its p, with Box's second-order term.

    The term takes q, the number of contrasts (Anderson 2003, section 10.7); R's mauchly.test puts
    the number of cells there, and its p differs slightly.
    """
    q = centred.shape[1]
    if q == 1:
        return Undefined("one contrast is always spherical"), Undefined(
            "one contrast is always spherical"
        )
    if df < q:
        few = Undefined("fewer participants than contrasts")
        return few, few
    cov = centred.T @ centred / df
    sign, log_det = np.linalg.slogdet(cov)
    if sign <= 0:
        flat = Undefined("the contrasts' covariance is singular")
        return flat, flat
    log_w = float(log_det - q * np.log(np.trace(cov) / q))
    rho = 1 - (2 * q**2 + q + 2) / (6 * q * df)
    chi2 = -df * rho * log_w
    dof = q * (q + 1) / 2 - 1
    w2 = (q + 2) * (q - 1) * (q - 2) * (2 * q**3 + 6 * q**2 + 3 * q + 2)
    w2 /= 288 * (df * q * rho) ** 2
    first, second = chi2_tail(chi2, dof), chi2_tail(chi2, dof + 4)
    return float(np.exp(log_w)), float(np.clip(first + w2 * (second - first), 0.0, 1.0))
