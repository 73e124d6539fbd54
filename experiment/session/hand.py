"""What events make of a technique in a trial: it sees them first, and may use them up.

The same in a session and in its replay, so that a frame follows from the log alone.
"""

from __future__ import annotations

from dataclasses import replace

from seethrough.renderer.look.look import PLAIN, Look
from seethrough.renderer.techniques.base import Own, Shot
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.events import Event, KeyPress, KeyRelease, PointerMove, Wheel

HEIGHT = 1000  # of the shot that events are told in: positions are in view units


class Hand:
    """Keeps the state of a trial's technique (its parameters), from the first event on, and has the
    trial's look."""

    def __init__(self, technique: Own, aspect: float, look: Look = PLAIN) -> None:
        self._technique, self._rules, self._look = technique, technique.technique, look
        self._size = (round(aspect * HEIGHT), HEIGHT)
        self.state = self._rules.begin(technique)

    def takes(self, event: Event) -> bool:
        """Whether the technique may use up such an event."""
        return kind_of(event) in self._rules.takes

    def shown(self, view: View) -> View:
        """A task's view as it looks, with the technique's state."""
        view = view.dressed(self._look)
        return view if self.state is None else replace(view, drawn=self.state)

    def on_event(self, event: Event, view: View) -> bool:
        """Let the technique see an event, with what the frame shows. Whether it used it up."""
        if self.state is None or not self.takes(event):
            return False
        if view.captured and isinstance(event, PointerMove):
            # The pointer turns the viewer: what follows it sits in the middle of the view.
            event = replace(event, x=self._size[0] / HEIGHT / 2, y=0.5)
        shot = Shot(view.scene, view.camera, self._size)
        self.state, used = self._rules.on_event(self._technique, self.state, event, shot)
        return bool(used)


def kind_of(event: Event) -> str:
    """An event as techniques name what they take: "pointer", "wheel", "second button", "key:q"."""
    if isinstance(event, KeyPress | KeyRelease):
        return f"key:{event.key}"
    if isinstance(event, Wheel):
        return "wheel"
    name = type(event).__name__
    if name.startswith("Second"):
        return "second button"
    return "pointer" if name.startswith("Pointer") else name.lower()
