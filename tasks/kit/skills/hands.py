"""Hands: turns, clicks and keys as the events a person would send, and the time they take."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import hypot, log2, pi

from seethrough.renderer.events import (
    Event,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.renderer.techniques.base import Gesture
from seethrough.tasks.kit.gestures import events_of
from seethrough.tasks.kit.hud import Rect
from seethrough.tasks.kit.skills.mood import Mood

MOVES = 6  # pointer events of one turn; a mouse sends ten times as many [ours]
GRIP = (0.5, 0.5)  # where the pointer takes hold of the view: no button lies there
HOLD = 0.08  # seconds a key or button stays down


class Hands:
    """Collects events at rising times; `take` hands them over."""

    def __init__(self, mood: Mood, now: float) -> None:
        self.mood = mood
        self.time = now
        self.gain = mood.profile.gain
        self.speed = mood.profile.speed
        self._events: list[Event] = []

    def take(self) -> list[Event]:
        """The events since the last call; at least one, so that time goes on."""
        events, self._events = self._events, []
        events.append(Tick(self.time))
        return events

    def wait(self, seconds: float) -> None:
        """Think: mental times go at the person's pace."""
        self.time += seconds * self.mood.pace

    def pause(self, seconds: float) -> None:
        """Let time pass that no pace changes."""
        self.time += seconds

    def key(self, name: str) -> None:
        """Type a key."""
        self.wait(self.mood.profile.key)
        self._events += [KeyPress(self.time, name), KeyRelease(self.time + HOLD, name)]
        self.time += HOLD

    def type(self, text: str) -> None:
        """Bring the hand to the keyboard, type, confirm."""
        self.wait(self.mood.profile.home + self.mood.profile.prepare)
        for name in [*text, "enter"]:
            self.key(name)

    def click(self, rect: Rect) -> None:
        """Point at the middle of something and click it."""
        self.click_at(rect.x + rect.width / 2, rect.y + rect.height / 2)

    def click_at(self, x: float, y: float) -> None:
        """Point and click."""
        self.wait(self.mood.profile.point)
        self._events.append(PointerMove(self.time, x, y, 0.0, 0.0))
        self._events.append(PointerPress(self.time, x, y))
        self.time += HOLD
        self._events.append(PointerRelease(self.time, x, y))

    def does(self, gesture: Gesture) -> None:
        """Work a technique: point, press a key, or turn the wheel notch by notch."""
        p = self.mood.profile
        self.wait(p.point if gesture.event == "pointer" else p.key)
        events = events_of(gesture, self.time, 2 * HOLD)
        self._events += events
        self.time = events[-1].time if events else self.time

    def turn(self, yaw: float, pitch: float = 0.0, drag: bool = False) -> None:
        """Turn by these angles with the mouse; see `turning`."""
        for _ in self.turning(yaw, pitch, drag):
            pass

    def turning(
        self, yaw: float, pitch: float = 0.0, drag: bool = False, parts: int = 1
    ) -> Iterator[bool]:
        """A turn at the person's pace; True once it has ended.

        Comes back after each of so many equal parts of the way, for a look in passing. `drag`
        holds the world (orbit); without, the pointer turns the walker.
        """
        p = self.mood.profile
        angle = hypot(yaw, pitch)
        if angle < 1e-9:
            return
        seconds = self.turn_seconds(angle) * self.mood.pace
        factor = 1.0
        if self.mood.uses("motor_noise"):
            factor += p.motor_noise * float(self.mood.rng.standard_normal())
        x, y = GRIP
        if drag:
            self._events.append(PointerPress(self.time, x, y))
        began, moves = self.time, -(-MOVES // parts) * parts
        dx = -yaw * factor / self.gain / moves
        dy = pitch * factor / self.gain / moves if drag else 0.0
        for move, share in enumerate(_reach(moves), start=1):
            x, y = x + dx, y + dy
            self.time = began + seconds * share
            self._events.append(PointerMove(self.time, x, y, dx, dy, drag))
            if move < moves and move % (moves // parts) == 0:
                yield False
        if drag:
            self._events.append(PointerRelease(self.time, x, y))
        yield True

    def turn_seconds(self, angle: float) -> float:
        """Seconds that a turn takes at the usual pace: its bits over bits per second."""
        p = self.mood.profile
        return log2(angle / p.tolerance + 1) / p.bits_per_second

    def walking(self, distance: float, parts: int = 1) -> Iterator[bool]:
        """Walk straight on, a key held for as long as it should take; see `turning`."""
        began, seconds = self.time, distance / self.speed
        self._events.append(KeyPress(began, "up"))
        for part in range(1, parts):
            self.time = began + seconds * part / parts
            yield False
        self.time = began + seconds
        self._events.append(KeyRelease(self.time, "up"))
        yield True


def learn_gain(hands: Hands, before: float, after: float, aimed: float) -> None:
    """Correct how much a drag turns, once its effect is seen to be far off."""
    turned = (after - before + pi) % (2 * pi) - pi
    if turned * aimed > 0 and not 0.7 < turned / aimed < 1.4:
        hands.gain *= turned / aimed


@cache
def _reach(moves: int) -> tuple[float, ...]:
    """After which share of its time a reach has come each of so many equal parts further."""
    return tuple(_reach_time(move / moves) for move in range(1, moves + 1))


def _reach_time(share: float) -> float:
    """Share of its time after which a reach has got that far (minimum jerk, Flash & Hogan 1985)."""
    if share > 0.5:
        return 1.0 - _reach_time(1.0 - share)  # its end is its beginning turned round
    low, high = 0.0, 1.0
    for _ in range(53):  # halves until no double lies between
        s = (low + high) / 2
        low, high = (s, high) if s**3 * (10 - 15 * s + 6 * s * s) < share else (low, s)
    return high
