"""Short names for arrays' types; shapes stand in the docstrings."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Floats32: TypeAlias = NDArray[np.float32]
Real: TypeAlias = NDArray[np.floating]  # of either size
Ints: TypeAlias = NDArray[np.int64]
Ints32: TypeAlias = NDArray[np.int32]
Whole: TypeAlias = NDArray[np.integer]  # of any size
Bools: TypeAlias = NDArray[np.bool_]
Signs: TypeAlias = NDArray[np.int8]  # −1, 0, 1
Bytes: TypeAlias = NDArray[np.uint8]
Numbers: TypeAlias = NDArray[np.number]  # of any kind
Bits: TypeAlias = NDArray[np.uint64]  # sets of numbers below 64
