"""Linear mixed models of participants by restricted maximum likelihood.

y = Xβ + Zb + e with b ~ N(0, σ²ΛΛᵀ), e ~ N(0, σ²): each random term has a lower triangular factor θ
of its covariance relative to σ², as in lme4 (Bates et al. 2015). Random terms are nested in the
participants, so everything is a sum over participants of small matrices; one term may be crossed
with them (scenes that many people meet), whose effects are solved for beside β, as in Henderson's
equations. β and σ² are profiled out; the deviance of θ is minimised with its exact gradient from
several starts. An estimate on the boundary (a variance of 0, a correlation of ±1) is the answer
there, and is called singular.
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
    """`beta` with its s.e.; `covariances` of each term's effects, on the scale of y; `edges`: which
    terms are on the boundary."""

    beta: Array
    errors: Array
    sigma: float
    covariances: tuple[Array, ...]
    deviance: float
    converged: bool
    edges: tuple[bool, ...]

    @property
    def singular(self) -> bool:
        """Whether any term is on the boundary."""
        return any(self.edges)


def fit(
    y: Array, x: Array, person: NDArray[np.intp], terms: Sequence[Term],
    crossed: Term | None = None, most: int = 3000,
) -> Fit:  # fmt: skip
    """Fit y (N,) on x (N, p) of full rank, with `person` (N,) codes 0 … n − 1.

    `crossed`: a term whose parts everybody meets; its covariance is the last of the fit's. `most`:
    evaluations of the deviance from each start; a fit that needs more has not converged. Raises
    numpy's LinAlgError where the data leave nothing to fit.
    """
    from scipy.optimize import minimize  # half a second of import

    wide = x if crossed is None else np.column_stack([x, _spread(crossed)])
    sums = _sums(y, wide, person, terms)
    nested, terms = len(terms), [*terms, *([] if crossed is None else [crossed])]
    sizes = [t.size for t in terms]
    bounds = [(0.0 if i == j else None, None) for q in sizes for i, j in _places(q)]
    best = None
    # TNC, for scipy's L-BFGS-B spends a hundred times as long in waking threads for tiny matrices
    for start in STARTS:
        theta = np.concatenate([[start * (i == j) for i, j in _places(q)] for q in sizes])
        found = minimize(
            lambda t: _deviance(sums, terms, nested, t)[:2],
            theta,
            jac=True,
            method="TNC",
            bounds=bounds,
            options={"ftol": 0.0, "xtol": 0.0, "gtol": 1e-9, "maxfun": most},
        )
        if best is None or found.fun < best.fun - 1e-9:
            best = found
    assert best is not None
    deviance, slope, s2, information, beta = _deviance(sums, terms, nested, best.x)
    at_end = np.array([b[0] == 0.0 for b in bounds]) & (best.x < SINGULAR)
    steep = np.where(at_end, np.minimum(slope, 0.0), slope)
    factors = _factors(best.x, sizes)
    fixed = x.shape[1]
    return Fit(
        beta[:fixed],
        np.sqrt(s2 * np.diag(np.linalg.inv(information)))[:fixed],
        float(np.sqrt(s2)),
        tuple(s2 * f @ f.T for f in factors),
        deviance,
        bool(np.max(np.abs(steep)) < FLAT * max(1.0, len(y) / 1000)),
        tuple(bool(np.min(np.abs(np.diag(f))) < SINGULAR) for f in factors),
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


def _spread(term: Term) -> Array:
    """A term's columns, each part's in places of its own: (N, parts · q)."""
    z = np.zeros((len(term.part), term.parts, term.size))
    z[np.arange(len(z)), term.part] = term.columns
    return z.reshape(len(z), -1)


def _sums(y: Array, x: Array, person: NDArray[np.intp], terms: Sequence[Term]) -> _Sums:
    z = np.column_stack([_spread(term) for term in terms])
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
    sums: _Sums, terms: Sequence[Term], nested: int, theta: Array
) -> tuple[float, Array, float, Array, Array]:
    """Restricted deviance, its gradient over θ, σ², Xᵀ V⁻¹ X and β.

    V = I + ZΛΛᵀZᵀ = σ⁻² cov(y). With A = I + ΛᵀZᵀZΛ: V⁻¹ = I − ZΛA⁻¹ΛᵀZᵀ and |V| = |A|. The
    gradient is tr(P dV) − yᵀP dV P y / σ², P = V⁻¹ − V⁻¹X(XᵀV⁻¹X)⁻¹XᵀV⁻¹.

    Terms from `nested` on are crossed: their ZΛ stand beside X as columns with a penalty of 1, Z in
    `sums` beside X. V is then that of the nested terms alone: P, |V||XᵀV⁻¹X| and yᵀPy stay what
    they are of all terms. XᵀV⁻¹X and β have the crossed effects behind the fixed ones.
    """
    factors = _factors(theta, [t.size for t in terms])
    blocks = [[f] * t.parts for f, t in zip(factors, terms, strict=True)]
    whole = _block_diagonal([f for own in blocks[:nested] for f in own])
    across = _block_diagonal([f for own in blocks[nested:] for f in own])
    fixed = sums.xx.shape[0] - len(across)
    scale = _block_diagonal([np.eye(fixed), across])
    zx, xx, xy = sums.zx @ scale, scale.T @ sums.xx @ scale, scale.T @ sums.xy
    inner = np.eye(len(whole)) + whole.T @ sums.zz @ whole
    log_v = float(np.sum(np.linalg.slogdet(inner)[1]))
    back = whole @ np.linalg.solve(inner, np.broadcast_to(whole.T, inner.shape))  # ΛA⁻¹Λᵀ
    left = np.swapaxes(zx, 1, 2) @ back
    penalty = np.diag(np.repeat([0.0, 1.0], [fixed, len(across)]))
    information = xx + penalty - (left @ zx).sum(axis=0)
    xvy = xy - (left @ sums.zy[..., None])[..., 0].sum(axis=0)
    yvy = sums.yy - float(np.einsum("ni,nij,nj->", sums.zy, back, sums.zy))
    beta = np.linalg.solve(information, xvy)
    free = sums.rows - fixed
    s2 = (yvy - float(xvy @ beta)) / free
    if not s2 > 0:
        raise np.linalg.LinAlgError("nothing is left to explain")
    log_x = float(np.linalg.slogdet(information)[1])
    deviance = log_v + log_x + free * (1 + np.log(2 * np.pi * s2))
    # Zᵀ V⁻¹ of Z, X and y − Xβ
    inverse = np.linalg.inv(information)
    zvz = sums.zz - sums.zz @ back @ sums.zz
    zvx = zx - sums.zz @ back @ zx
    rest = sums.zy - zx @ beta
    score = rest - (sums.zz @ back @ rest[..., None])[..., 0]
    zpz = zvz - zvx @ inverse @ np.swapaxes(zvx, 1, 2)
    pull = zpz.sum(axis=0) - np.einsum("ni,nj->ij", score, score) / s2
    slope = _gather(2 * pull @ whole, terms[:nested])
    if len(across):  # Zᵀ P Z = Zᵀ V⁻¹ Z − …, of the crossed columns as they stand in `sums`
        wvu = (sums.xx @ scale - (np.swapaxes(sums.zx, 1, 2) @ back @ zx).sum(axis=0))[fixed:]
        wvw = sums.xx - (np.swapaxes(sums.zx, 1, 2) @ back @ sums.zx).sum(axis=0)
        wvy = sums.xy - (np.swapaxes(sums.zx, 1, 2) @ back @ sums.zy[..., None])[..., 0].sum(axis=0)
        score = wvy[fixed:] - wvu @ beta
        pull = wvw[fixed:, fixed:] - wvu @ inverse @ wvu.T - np.outer(score, score) / s2
        slope = np.concatenate([slope, _gather(2 * pull @ across, terms[nested:])])
    return deviance, slope, s2, information, beta


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
