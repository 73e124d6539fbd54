"""The building as the registry knows it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.tasks.kit.controls import ARROWS, Walk, walk
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.building.building import Building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

HEADINGS = 4


class BuildingWorld:
    """A floor of rooms with things in them, that one walks through."""

    name, version = "building", "1"
    source = "Elmqvist2009 §VI"
    scenario = "walkthrough"
    moving = "walk"
    controls = "walkthrough.controls"
    takes = keys(ARROWS)
    Parameters = BuildingParameters
    texts: Texts = OwnTexts("seethrough.tasks.worlds.building")

    def make(self, rng: Generator, parameters: BuildingParameters) -> Building:
        """A building in which one kind of thing occurs once, all others more often."""
        return unique_building(rng, parameters)

    def viewer(self, place: Building, parameters: BuildingParameters, aspect: float) -> Walk:
        """At the building's start."""
        return walk(parameters, place.start)

    def views(self, parameters: BuildingParameters, first: Camera) -> list[Camera]:
        """Four headings at the start and in the middle of each quarter of the building."""
        quarter, height = parameters.side / 4, first.eye[1]
        places = [(first.eye[0], first.eye[2])]
        places += [(x * quarter, z * quarter) for x in (-1, 1) for z in (-1, 1)]
        cameras = []
        for x, z in places:
            eye = np.array([x, height, z])
            for k in range(HEADINGS):
                turn = 2 * np.pi * k / HEADINGS
                ahead = eye + np.array([np.sin(turn), 0.0, -np.cos(turn)])
                fov_y, near, far = first.fov_y, first.near, first.far
                cameras.append(look_at(eye, ahead, fov_y=fov_y, near=near, far=far))
        return cameras

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """From the start past every thing asked for, always to the nearest one next.

        Straight: there is no collision in the building (Elmqvist2009 §VI-D).
        """
        left = list(asked[:, [0, 2]])
        way = [first.eye[[0, 2]]]
        while left:
            nearest = min(range(len(left)), key=lambda i: float(np.linalg.norm(left[i] - way[-1])))
            way.append(left.pop(nearest))
        return float(sum(np.linalg.norm(b - a) for a, b in pairwise(way)))
