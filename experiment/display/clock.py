"""The session's clock, as an argument: real, or simulated so that 40 seconds need not take 40."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """Monotonic seconds from an arbitrary start."""

    def now(self) -> float:
        """The time."""


class RealClock:
    """The machine's monotonic clock: never set back. `speed` > 1 only to watch a simulation."""

    def __init__(self, speed: float = 1.0) -> None:
        self.speed = speed

    def now(self) -> float:
        """Seconds since an arbitrary start."""
        return time.perf_counter() * self.speed


class SimulatedClock:
    """Stands still until it is told what time it is."""

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        """The simulated time in seconds."""
        return self._now

    def advance(self, to: float) -> None:
        """Go on to time `to`. Raises ValueError if that lies in the past."""
        if to < self._now:
            raise ValueError(f"to = {to}, expected at least the time now, {self._now}")
        self._now = to
