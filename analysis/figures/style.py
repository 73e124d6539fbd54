"""What the figures share."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

INK = "#1f2328"
RULE = "#d0d7de"
FAINT = "#8c959f"
STANDARD = "#c2570c"
DYNAMIC = "#0b69b7"
LEVELS = ("standard", "dynamic")
COLOURS = {"standard": STANDARD, "dynamic": DYNAMIC}
SIDES = (-0.2, 0.2)
MOST_DOTS = 200


def picked(n: int) -> NDArray[np.intp]:
    """Which of n participants are drawn: all, or an even choice of `MOST_DOTS`."""
    return np.unique(np.linspace(0, n - 1, min(n, MOST_DOTS)).round().astype(np.intp))


def legend(axes: Any, **place: Any) -> None:
    """Colours of the two levels."""
    handles = [axes.bar(0, 0, color=COLOURS[level]) for level in LEVELS]
    axes.legend(handles, LEVELS, **place)
