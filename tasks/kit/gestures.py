"""What hands do for a technique, as the events of a window."""

from __future__ import annotations

from collections.abc import Iterable

from seethrough.renderer.events import (
    Event,
    KeyPress,
    KeyRelease,
    PointerMove,
    SecondPress,
    SecondRelease,
    Wheel,
)
from seethrough.renderer.techniques.base import Gesture, Parameters, Shot


def events_of(gesture: Gesture, time: float, seconds: float) -> list[Event]:
    """The events of a gesture from a time on: each press and each step of the wheel takes so
    long."""
    x, y = gesture.place
    if gesture.event == "pointer":
        return [PointerMove(time, x, y, 0.0, 0.0)]
    found: list[Event] = []
    for k in range(abs(gesture.times)):
        at = time + k * seconds
        if gesture.event == "wheel":
            found.append(Wheel(at, x, y, 1.0 if gesture.times > 0 else -1.0))
        elif gesture.event == "second button":
            found += [SecondPress(at, x, y), SecondRelease(at + seconds / 2, x, y)]
        else:
            key = gesture.event.removeprefix("key:")
            found += [KeyPress(at, key), KeyRelease(at + seconds / 2, key)]
    return found


def after(p: Parameters, state: object, shot: Shot, gestures: Iterable[Gesture]) -> object:
    """A technique's state once hands have done all that."""
    for gesture in gestures:
        for event in events_of(gesture, 0.0, 0.0):
            state, _ = p.technique.on_event(p, state, event, shot)
    return state
