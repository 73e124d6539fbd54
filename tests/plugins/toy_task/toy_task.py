"""Is anything red to be seen? Y or N."""

from dataclasses import dataclass, replace

from seethrough.api import Basics, Hands, Outcome, Strategy, View, events, hud, keys, measure


@dataclass(frozen=True, eq=False)
class State:
    place: object
    viewer: object
    said: str = ""


def look(mood, glance):
    hands = Hands(mood, glance.now)
    hands.key("y" if glance.look().visible.any() else "n")
    yield hands.take()


class Toy(Basics):
    name, code, source = "toy_task", "TOY", "nobody"
    worlds, measures = ("abstract",), (measure.CORRECT,)
    texts = {"en": {"toy_task.title": "Red?", "toy_task.instruction": "Y or N."}}
    takes = keys("yn")
    simulate = Strategy(look)

    def begin(self, made, setting, aspect):
        return State(made, setting.world.viewer(made, setting.place, aspect))

    def on_event(self, state, event):
        said = event.key if isinstance(event, events.KeyPress) and event.key in "yn" else state.said
        return replace(state, viewer=state.viewer.on_event(event), said=said)

    def view(self, state):
        return View(
            state.place.scene, state.viewer.camera(), (hud.Label(self.title, (0.02, 0.02)),)
        )

    def outcome(self, state):
        return Outcome(state.said, "y", state.said == "y") if state.said else None


TASK = Toy()
