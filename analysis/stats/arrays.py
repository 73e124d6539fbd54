"""The short name of arrays' type, whose shapes stand in docstrings; and the mean of one."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]


def mean_of(x: Array) -> float:
    """The mean of (n,) values, n ≥ 1, with the rounding of the first pass taken out."""
    first = x.mean()
    return float(first + (x - first).mean())
