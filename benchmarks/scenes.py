"""The three scenes of paper 004's performance table, and one built to break each way of drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from renderer import geometry, transforms
from renderer.camera import Camera, look_at
from renderer.scene import Object, Scene
from tasks.abstract_scene import abstract_scene
from tasks.building import unique_building
from tasks.controls import orbit, walk
from tasks.parameters import AbstractParameters, BuildingParameters

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
    from renderer.models.jeep import jeep_scene

    middle = np.array([0.0, 0.42, 0.0])
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False) + 0.4
    eyes = [middle + np.array([3.4 * np.sin(t), 1.1, 3.4 * np.cos(t)]) for t in turns]
    return jeep_scene(), [look_at(eye, middle, fov_y=0.47, near=0.5, far=20) for eye in eyes]


def breaking(aspect: float, views: int) -> Views:
    """Long boxes that cross each other and form cycles, rings through rings, targets between."""
    rng = np.random.default_rng(7)
    objects = []
    for _ in range(40):
        size = rng.permutation([9.0, 0.6, 0.6])
        turn = transforms.random_rotation(rng)
        place = transforms.placed(rng.uniform(-3, 3, 3), turn)
        objects.append(Object(geometry.box(*size), place, tuple(rng.uniform(0.2, 1, 3))))
    ring = geometry.torus(1.2, 0.3, 24, 12)
    for i in range(20):
        place = transforms.placed(rng.uniform(-3, 3, 3), transforms.random_rotation(rng))
        color = (1.0, 0.0, 0.0) if i < 8 else tuple(rng.uniform(0.2, 1, 3))
        objects.append(Object(ring, place, color, target=i < 8))
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False)
    eyes = [np.array([16 * np.sin(t), 4.0, 16 * np.cos(t)]) for t in turns]
    return Scene(tuple(objects)), [look_at(e, np.zeros(3), fov_y=0.7, near=1, far=60) for e in eyes]


SCENES: dict[str, Callable[[float, int], Views]] = {
    "abstract": abstract,
    "walkthrough": walkthrough,
    "jeep": jeep,
}
