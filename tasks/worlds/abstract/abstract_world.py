"""The abstract world as the registry knows it."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.tasks.kit.controls import ARROWS, Orbit, orbit
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.world import Texts, keys
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import Cloud, cloud

VIEWS = 6
RISES = (0.0, 0.6, -0.6)  # radians above the middle, in turn


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
        return orbit(parameters, aspect)

    def views(self, parameters: AbstractParameters, first: Camera) -> list[Camera]:
        """From around the world at the orbit's distance: level, above and below in turn."""
        distance = float(np.linalg.norm(first.eye))
        cameras = []
        for k in range(VIEWS):
            turn, rise = 2 * np.pi * k / VIEWS, RISES[k % len(RISES)]
            flat = np.cos(rise)
            eye = distance * np.array([flat * np.sin(turn), np.sin(rise), flat * np.cos(turn)])
            fov_y, near, far = first.fov_y, first.near, first.far
            cameras.append(look_at(eye, np.zeros(3), fov_y=fov_y, near=near, far=far))
        return cameras

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """Nobody goes anywhere."""
        return 0.0
