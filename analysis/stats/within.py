"""Least squares within participants: period, carry-over and the like, in balanced or gappy tables.

The participants' own levels are projected out (Frisch–Waugh), so that 10,000 of them cost no
10,000 columns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import f_tail
from seethrough.analysis.stats.undefined import EPS, Number, Undefined


@dataclass(frozen=True, slots=True)
class TermTest:
    """F for leaving a term out of a linear model."""

    name: str
    df1: int
    df2: int
    f: Number
    p: Number


def dummies(values: NDArray[np.generic]) -> Array:
    """One column per level but the first."""
    levels = np.unique(values)
    columns: Array = (values[:, None] == levels[None, 1:]).astype(np.float64)
    return columns


def centre(values: Array, group: NDArray[np.intp]) -> Array:
    """Values less their group's mean; `values` (N,) or (N, q), `group` codes 0..g − 1."""
    columns = values.reshape(len(values), -1)
    counts = np.bincount(group)
    out = np.empty_like(columns)
    for j, column in enumerate(columns.T):
        shifted = column - column[0]
        out[:, j] = shifted - (np.bincount(group, weights=shifted) / counts)[group]
    return out.reshape(values.shape)


def term_tests(y: Array, group: NDArray[np.intp], terms: dict[str, Array]) -> list[TermTest]:
    """Test each term (columns (N, q)) given all the others and the groups' levels.

    Rows are observations, `group` their participant. A term that the others already explain, or a
    model that leaves no residual, is undefined and says so.
    """
    own = centre(y, group)
    parts = {name: centre(columns, group) for name, columns in terms.items()}
    full = np.concatenate(list(parts.values()), axis=1)
    groups = int(group.max()) + 1
    rank, residual = _fit(own, full)
    df2 = len(y) - groups - rank
    tests = []
    for name in parts:
        others = [c for n, c in parts.items() if n != name]
        rest = np.concatenate(others, axis=1) if others else np.zeros((len(y), 0))
        rank_rest, residual_rest = _fit(own, rest)
        df1 = rank - rank_rest
        reason = _reason(df1, df2, residual, float(np.max(np.abs(y), initial=0.0)))
        if reason:
            tests.append(TermTest(name, df1, df2, Undefined(reason), Undefined(reason)))
            continue
        f = max(0.0, (residual_rest - residual) / df1) / (residual / df2)
        tests.append(TermTest(name, df1, df2, f, f_tail(f, df1, df2)))
    return tests


def _reason(df1: int, df2: int, residual: float, scale: float) -> str:
    if df1 == 0:
        return "the design does not separate it from the other effects"
    if df2 <= 0:
        return "no degrees of freedom are left"
    if residual <= df2 * (2 * EPS * scale) ** 2:
        return "nothing is left to compare with"
    return ""


def _fit(y: Array, x: Array) -> tuple[int, float]:
    """Rank of x and the residual sum of squares of y on x."""
    if x.shape[1] == 0:
        return 0, float(y @ y)
    left, singular, _ = np.linalg.svd(x, full_matrices=False)
    keep = singular > singular[0] * max(x.shape) * EPS if singular[0] > 0 else singular > 0
    basis = left[:, keep]
    rest = y - basis @ (basis.T @ y)
    return int(keep.sum()), float(rest @ rest)


def one_way(y: Array, group: NDArray[np.generic]) -> TermTest:
    """Between-participant one-way ANOVA, e.g. of the sequences; y (n,)."""
    _, codes = np.unique(group, return_inverse=True)
    counts = np.bincount(codes)
    k, n = len(counts), len(y)
    if k < 2 or n <= k:
        why = Undefined("it needs two groups and more participants than groups")
        return TermTest("sequence", k - 1, n - k, why, why)
    inside = centre(y, codes)
    error = float(inside @ inside)
    total = y - y.mean()
    effect = float(total @ total) - error
    reason = _reason(k - 1, n - k, error, float(np.max(np.abs(y))))
    if reason:
        return TermTest("sequence", k - 1, n - k, Undefined(reason), Undefined(reason))
    f = max(0.0, effect / (k - 1)) / (error / (n - k))
    return TermTest("sequence", k - 1, n - k, f, f_tail(f, k - 1, n - k))
