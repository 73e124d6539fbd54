"""Linear mixed models of participants by restricted maximum likelihood.

y = Xβ + Zb + e with b ~ N(0, σ²ΛΛᵀ), e ~ N(0, σ²): each random term has a lower triangular factor θ
of its covariance relative to σ², as in lme4 (Bates et al. 2015). All random terms are nested in the
participants, so everything is a sum over participants of small matrices. β and σ² are profiled out;
the deviance of θ is minimised with its exact gradient from several starts. An estimate on the
boundary (a variance of 0, a correlation of ±1) is the answer there, and is called singular.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array

STARTS = (1.0, 0.3, 0.05)
"""Diagonals of θ to start from: a term's s.d. over that of the residuals."""
SINGULAR = 1e-4
"""A diagonal of θ below this counts as 0, as lme4's isSingular has it."""
FLAT = 1e-4
"""Steepest slope of the deviance over θ that counts as a minimum, for each thousand rows or part:
the curvature grows with the rows, so that θ is as close."""


@dataclass(frozen=True, slots=True)
class Term:
    """A random term: columns (N, q), the same for each of `parts` groups within a participant.

    `part` (N,): which of the participant's groups a row is in, 0 … parts − 1.
    """

    columns: Array
    part: NDArray[np.intp]
    parts: int

    @property
    def size(self) -> int:
        """Effects of one group."""
        return int(self.columns.shape[1])


@dataclass(frozen=True, slots=True)
class Fit:
    """`beta` with its s.e.; `covariances` of each term's effects, on the scale of y."""

    beta: Array
    errors: Array
    sigma: float
    covariances: tuple[Array, ...]
    deviance: float
    converged: bool
    singular: bool


def fit(y: Array, x: Array, person: NDArray[np.intp], terms: Sequence[Term]) -> Fit:
    """Fit y (N,) on x (N, p) of full rank, with `person` (N,) codes 0 … n − 1.

    Raises numpy's LinAlgError where the data leave nothing to fit.
    """
    from scipy.optimize import minimize  # half a second of import

    sums = _sums(y, x, person, terms)
    sizes = [t.size for t in terms]
    bounds = [(0.0 if i == j else None, None) for q in sizes for i, j in _places(q)]
    best = None
    # TNC, for scipy's L-BFGS-B spends a hundred times as long in waking threads for tiny matrices
    for start in STARTS:
        theta = np.concatenate([[start * (i == j) for i, j in _places(q)] for q in sizes])
        found = minimize(
            lambda t: _deviance(sums, terms, t)[:2],
            theta,
            jac=True,
            method="TNC",
            bounds=bounds,
            options={"ftol": 0.0, "xtol": 0.0, "gtol": 1e-9, "maxfun": 3000},
        )
        if best is None or found.fun < best.fun - 1e-9:
            best = found
    assert best is not None
    deviance, slope, s2, information, beta = _deviance(sums, terms, best.x)
    at_end = np.array([b[0] == 0.0 for b in bounds]) & (best.x < SINGULAR)
    steep = np.where(at_end, np.minimum(slope, 0.0), slope)
    factors = _factors(best.x, sizes)
    return Fit(
        beta,
        np.sqrt(s2 * np.diag(np.linalg.inv(information))),
        float(np.sqrt(s2)),
        tuple(s2 * f @ f.T for f in factors),
        deviance,
        bool(np.max(np.abs(steep)) < FLAT * max(1.0, len(y) / 1000)),
        bool(any(np.min(np.abs(np.diag(f))) < SINGULAR for f in factors)),
    )


@dataclass(frozen=True, slots=True)
class _Sums:
    """Cross products, by participant where Z is in them: (n, Q, Q), (n, Q, p), (n, Q)."""

    zz: Array
    zx: Array
    zy: Array
    xx: Array
    xy: Array
    yy: float
    rows: int


