"""Analysis of variance with factors within and between people, groups of unequal size allowed.

Type III: each effect given all others, by sum coding. Within-person contrasts come first, so that
each stratum is an ordinary multivariate model of orthonormal scores on the groups.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.anova import Effect, contrast_scores, repeated_measures, tested
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.undefined import (
    ALL_EQUAL,
    EPS,
    Number,
    Undefined,
    no_interval,
)

Codes = NDArray[np.intp]

EMPTY = "a group has nobody"


def sum_coding(k: int) -> Array:
    """Sum contrasts of k levels, (k, k − 1): the last level is −1 throughout."""
    return np.vstack([np.eye(k - 1), -np.ones((1, k - 1))])


def split_plot(
    y: Array,
    within: Sequence[str],
    groups: Codes,
    between: Sequence[str],
    measured: Collection[str] = (),
) -> dict[str, Effect]:
    """All effects of the within factors, the between factors and both; names like `a × b`.

    `y`: (n, k₁, …, k_m), finite; `groups`: (n, b) level codes of each factor between people.
    `measured`: factors that nobody assigned; generalised η² counts what holds one as variance that
    would be there anyway. Raises ValueError for missing values or a cell of groups without people.
    """
    if y.ndim != len(within) + 1 or not np.all(np.isfinite(y)):
        raise ValueError("y must be finite with one axis per within factor after the participants")
    if groups.shape != (len(y), len(between)):
        raise ValueError("groups must have a row for each participant, a column for each factor")
    if not between:
        return repeated_measures(y, within)
    x, columns = _coded(groups)
    n, rank = x.shape
    if np.linalg.matrix_rank(x) < rank:
        raise ValueError(EMPTY)
    scale = float(np.max(np.abs(y), initial=0.0))
    parts = []
    inverse = np.linalg.inv(x.T @ x)
    for inside in _subsets(len(within)):
        scores = _scores(y, inside)
        beta = inverse @ x.T @ scores
        rest = scores - x @ beta
        rest = rest - x @ (inverse @ x.T @ rest)
        for effect, at in columns.items():
            if not inside and not effect:
                continue
            own = beta[at]
            ss = float(np.trace(own.T @ np.linalg.solve(inverse[np.ix_(at, at)], own)))
            name = " × ".join([*(between[b] for b in effect), *(within[w] for w in inside)])
            parts.append((name, effect, inside, ss, float(np.sum(rest**2)), rest, len(at)))
    errors = {inside: error for _, _, inside, _, error, _, _ in parts}
    observed = {between.index(name) for name in measured}
    found = {}
    for name, _, _, ss, error, rest, df in parts:
        others = sum(p[3] for p in parts if p[0] != name and observed & set(p[1]))
        total = ss + sum(errors.values()) + others
        ges: Number = ss / total if total > 0 else Undefined("nothing varies")
        found[name] = _effect(name, n, df, n - rank, (ss, error), rest, ges, scale)
    return found


def _subsets(count: int) -> Iterator[tuple[int, ...]]:
    """Every set of factors, the empty one first."""
    for size in range(count + 1):
        yield from itertools.combinations(range(count), size)


def _scores(y: Array, inside: tuple[int, ...]) -> Array:
    """Orthonormal scores (n, q) of the within factors `inside`; none: the person's own level."""
    if not inside:
        flat = y.reshape(len(y), -1)
        level = (flat - flat[0, 0]).sum(axis=1, keepdims=True)
        return np.asarray(level / np.sqrt(flat.shape[1]))
    scores, lengths = contrast_scores(y, inside)
    return np.asarray(scores / np.sqrt(lengths))


def _coded(groups: Codes) -> tuple[Array, dict[tuple[int, ...], list[int]]]:
    """The sum-coded design (n, r), and the columns of each effect of the between factors."""
    coded = [sum_coding(int(codes.max()) + 1)[codes] for codes in groups.T]
    blocks, columns, at = [], {}, 0
    for effect in _subsets(len(coded)):
        block = np.ones((len(groups), 1))
        for b in effect:
            block = np.einsum("ni,nj->nij", block, coded[b]).reshape(len(groups), -1)
        blocks.append(block)
        columns[effect] = list(range(at, at + block.shape[1]))
        at += block.shape[1]
    return np.concatenate(blocks, axis=1), columns


def _effect(
    name: str, n: int, rank: int, free: int, ss: tuple[float, float], rest: Array, ges: Number,
    scale: float,
) -> Effect:  # fmt: skip
    """One effect; undefined where no error is left to compare with."""
    q = rest.shape[1]
    why = "no degrees of freedom are left" if free < 1 else ""
    if not why and np.max(np.sqrt(np.mean(rest**2, axis=0))) <= 2 * EPS * scale:
        why = ALL_EQUAL
    if why:
        gone, ends = Undefined(why), no_interval(why)
        return Effect(
            name, n, q * rank, q * free, *ss, *(gone,) * 6, ges, gone, ends, gone, gone, gone, free
        )
    return tested(name, n, rank, free, ss, rest, ges)
