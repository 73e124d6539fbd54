"""Pointing at things: with the mouse, or with a cross that keys move.

A click is a press and a release at one place; a press that is dragged away turns the view. What a
click hits is what the frame showed under it (decisions/0018): the session tells the press.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot

from seethrough.renderer.events import (
    Event,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
)
from seethrough.tasks.kit.controls import changed
from seethrough.tasks.kit.hud import Element, Mark, Point
from seethrough.tasks.kit.world import keys

SLIP = 0.012  # view heights that the pointer may move while the button is down
RATE = 0.4  # view heights a second that keys move the cross
TAKES = keys(("a", "d", "w", "s", "enter", "space"))
STEPS = {"a": (-1, 0), "d": (1, 0), "w": (0, -1), "s": (0, 1)}


@dataclass(frozen=True)
class Clicking:
    """Where one points (`at`), in a view so wide for its height, and what has been clicked.

    `clicks` counts; `thing` is what the last one hit, its index, −1 for nothing. `keyed`: keys have
    moved the cross last, so that it is shown.
    """

    aspect: float
    at: Point
    clicks: int = 0
    thing: int = -1
    keyed: bool = False
    pressed: PointerPress | None = None
    held: frozenset[str] = frozenset()
    time: float | None = None

    def on_event(self, event: Event) -> Clicking:
        """What one points at and has clicked after `event`."""
        now = self._moved(event.time)
        if isinstance(event, KeyPress):
            if event.key in STEPS:
                return changed(now, held=now.held | {event.key}, keyed=True)
            clicked = event.key in ("enter", "space") and event.thing is not None
            return now._clicked(event.thing) if clicked else now
        if isinstance(event, KeyRelease):
            return changed(now, held=now.held - {event.key})
        if isinstance(event, PointerMove):
            at, start = (event.x, event.y), now.pressed
            away = start is not None and hypot(event.x - start.x, event.y - start.y) > SLIP
            return changed(now, at=at, keyed=False, pressed=None if away else start)
        if isinstance(event, PointerPress):
            return changed(now, at=(event.x, event.y), keyed=False, pressed=event)
        if isinstance(event, PointerRelease) and now.pressed is not None:
            return changed(now, pressed=None)._clicked(now.pressed.thing)
        return now

    def _clicked(self, thing: int | None) -> Clicking:
        return changed(self, clicks=self.clicks + 1, thing=-1 if thing is None else thing)

    def _moved(self, time: float) -> Clicking:
        """The cross where held keys have brought it by then, within the view."""
        before = time if self.time is None else self.time
        if not self.held or time <= before:
            return changed(self, time=max(time, before))
        way = RATE * (time - before)
        x = self.at[0] + way * sum(STEPS[key][0] for key in self.held)
        y = self.at[1] + way * sum(STEPS[key][1] for key in self.held)
        at = (min(max(x, 0.0), self.aspect), min(max(y, 0.0), 1.0))
        return changed(self, at=at, time=time)

    def elements(self) -> tuple[Element, ...]:
        """The cross, while keys move it."""
        return (Mark(self.at, 0.02, "cross"),) if self.keyed else ()


def of_free_pointer(event: Event) -> Event:
    """The event as a viewer takes it whose pointer is free: only drags turn."""
    if isinstance(event, PointerMove) and not event.dragging:
        return replace(event, dx=0.0, dy=0.0)
    return event


def clicking(aspect: float) -> Clicking:
    """In the middle of the view, nothing clicked."""
    return Clicking(aspect, (aspect / 2, 0.5))
