"""What events make of a technique in a trial: it sees them first, and may use them up.

The same in a session and in its replay, so that a frame follows from the log alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from seethrough.experiment.session.strangers import Made, called
from seethrough.renderer.events import (
    Event,
    KeyPress,
    PointerMove,
    PointerPress,
    taken_as,
)
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.techniques.base import Parameters, Shot
from seethrough.tasks.kit.base import View

HEIGHT = 1000  # of the shot that events are told in: positions are in view units
PICKED = 600  # of the picture in which is looked what a click hits,
COARSE = 300  # and where a technique's rule has to see all targets for it
AIMING = ("enter", "space")  # keys that click where the view aims


class Hand:
    """Keeps the state of a trial's technique (its parameters), from the first event on, and has the
    trial's look."""

    def __init__(
        self, technique: Parameters, aspect: float, look: Look = PLAIN, window: int = HEIGHT
    ) -> None:
        """`window`: how many pixels high the window is that the study is made for."""
        self._technique, self._rules, self._look = technique, technique.technique, look
        self._window = window
        self._size = (round(aspect * HEIGHT), HEIGHT)
        self.state = self._its("begin", partial(self._rules.begin, technique))

    def _its(self, what: str, call: Callable[[], Made]) -> Made:
        """What a call of the technique's gives. Raises PluginFailed where it is a stranger's."""
        return called("technique", self._rules.name, what, call)

    def takes(self, event: Event) -> bool:
        """Whether the technique may use up such an event."""
        return taken_as(event) in self._rules.takes

    def shown(self, view: View) -> View:
        """A task's view as it looks, with the technique's state."""
        view = view.dressed(self._look)
        return view if self.state is None else replace(view, drawn=self.state)

    def pointed(self, event: Event, view: View) -> Event:
        """The event, told what it hits in the frame, where the view wants to know: a press where it
        is, enter and space where the view aims."""
        if view.aim is None:
            return event
        if isinstance(event, PointerPress):
            return replace(event, thing=self._thing(view, (event.x, event.y)))
        if isinstance(event, KeyPress) and event.key in AIMING:
            return replace(event, thing=self._thing(view, view.aim))
        return event

    def _thing(self, view: View, place: tuple[float, float]) -> int:
        from seethrough.renderer.reference.pointed import is_local, pointed  # only for clicks

        (width, height), high = self._size, PICKED if is_local(self._technique) else COARSE
        size = (round(width * high / height), high)
        shot = Shot(view.scene, view.camera, size, high / self._window)
        seen = partial(pointed, shot, self._technique, self.state, place)
        return self._its("rule", seen)

    def on_event(self, event: Event, view: View) -> bool:
        """Let the technique see an event, with what the frame shows. Whether it used it up."""
        if self.state is None or not self.takes(event):
            return False
        if view.captured and isinstance(event, PointerMove):
            # The pointer turns the viewer: what follows it sits in the middle of the view.
            event = replace(event, x=self._size[0] / HEIGHT / 2, y=0.5)
        shot = Shot(view.scene, view.camera, self._size)
        told = partial(self._rules.on_event, self._technique, self.state, event, shot)
        self.state, used = self._its("on_event", lambda: _pair(told()))
        return used


def _pair(found: tuple[Made, object]) -> tuple[Made, bool]:
    """The next state, and whether the event was used up."""
    state, used = found
    return state, bool(used)
