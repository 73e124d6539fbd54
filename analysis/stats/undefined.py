"""A quantity that does not exist says why, instead of becoming NaN, inf or an invented number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real
from typing import TypeGuard

import numpy as np
from numpy.typing import NDArray

EPS = float(np.finfo(np.float64).eps)

ALL_EQUAL = "all differences are equal"
ONE_PARTICIPANT = "fewer than two participants"


@dataclass(frozen=True, slots=True)
class Undefined:
    """In place of a number; `str()` is what reports and tables show."""

    reason: str

    def __str__(self) -> str:
        return f"undefined: {self.reason}"


Number = float | Undefined
Interval = tuple[Number, Number]


def is_defined(value: object) -> TypeGuard[float]:
    """Whether `value` is a number (not `Undefined`)."""
    return not isinstance(value, Undefined)


def number_in(row: Mapping[str, object], name: str) -> float:
    """A number that a row of a table is known to have. Raises TypeError for anything else."""
    found = row[name]
    if not isinstance(found, Real):
        raise TypeError(f"{name} = {found!r}, expected a number")
    return float(found)


def either_in(row: Mapping[str, object], name: str) -> Number:
    """A number of a row, or why there is none. Raises TypeError for anything else."""
    found = row[name]
    return found if isinstance(found, Undefined) else number_in(row, name)


def no_interval(reason: str) -> Interval:
    """An interval neither end of which exists."""
    return Undefined(reason), Undefined(reason)


def spread_is_noise(scores: NDArray[np.float64], scale: float) -> bool:
    """Whether the scores' spread is no more than the rounding of the values they were made from.

    A stored value is off by up to eps/2 · |value|, a mean over trials by as much again, so a
    difference of two is off by at most 2 · eps · `scale`, the largest absolute value. A larger
    threshold would call unit variance at an offset of 10¹⁵ noise; a smaller one would make
    F = 10²⁹ from a constant difference of 0.1.

    `scores`: (n,) or (n, q), q contrasts of unit weight; the largest spread decides.
    """
    if len(scores) < 2:
        return True
    spread = np.sqrt(np.mean((scores - scores[0] - (scores - scores[0]).mean(axis=0)) ** 2, axis=0))
    return bool(np.max(spread) <= 2 * EPS * scale)
