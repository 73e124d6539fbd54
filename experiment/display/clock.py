"""The session's clock, as an argument: real, or simulated so that 40 seconds need not take 40."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

FRAME = 1 / 60  # s, of a display's usual frame


class Clock(Protocol):
    """Monotonic seconds from an arbitrary start."""

    def now(self) -> float:
        """The time."""


class RealClock:
    """The machine's monotonic clock: never set back. `speed` > 1 only to watch what was played."""

    def __init__(self, speed: float = 1.0) -> None:
        self.speed = speed

    def now(self) -> float:
        """Seconds since an arbitrary start."""
        return time.perf_counter() * self.speed


class WatchClock(RealClock):
    """Goes up to `speed` times as fast as the machine's: what a slow machine is late by is not
    multiplied, or a simulated participant's session would be over before it was played."""

    def __init__(self, speed: float, real: Callable[[], float] = time.perf_counter) -> None:
        super().__init__(speed)
        self._real = real
        self._read = real()
        self._now = 0.0

    def now(self) -> float:
        """Seconds since an arbitrary start: since the last reading no more than a frame's."""
        read = self._real()
        self._now += self.speed * min(read - self._read, FRAME)
        self._read = read
        return self._now


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
