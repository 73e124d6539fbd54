"""The display's refresh rate, measured from the times of flips that wait for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

FREE = 1000.0  # Hz; no display is as fast: the flips do not wait
NEAR = 0.05  # of the declared rate


def rate_of(flips: Sequence[float]) -> float | None:
    """Hz, from the times (s) of flips with next to nothing drawn; None where flips do not wait.

    A flip may come late, but it waits for a retrace: each interval is a number of whole periods.
    """
    took = np.diff(np.asarray(flips, dtype=np.float64))
    typical = float(np.median(took)) if len(took) else 0.0
    if typical * FREE <= 1.0:
        return None
    periods = np.maximum(np.rint(took / typical), 1.0)
    return float(periods.sum() / took.sum())


def fits(rate: float | None, declared: float) -> bool:
    """Whether a measured rate is the declared one, or none that could differ from it."""
    return rate is None or abs(rate - declared) < NEAR * declared


def said(rate: float | None, declared: float) -> str:
    """What the experimenter is told of it."""
    if rate is None:
        return "the display does not wait; frames are paced by a timer"
    word = "as declared" if fits(rate, declared) else "NOT AS DECLARED"
    return f"{rate:.1f} Hz measured, {declared:g} declared: {word}"
