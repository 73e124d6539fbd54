"""The abstract world as the registry knows it."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.controls import ARROWS, Orbit, orbit
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.views import round_the_middle
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import Cloud, cloud


class Abstract:
    """A cube of shapes, some of them red, that one turns about its middle."""

    name, version = "abstract", "1"
    source = "Elmqvist2009 §VI"
    scenario = "abstract"
    moving = "orbit"
    controls = "abstract.controls"
    takes = keys(ARROWS)
    Parameters = AbstractParameters
    texts: Texts = OwnTexts("seethrough.tasks.worlds.abstract")

    def make(self, rng: Generator, parameters: AbstractParameters) -> Cloud:
        """A cube of its own for each call."""
        return cloud(rng, parameters)

    def viewer(self, place: Cloud, parameters: AbstractParameters, aspect: float) -> Orbit:
        """Far enough away to see all of it."""
        scene = place.scene
        if parameters.fills == "cube" or not scene.objects:
            return orbit(parameters, aspect)
        reach = np.linalg.norm(scene.centers, axis=1) + scene.radii
        return orbit(parameters, aspect, reach=float(reach.max()))

    def views(self, parameters: AbstractParameters, first: Camera) -> list[Camera]:
        """From around the world at the orbit's distance: level, above and below in turn."""
        return round_the_middle(first)

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """Nobody goes anywhere."""
        return 0.0
