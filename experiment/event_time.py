"""When an input event happened, by the system's own stamp where there is one.

X11 stamps key, button and motion events with a 32-bit count of milliseconds of the clock that
`time.monotonic` reads. Elsewhere, and for stamps that make no sense, an event counts as having
happened when it was dispatched: up to one frame late.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

MOST_LAG = 1.0  # s; an event that claims to be older waited for the program, or another clock runs
WRAP = 2**32  # ms


class EventTime:
    """Translates stamps to the session's clock. `monotonic` in seconds, as the X server's."""

    def __init__(
        self, now: Callable[[], float], monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._now = now
        self._monotonic = monotonic
        self.stamp: int | None = None  # ms, of the event being dispatched

    def time(self) -> float:
        """The time of the event being dispatched, on the session's clock, in seconds."""
        now = self._now()
        if self.stamp is not None:
            lag = ((round(self._monotonic() * 1000) - self.stamp) % WRAP) / 1000
            if lag <= MOST_LAG:
                return now - lag
        return now


# X11's numbers of KeyPress, KeyRelease, ButtonPress, ButtonRelease and MotionNotify.
_X11_KEYS, _X11_BUTTONS, _X11_MOTION = (2, 3), (4, 5), 6


def x11_stamp(event: Any) -> int | None:
    """Milliseconds, or None for an event that carries no time."""
    if event.type in _X11_KEYS:
        return int(event.xkey.time)
    if event.type in _X11_BUTTONS:
        return int(event.xbutton.time)
    return int(event.xmotion.time) if event.type == _X11_MOTION else None