def _sums(y: Array, x: Array, person: NDArray[np.intp], terms: Sequence[Term]) -> _Sums:
    wide = sum(t.size * t.parts for t in terms)
    z = np.zeros((len(y), wide))
    at = 0
    for term in terms:
        for part in range(term.parts):
            own = term.part == part
            z[own, at : at + term.size] = term.columns[own]
            at += term.size
    order = np.argsort(person, kind="stable")
    starts = np.flatnonzero(np.diff(person[order], prepend=-1))

    def by_person(a: Array, b: Array) -> Array:
        return np.add.reduceat(a[order][:, :, None] * b[order][:, None, :], starts, axis=0)

    return _Sums(
        by_person(z, z),
        by_person(z, x),
        by_person(z, y[:, None])[..., 0],
        x.T @ x,
        x.T @ y,
        float(y @ y),
        len(y),
    )


def _places(q: int) -> list[tuple[int, int]]:
    """Entries of a lower triangle, column by column."""
    return [(i, j) for j in range(q) for i in range(j, q)]


def _factors(theta: Array, sizes: Sequence[int]) -> list[Array]:
    """The lower triangles that θ holds, one a term."""
    found, at = [], 0
    for q in sizes:
        factor = np.zeros((q, q))
        for i, j in _places(q):
            factor[i, j] = theta[at]
            at += 1
        found.append(factor)
    return found


def _deviance(
    sums: _Sums, terms: Sequence[Term], theta: Array
) -> tuple[float, Array, float, Array, Array]:
    """Restricted deviance, its gradient over θ, σ², Xᵀ V⁻¹ X and β.

    V = I + ZΛΛᵀZᵀ = σ⁻² cov(y). With A = I + ΛᵀZᵀZΛ: V⁻¹ = I − ZΛA⁻¹ΛᵀZᵀ and |V| = |A|. The
    gradient is tr(P dV) − yᵀP dV P y / σ², P = V⁻¹ − V⁻¹X(XᵀV⁻¹X)⁻¹XᵀV⁻¹.
    """
    factors = _factors(theta, [t.size for t in terms])
    whole = _block_diagonal(
        [f for f, t in zip(factors, terms, strict=True) for _ in range(t.parts)]
    )
    inner = np.eye(len(whole)) + whole.T @ sums.zz @ whole
    log_v = float(np.sum(np.linalg.slogdet(inner)[1]))
    back = whole @ np.linalg.solve(inner, np.broadcast_to(whole.T, inner.shape))  # ΛA⁻¹Λᵀ
    left = np.swapaxes(sums.zx, 1, 2) @ back
    information = sums.xx - (left @ sums.zx).sum(axis=0)
    xvy = sums.xy - (left @ sums.zy[..., None])[..., 0].sum(axis=0)
    yvy = sums.yy - float(np.einsum("ni,nij,nj->", sums.zy, back, sums.zy))
    beta = np.linalg.solve(information, xvy)
    free = sums.rows - len(beta)
    s2 = (yvy - float(xvy @ beta)) / free
    if not s2 > 0:
        raise np.linalg.LinAlgError("nothing is left to explain")
    log_x = float(np.linalg.slogdet(information)[1])
    deviance = log_v + log_x + free * (1 + np.log(2 * np.pi * s2))
    # Zᵀ V⁻¹ of Z, X and y − Xβ
    zvz = sums.zz - sums.zz @ back @ sums.zz
    zvx = sums.zx - sums.zz @ back @ sums.zx
    rest = sums.zy - sums.zx @ beta
    score = rest - (sums.zz @ back @ rest[..., None])[..., 0]
    zpz = zvz - zvx @ np.linalg.inv(information) @ np.swapaxes(zvx, 1, 2)
    pull = zpz.sum(axis=0) - np.einsum("ni,nj->ij", score, score) / s2
    slope = 2 * pull @ whole
    return deviance, _gather(slope, terms), s2, information, beta


def _block_diagonal(blocks: Sequence[Array]) -> Array:
    size = sum(len(b) for b in blocks)
    out = np.zeros((size, size))
    at = 0
    for block in blocks:
        out[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return out


def _gather(slope: Array, terms: Sequence[Term]) -> Array:
    """The gradient over θ: a term's groups share their factor, so their parts add up."""
    found, at = [], 0
    for term in terms:
        q = term.size
        own = np.zeros((q, q))
        for _ in range(term.parts):
            own += slope[at : at + q, at : at + q]
            at += q
        found += [own[i, j] for i, j in _places(q)]
    return np.array(found)
