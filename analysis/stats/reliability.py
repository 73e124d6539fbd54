"""How well items of one scale go together: Cronbach's α and McDonald's ω of one factor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.undefined import Interval, Number, Undefined, no_interval

Array = NDArray[np.float64]

LEAST_ITEMS = 3
"""Of two items there is no factor to fit, and α is a correlation."""
LEAST_OWN = 0.005
"""Of an item's variance, what is its own at least, as R's factanal has it."""
APART = "fewer than three items have anything in common"
MOST_OWN = 0.99
"""An item with more has nothing in common with others. Of two items that have, nobody can tell how
much of it is whose: the likelihood is flat."""
SUM = "an item is the sum of others"
TOO_FEW = "no more participants than items"
HEYWOOD = "an item seems to have no variance of its own"


@dataclass(frozen=True, slots=True)
class Reliability:
    """α with Feldt's interval, and ω; of `n` people and `k` items."""

    n: int
    k: int
    alpha: Number
    interval: Interval
    omega: Number


def reliability(items: Array, level: float = 0.95) -> Reliability:
    """Of (n, k ≥ 3) answers, all turned to one direction and finite."""
    n, k = items.shape
    alpha, interval = cronbach(items, level)
    omega = alpha if isinstance(alpha, Undefined) else _omega(_covariances(items), n)
    return Reliability(n, k, alpha, interval, omega)


def cronbach(items: Array, level: float = 0.95) -> tuple[Number, Interval]:
    """α with Feldt's interval, of (n, k ≥ 3) answers."""
    n, k = items.shape
    why = "fewer than three items" if k < LEAST_ITEMS else ""
    why = why or ("fewer than three participants" if n < 3 else "")
    cov = _covariances(items) if not why else np.empty((0, 0))
    if not why and np.any(np.ptp(items, axis=0) == 0):
        why = "everybody answers an item alike"
    if not why and cov.sum() <= 1e-12 * np.trace(cov):
        why = "the items' sum does not vary"
    if why:
        return Undefined(why), no_interval(why)
    alpha = float(k / (k - 1) * (1 - np.trace(cov) / cov.sum()))
    return alpha, _feldt(alpha, n, k, level)


def _covariances(items: Array) -> Array:
    return np.asarray(np.cov(items - items[:1], rowvar=False))


def _feldt(alpha: float, n: int, k: int, level: float) -> Interval:
    """Feldt 1965: (1 − α̂) / (1 − α) is distributed as F(n − 1, (n − 1)(k − 1))."""
    from scipy.special import fdtri

    tail = (1 - level) / 2
    df = (n - 1, (n - 1) * (k - 1))
    low, high = (1 - (1 - alpha) * float(fdtri(*df, p)) for p in (1 - tail, tail))
    return low, high


def _omega(cov: Array, n: int) -> Number:
    """Σλ² / (Σλ² + Σψ) of the one-factor model, fitted by maximum likelihood to `n` people's."""
    from scipy.optimize import minimize

    sd = np.sqrt(np.diag(cov))
    r = cov / np.outer(sd, sd)

    def loss(psi: Array) -> tuple[float, Array]:
        """What is left to explain beyond one factor, profiled over the loadings; its gradient."""
        root = np.sqrt(psi)
        values, vectors = np.linalg.eigh(r / np.outer(root, root))
        rest = np.maximum(values[:-1], 1e-300)
        load = root * vectors[:, -1] * np.sqrt(max(0.0, values[-1] - 1))
        gap = np.outer(load, load) + np.diag(psi) - r
        return float(np.sum(rest - np.log(rest) - 1)), np.diag(gap) / psi**2

    if np.linalg.matrix_rank(r, hermitian=True) < len(r):  # its likelihood has no bound
        return Undefined(TOO_FEW if n <= len(r) else SUM)
    start = (1 - 0.5 / len(r)) / np.diag(np.linalg.inv(r))
    found = min((minimize(loss, np.clip(s, LEAST_OWN, 1.0), jac=True, method="L-BFGS-B",
                     bounds=[(LEAST_OWN, 1.0)] * len(r),
                     options={"ftol": 1e-15, "gtol": 1e-10})
                 for s in (start, np.full(len(r), 0.2), np.full(len(r), 0.8))),
                key=lambda end: float(end.fun))  # fmt: skip
    psi = found.x
    if np.any(psi <= LEAST_OWN * (1 + 1e-6)):
        return Undefined(HEYWOOD)
    if np.sum(psi < MOST_OWN) < LEAST_ITEMS:
        return Undefined(APART)
    root = np.sqrt(psi)
    values, vectors = np.linalg.eigh(r / np.outer(root, root))
    load = root * vectors[:, -1] * np.sqrt(max(0.0, values[-1] - 1))
    common = float(np.sum(sd * load)) ** 2
    return common / (common + float(np.sum(sd**2 * psi)))
