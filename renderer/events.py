"""What a participant does, as values. A window, a replay and a simulated participant send the same.

An event happened at `time`, or up to `within` seconds later where that cannot be known.
Positions are in view units: the origin is the upper left corner of the view, y points down and
runs from 0 to 1, x from 0 to the aspect ratio. Times are seconds on the session's clock.
Keys are lower-case names: "a"…"z", "0"…"9", "left", "right", "up", "down", "enter", "space",
"backspace", "escape", "tab", "f1", "f2".
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PointerMove:
    """The pointer moved by (dx, dy) to (x, y); `dragging` while the left button is down."""

    time: float
    x: float
    y: float
    dx: float
    dy: float
    dragging: bool = False
    within: float = 0.0


@dataclass(frozen=True)
class _AtPointer:
    """A button of the pointer went up or down at (x, y)."""

    time: float
    x: float
    y: float
    within: float = 0.0


@dataclass(frozen=True)
class PointerPress(_AtPointer):
    """The left button went down. `thing` as in `KeyPress`."""

    thing: int | None = None


class PointerRelease(_AtPointer):
    """The left button went up."""


class SecondPress(_AtPointer):
    """The right button went down. Only techniques that say so take it."""


class SecondRelease(_AtPointer):
    """The right button went up."""


@dataclass(frozen=True)
class Wheel:
    """The wheel turned at (x, y) by `dy` steps, away from the user above 0. Only techniques that
    say so take it."""

    time: float
    x: float
    y: float
    dy: float
    within: float = 0.0


@dataclass(frozen=True)
class KeyPress:
    """A key went down.

    `thing`, of enter and space: the index of the object that shows where the view's aim is, −1 for
    none. None where the view tells nobody (tasks/kit/base.py).
    """

    time: float
    key: str
    within: float = 0.0
    thing: int | None = None


@dataclass(frozen=True)
class KeyRelease:
    """A key went up."""

    time: float
    key: str
    within: float = 0.0


@dataclass(frozen=True)
class FocusChange:
    """The window lost (`focused` false) or regained the desktop's focus. Tasks ignore it."""

    time: float
    focused: bool
    within: float = 0.0


@dataclass(frozen=True)
class Tick:
    """Time went on: sent before each frame, so that held keys move the viewer."""

    time: float


Event = (
    PointerMove
    | PointerPress
    | PointerRelease
    | SecondPress
    | SecondRelease
    | Wheel
    | KeyPress
    | KeyRelease
    | FocusChange
    | Tick
)


def taken_as(event: Event) -> str:
    """An event as techniques and tasks name what they take: "pointer", "wheel", "second button" or
    "key:q"; "" for what nobody can take."""
    match event:
        case KeyPress() | KeyRelease():
            return f"key:{event.key}"
        case Wheel():
            return "wheel"
        case SecondPress() | SecondRelease():
            return "second button"
        case PointerMove() | PointerPress() | PointerRelease():
            return "pointer"
        case FocusChange() | Tick():
            return ""
