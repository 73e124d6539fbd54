"""What the tasks of the walkthrough share: a walker in a building, who is shown what to look for.

The pointer is captured and turns the walker. It clicks nothing until a task lets go of it.
"""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.controls import Walk, walk
from seethrough.tasks.kit.current_target import inset, target_picture
from seethrough.tasks.kit.events import Event
from seethrough.tasks.kit.hud import Element
from seethrough.tasks.parameters import BuildingParameters
from seethrough.tasks.worlds.building.building import Building


@dataclass(frozen=True, eq=False)
class Visit:
    """A building, where the walker is in it, and the picture of the thing asked for."""

    building: Building
    walk: Walk
    picture: Scene

    def on_event(self, event: Event) -> Visit:
        """The visit after `event`."""
        walk = self.walk.on_event(event)
        return self if walk is self.walk else Visit(self.building, walk, self.picture)

    def view(self, label: Element, *more: Element, captured: bool = True) -> View:
        """What the walker sees, under a label, the turning picture and what the task adds."""
        picture = inset(self.picture, self.walk.held.time or 0.0)
        hud = (label, picture, *more)
        return View(self.building.scene, self.walk.camera(), hud, captured)


def visit(building: Building, parameters: BuildingParameters) -> Visit:
    """The walker at the building's start."""
    return Visit(building, walk(parameters, building.start), target_picture(building))
