"""Looking around before anything is asked: the world of a task set, and nothing to do in it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from seethrough.renderer.events import Event, KeyPress, PointerPress
from seethrough.tasks.kit.base import Basics, Outcome, Setting, Task, View
from seethrough.tasks.kit.hud import MARGIN, Button, Label, Rect
from seethrough.tasks.kit.measure import Measure
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.kit.world import ANYWHERE, Place, Viewer, WorldParameters

WIDE, HIGH = 0.2, 0.055  # of the button, in view units


@dataclass(frozen=True, eq=False)
class Looking:
    """Where one is, and whether one has seen enough."""

    place: Place
    viewer: Viewer
    button: Button | None  # none where the pointer is captured, as walking has it
    enough: bool = False


def _enough(mood: Mood, glance: Glance) -> Play:
    """Simulated people need not look around: nothing of it would be kept."""
    hands = Hands(mood, glance.now)
    hands.key("enter")
    yield hands.take()


class Explore(Basics[Looking]):
    """Move as the world lets one move, until Enter or the button."""

    name, code, source = "explore", "", "ours"
    worlds: tuple[str, ...] = ANYWHERE
    measures: tuple[Measure, ...] = ()
    simulate = Strategy(_enough)

    def begin(self, made: Place, setting: Setting, aspect: float) -> Looking:
        """At the world's start."""
        rect = Rect(aspect - MARGIN - WIDE, 1 - MARGIN - HIGH, WIDE, HIGH)
        viewer = setting.world.viewer(made, setting.place, aspect)
        walks = setting.world.moving == "walk"
        return Looking(made, viewer, None if walks else Button("continue", rect))

    def on_event(self, state: Looking, event: Event) -> Looking:
        """Moving, or enough of it."""
        button = state.button
        clicked = (
            button is not None
            and isinstance(event, PointerPress)
            and button.rect.contains(event.x, event.y)
        )
        if clicked or (isinstance(event, KeyPress) and event.key == "enter"):
            return replace(state, enough=True)
        return replace(state, viewer=state.viewer.on_event(event))

    def view(self, state: Looking) -> View:
        """The scene, with what ends it."""
        hint, button = Label("hint.explore", (MARGIN, MARGIN)), state.button
        hud = (hint,) if button is None else (hint, button)
        return View(state.place.scene, state.viewer.camera(), hud, captured=button is None)

    def outcome(self, state: Looking) -> Outcome | None:
        """Nothing was asked."""
        return Outcome("", "", True) if state.enough else None


EXPLORE: Task[WorldParameters, object, Place, Looking] = Explore()
