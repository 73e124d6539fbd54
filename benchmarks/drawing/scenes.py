"""The three scenes of Elmqvist2009's performance table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.controls import orbit, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

Views = tuple[Scene, list[Camera]]


def abstract(aspect: float, views: int) -> Views:
    """200 objects, about 13k triangles, 20 % targets, from round about."""
    parameters = AbstractParameters(target_share=(0.2, 0.2))
    scene = abstract_scene(np.random.default_rng(1), parameters)
    start = orbit(parameters, aspect)
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False)
    return scene, [replace(start, yaw=float(t)).camera() for t in turns]


def walkthrough(aspect: float, views: int) -> Views:
    """50 complex models among walls, about 444k triangles, from the middle of the building."""
    parameters = BuildingParameters()
    building = unique_building(np.random.default_rng(1), parameters)
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False) + 0.3
    return building.scene, [walk(parameters, building.start, float(t)).camera() for t in turns]


def jeep(aspect: float, views: int) -> Views:
    """Engine, gearbox, axles and seats inside a body, about 115k triangles, from round about."""
    from seethrough.renderer.models.vehicles.jeep import jeep_scene

    middle = np.array([0.0, 0.42, 0.0])
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False) + 0.4
    eyes = [middle + np.array([3.4 * np.sin(t), 1.1, 3.4 * np.cos(t)]) for t in turns]
    return jeep_scene(), [look_at(eye, middle, fov_y=0.47, near=0.5, far=20) for eye in eyes]


SCENES: dict[str, Callable[[float, int], Views]] = {
    "abstract": abstract,
    "walkthrough": walkthrough,
    "jeep": jeep,
}
