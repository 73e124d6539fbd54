"""The building as the registry knows it."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.controls import ARROWS, Walk, walk
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.views import headings, nearest_next
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.building.building import Building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters


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

    def called(self, parameters: BuildingParameters) -> list[tuple[str, str]]:
        """The names of the study's own models."""
        return [(f"models[{i}].name", own.name) for i, own in enumerate(parameters.models)]

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
        return headings(first, [np.array([x, height, z]) for x, z in places])

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """From the start past every thing asked for, always to the nearest one next.

        Straight: there is no collision in the building (Elmqvist2009 §VI-D).
        """
        return nearest_next(first, asked)
