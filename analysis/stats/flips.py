"""The sign-flip test: a contrast's p without assuming normal scores, only symmetric ones."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.ties import STEPS
from seethrough.analysis.stats.undefined import (
    ALL_EQUAL,
    EPS,
    ONE_PARTICIPANT,
    Number,
    Undefined,
    spread_is_noise,
)

MOST_EXACT = 18
"""People up to whom all 2ⁿ signs are tried."""
DRAWS = 20_000
FAR = 3.0
"""Robust standard deviations from the median beyond which a score counts as an outlier."""


def sign_flip(scores: Array, rng: Generator, scale: float | None = None) -> tuple[Number, str]:
    """P of a mean as far from 0 when each score's sign is a coin's, and how it was found.

    All signs are tried up to `MOST_EXACT` people; more are drawn, the observed one counted in.
    `scale`: the largest absolute value that the scores were made from, which bounds their rounding;
    the scores' own by default. Means as far from 0 up to it are as far.
    """
    n = len(scores)
    if n < 2:
        return Undefined(ONE_PARTICIPANT), ""
    largest = float(np.max(np.abs(scores)))
    scale = largest if scale is None else scale
    if largest <= STEPS * EPS * scale or (spread_is_noise(scores, scale) and n < 3):
        return Undefined(ALL_EQUAL), ""
    unit = scores / largest  # sums of squares neither overflow nor vanish
    observed = abs(float(unit.sum()))
    room = n * STEPS * EPS * max(1.0, scale / largest)
    if n <= MOST_EXACT:
        sums = np.zeros(1)
        for value in unit:
            sums = np.concatenate([sums + value, sums - value])
        return float(np.mean(np.abs(sums) >= observed - room)), "exact"
    hits, step = 0, max(1, int(4e6 / n))
    for start in range(0, DRAWS, step):
        signs = rng.integers(0, 2, (min(step, DRAWS - start), n)) * 2 - 1
        hits += int(np.sum(np.abs(signs @ unit) >= observed - room))
    return (hits + 1) / (DRAWS + 1), f"{DRAWS} draws"


def outliers(scores: Array, scale: float | None = None) -> NDArray[np.bool_]:
    """Scores more than `FAR` robust standard deviations (1.4826 · MAD) from the median.

    `scale`: the largest absolute value that the scores were made from, which bounds their rounding:
    where half of them are equal up to it, nothing is far.
    """
    gap = np.abs(scores - np.median(scores))
    spread = 1.4826 * float(np.median(gap))
    top = float(np.max(np.abs(scores), initial=0.0)) if scale is None else scale
    if spread <= STEPS * EPS * top:
        return np.zeros(len(scores), dtype=bool)
    return np.asarray(gap > FAR * spread)
