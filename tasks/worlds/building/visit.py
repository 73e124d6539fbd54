"""What the tasks of the walkthrough share: a walker in a building, who is shown what to look for.

The pointer is captured and turns the walker. It clicks nothing until a task lets go of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, pi

import numpy as np

from seethrough.renderer.events import Event
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.controls import Walk, changed, walk
from seethrough.tasks.kit.hud import Element
from seethrough.tasks.kit.turning import inset
from seethrough.tasks.worlds.building.building import Building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

AWAY, DIRECTIONS = (7.5, 10.0), 6  # world units from a thing, and sides of it
MOST_THINGS = 2  # of those asked for, to stand before for an instruction's picture
ROOM = 0.5  # world units between the camera and any thing


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


def target_picture(building: Building) -> Scene:
    """A scene of the asked thing alone; made once a trial, so that the display can keep it."""
    mesh = building.scene.objects[building.asked_objects[0]].mesh
    return Scene((Object(mesh, kind=building.asked),))


def before(visit: Visit) -> tuple[Camera, ...]:
    """Cameras at eye height that look at a thing asked for, from every side."""
    scene, p, found = visit.building.scene, visit.building.parameters, []
    movable = [i for i, o in enumerate(scene.objects) if o.target]
    things, sizes = scene.centers[movable][:, [0, 2]], scene.radii[movable]
    for thing in visit.building.asked_objects[:MOST_THINGS]:
        x, _, z = scene.centers[thing]
        for distance in AWAY:
            for k in range(DIRECTIONS):
                angle = 2 * pi * k / DIRECTIONS
                at = np.array([x + distance * np.cos(angle), z + distance * np.sin(angle)])
                free = (np.hypot(*(things - at).T) > sizes + ROOM).all()
                if free and (np.abs(at) < p.side / 2 - ROOM).all():
                    yaw = atan2(at[0] - x, at[1] - z)
                    walk = changed(visit.walk, x=float(at[0]), z=float(at[1]), yaw=yaw)
                    found.append(walk.camera())
    return (*found, visit.walk.camera())
