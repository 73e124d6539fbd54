"""The world `scene` as the registry knows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.controls import ARROWS, Orbit, Walk
from seethrough.tasks.kit.own_texts import OwnTexts
from seethrough.tasks.kit.views import headings, nearest_next, round_the_middle
from seethrough.tasks.kit.world import Asked, Texts, keys
from seethrough.tasks.worlds.scene import scene_files
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters
from seethrough.tasks.worlds.scene.scene_place import ScenePlace, opened
from seethrough.tasks.worlds.scene.standing import Fixed, standing


class SceneWorld:
    """Things from a file: a study's own, or one of those that ship."""

    name, version = "scene", "1"
    source = "the study's own files"
    scenario = "scene"
    moving = "orbit"
    controls = "scene.orbit"
    takes = keys(ARROWS)
    Parameters = SceneParameters
    texts: Texts = OwnTexts("seethrough.tasks.worlds.scene")

    def named(self, parameters: SceneParameters) -> dict[str, str]:
        """The scenes that are not ours."""
        return scene_files.named(parameters)

    def found(self, parameters: SceneParameters, folder: Path) -> SceneParameters:
        """The scenes read, with their hashes, and all that is said of them checked."""
        return scene_files.found(parameters, folder)

    def keeps(self, parameters: SceneParameters) -> dict[str, Callable[[], bytes]]:
        """Each scene as it was read."""
        return scene_files.keeps(parameters)

    def kept_in(self, parameters: SceneParameters, folder: Path) -> SceneParameters:
        """The scenes as they were kept."""
        return scene_files.kept_in(parameters, folder)

    def targets(self, parameters: SceneParameters) -> dict[str, int]:
        """How many targets each scene has."""
        files = enumerate(parameters.files)
        return {f"files[{i}]": len(opened(parameters, file).targets) for i, file in files}

    def called(self, parameters: SceneParameters) -> list[tuple[str, str]]:
        """What participants call the targets of each scene."""
        found = []
        for number, file in enumerate(parameters.files):
            place = opened(parameters, file)
            labels = dict.fromkeys(place.labels[i] for i in place.targets)
            found += [(f"files[{number}]", label) for label in labels]
        return found

    def make(self, rng: Generator, parameters: SceneParameters) -> ScenePlace:
        """The scene of one of the files, drawn."""
        return opened(parameters, parameters.files[int(rng.integers(len(parameters.files)))])

    def items(self, parameters: SceneParameters) -> tuple[Asked[ScenePlace], ...]:
        """What can be asked: the study's items, or every target of every file."""
        found = []
        for item in parameters.items:
            place = opened(parameters, item.file or parameters.files[0])
            thing = place.names.index(item.ask)
            found.append(Asked(replace(place, start=item.start or place.start), thing))
        if not parameters.items:
            for file in parameters.files:
                place = opened(parameters, file)
                found += [Asked(place, int(thing)) for thing in place.targets]
        return tuple(found)

    def viewer(
        self, place: ScenePlace, parameters: SceneParameters, aspect: float
    ) -> Orbit | Walk | Fixed:
        """At the camera where one begins, or before it all."""
        return standing(place, parameters, aspect)

    def views(self, parameters: SceneParameters, first: Camera) -> list[Camera]:
        """Round the middle; the file's cameras; who walks looks to every side from there, or from
        where one begins and a step away."""
        if parameters.move == "orbit":
            return round_the_middle(first)
        walks = parameters.move == "walk"
        for file in parameters.files:
            cameras = list(opened(parameters, file).cameras.values())
            places = [np.array([c.eye[0], first.eye[1] if walks else c.eye[1], c.eye[2]])
                      for c in cameras]  # fmt: skip
            if any(np.array_equal(place, first.eye) for place in places):
                return headings(first, places) if walks else cameras
        if not walks:
            return round_the_middle(first)
        step = first.far / 32  # an eighth of the scene
        away = [first.eye + step * np.array([x, 0.0, z]) for x in (-1, 1) for z in (-1, 1)]
        return headings(first, [first.eye, *away])

    def path(self, first: Camera, asked: NDArray[np.float64]) -> float:
        """From the start past what is asked for, as far as one walks at all."""
        return nearest_next(first, asked)
