"""When an input event happened, as far as it can be known.

X11 stamps key, button and motion events with a 32-bit count of milliseconds of its own clock. Where
that is the clock that `time.monotonic` reads, a stamp is trusted whatever its age: a program that
stood still for five seconds finds events that are five seconds old. Where there is no stamp, or one
that cannot be believed, the event happened between the moment up to which the queue was known to be
empty and its dispatch. A time is always the earliest possible one, and comes with how much later it
may have been: no event gets a time later than it happened.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import ceil, inf
from typing import Protocol

WRAP = 2**32  # ms
# s: a stamp is cut to whole milliseconds, of a clock that some servers read once a millisecond.
RESOLUTION = 0.002
READINGS = 5  # of both clocks, for one pair without a pause of the program between them
CLOSE = 0.0005  # s between the readings of such a pair


class EventTime:
    """Translates stamps to the session's clock. `monotonic` in seconds, as the X server's.

    `trusted` says whether the server's clock is ours (`agrees`); until that is known, no stamp is
    believed.
    """

    def __init__(
        self, now: Callable[[], float], monotonic: Callable[[], float] = time.monotonic
    ) -> None:
        self._now = now
        self._monotonic = monotonic
        self.trusted = False
        self.stamp: int | None = None  # ms, of the event being dispatched
        self.queue = ""  # that it came from: the system keeps order within one
        self._empty = now()  # everything that happened before was dispatched
        self._latest: dict[str, float] = {}

    def drained(self, before: float) -> None:
        """What happened before this time (session's clock, s) has been dispatched."""
        self._empty = max(self._empty, before)
        self._latest.clear()

    def agrees(self, stamp: int | None, before: float, after: float) -> None:
        """Whether a stamp that the server made between two readings of `monotonic` says so."""
        self.trusted = stamp is not None and (
            (stamp - int(before * 1000) + 2) % WRAP <= ceil((after - before) * 1000) + 4
        )

    def moment(self) -> tuple[float, float]:
        """(time, within) of the event being dispatched: it happened in [time, time + within].

        On the session's clock, in seconds.
        """
        before, monotonic, after = self._readings()
        earliest = max(self._empty, self._latest.get(self.queue, -inf))
        if self.stamp is not None and self.trusted:
            lag = ((monotonic * 1000 - self.stamp) % WRAP) / 1000
            if lag < WRAP / 2000:  # older than that is from the future: another clock's
                stamped = before - lag
                self._latest[self.queue] = max(earliest, stamped)
                return stamped, min(RESOLUTION + after - before, max(after - stamped, 0.0))
        return earliest, max(after - earliest, 0.0)

    def _readings(self) -> tuple[float, float, float]:
        """The session's clock, the server's, and the session's again, as close as they come."""
        best = (-inf, 0.0, inf)
        for _ in range(READINGS):
            found = self._now(), self._monotonic(), self._now()
            if found[2] - found[0] < best[2] - best[0]:
                best = found
            if best[2] - best[0] <= CLOSE:
                break
        return best


# X11's numbers of KeyPress, KeyRelease, ButtonPress, ButtonRelease and MotionNotify.
_X11_KEYS, _X11_BUTTONS, _X11_MOTION = (2, 3), (4, 5), 6


class _Any(Protocol):
    send_event: int


class _Timed(Protocol):
    time: int


class XEvent(Protocol):
    """One of X11's events, as pyglet has them: a union, of which `type` says what it is."""

    type: int
    xany: _Any
    xkey: _Timed
    xbutton: _Timed
    xmotion: _Timed


def x11_stamp(event: XEvent) -> int | None:
    """Milliseconds, or None for an event that carries no time of the server's.

    Another program may send events with any time it likes, and 0 stands for "now".
    """
    if event.xany.send_event:
        return None
    stamp = 0
    if event.type in _X11_KEYS:
        stamp = int(event.xkey.time)
    elif event.type in _X11_BUTTONS:
        stamp = int(event.xbutton.time)
    elif event.type == _X11_MOTION:
        stamp = int(event.xmotion.time)
    return stamp or None
