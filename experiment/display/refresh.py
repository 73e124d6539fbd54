"""The display's refresh rate, measured from the times of flips that wait for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

FREE = 1000.0  # Hz; no display is as fast: the flips do not wait
EVEN, MOST = 0.25, 0.8  # so near to whole periods are so many of the intervals, where flips wait
NEAR = 0.05  # of the declared rate


def rate_of(flips: Sequence[float]) -> float | None:
    """Hz, from the times (s) of flips with next to nothing drawn; None where flips do not wait.

    A flip may come late, but it waits for a retrace: each interval is a number of whole periods.
    Flips that wait for nothing are fast, or, where other programs hold them up, far from even.
    """
    took = np.diff(np.asarray(flips, dtype=np.float64))
    typical = float(np.median(took)) if len(took) else 0.0
    if typical * FREE <= 1.0:
        return None
    periods = np.maximum(np.rint(took / typical), 1.0)
    even = np.abs(took / typical - periods) < EVEN
    return float(periods.sum() / took.sum()) if even.mean() >= MOST else None


def fits(rate: float | None, declared: float) -> bool:
    """Whether a measured rate is the declared one, or none that could differ from it."""
    return rate is None or abs(rate - declared) < NEAR * declared


def said(rate: float | None, declared: float) -> str:
    """What the experimenter is told of it."""
    if rate is None:
        return "the display does not wait; frames are paced by a timer"
    word = "as declared" if fits(rate, declared) else "NOT AS DECLARED"
    return f"{rate:.1f} Hz measured, {declared:g} declared: {word}"
