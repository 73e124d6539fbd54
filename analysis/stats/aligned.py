"""Aligned ranks of a table of within factors (Wobbrock2011): an F of each effect, on ranks of what
is left of the data without all other effects."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.anova import Effect, repeated_measures
from seethrough.analysis.stats.ties import STEPS, levels
from seethrough.analysis.stats.undefined import EPS

Array = NDArray[np.float64]


def aligned_ranks(y: Array, factors: Sequence[str]) -> dict[str, Effect]:
    """Each effect of the ANOVA of its own aligned ranks; y: (n, k₁, …, k_m), finite."""
    found = {}
    size_of = float(np.max(np.abs(y), initial=0.0))
    axes = range(1, y.ndim)
    for size in range(1, len(factors) + 1):
        for inside in itertools.combinations(axes, size):
            name = " × ".join(factors[axis - 1] for axis in inside)
            found[name] = repeated_measures(_ranks(_aligned(y, inside), size_of), factors)[name]
    return found


def _aligned(y: Array, inside: tuple[int, ...]) -> Array:
    """What is left within the cells, and the estimated effect of the factors at `inside`."""
    cells = y.mean(axis=0, keepdims=True)
    effect = np.zeros_like(cells)
    for size in range(len(inside) + 1):
        for kept in itertools.combinations(inside, size):
            gone = tuple(axis for axis in range(1, y.ndim) if axis not in kept)
            effect = effect + (-1.0) ** (len(inside) - size) * cells.mean(axis=gone, keepdims=True)
    return np.asarray(y - cells + effect)


def _ranks(y: Array, size: float) -> Array:
    """Average ranks of all values; what is equal up to rounding is tied: each is a sum of means of
    values up to `size`."""
    flat = y.ravel()
    level = levels(flat, np.full(flat.shape, STEPS * EPS * size))
    count = np.bincount(level)
    return np.asarray((np.cumsum(count) - (count - 1) / 2)[level].reshape(y.shape))
