"""Typing a number: with the keyboard, or with buttons on the view."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from seethrough.renderer.events import Event, KeyPress, PointerPress, PointerRelease
from seethrough.tasks.kit.hud import Button, Element, Entry, Label, Rect, hint

KEYS = ("7", "8", "9", "4", "5", "6", "1", "2", "3", "backspace", "0", "enter")
MOST_DIGITS = 4
SIZE, GAP, EDGE = 0.055, 0.006, 0.02


@dataclass(frozen=True)
class NumberEntry:
    """What has been typed, and whether it has been confirmed. `aspect` places the buttons.

    `pressed` says that the pointer went down on a button, so that its moves until it comes up
    are no drag. `hint` says why the last key did nothing.
    """

    aspect: float
    text: str = ""
    confirmed: bool = False
    pressed: bool = False
    hint: str = ""

    def on_event(self, event: Event) -> NumberEntry:
        """Digits, backspace and enter, typed or clicked. An empty entry can't be confirmed."""
        if self.confirmed:
            return self
        if isinstance(event, PointerPress):
            hit = next((k for k, rect in self.buttons() if rect.contains(event.x, event.y)), None)
            return replace(self.type(hit), pressed=True) if hit else self
        if isinstance(event, PointerRelease):
            return replace(self, pressed=False)
        return self.type(event.key) if isinstance(event, KeyPress) else self

    def type(self, key: str) -> NumberEntry:
        """The entry after one key; keys that mean nothing to it leave it as it is."""
        if key == "enter":
            return replace(self, confirmed=bool(self.text), hint="" if self.text else "hint.number")
        if key == "backspace":
            return replace(self, text=self.text[:-1], hint="")
        if len(key) != 1:
            return self
        if key not in "0123456789":
            return replace(self, hint="hint.digits")
        if len(self.text) == MOST_DIGITS:
            return replace(self, hint="hint.long")
        return replace(self, text=(self.text + key).lstrip("0") or "0", hint="")

    def buttons(self) -> tuple[tuple[str, Rect], ...]:
        """Each key's name and place: three columns in the lower right corner of the view."""
        return _buttons(self.aspect)

    def field(self) -> Entry:
        """The typed number."""
        return _field(self.aspect, self.text)

    def notes(self) -> tuple[Label, ...]:
        """What is missing, if anything, above the typed number."""
        if not self.hint:
            return ()
        top = self.field().rect.y
        return (hint(self.hint, (self.aspect, top), (("most", str(MOST_DIGITS)),)),)

    def elements(self) -> tuple[Element, ...]:
        """The typed number above its buttons."""
        return (self.field(), *_labelled(self.aspect), *self.notes())


@lru_cache(maxsize=8)
def _labelled(aspect: float) -> tuple[Button, ...]:
    texts = {"backspace": "button.backspace", "enter": "button.confirm"}
    return tuple(Button(texts.get(key, key), rect) for key, rect in _buttons(aspect))


@lru_cache(maxsize=64)
def _field(aspect: float, text: str) -> Entry:
    first = _buttons(aspect)[0][1]
    return Entry(text, Rect(first.x, first.y - SIZE - GAP, 3 * SIZE + 2 * GAP, SIZE))


@lru_cache(maxsize=8)
def _buttons(aspect: float) -> tuple[tuple[str, Rect], ...]:
    left = aspect - EDGE - 3 * SIZE - 2 * GAP
    top = 1 - EDGE - 4 * SIZE - 3 * GAP
    step = SIZE + GAP
    return tuple(
        (key, Rect(left + i % 3 * step, top + i // 3 * step, SIZE, SIZE))
        for i, key in enumerate(KEYS)
    )
