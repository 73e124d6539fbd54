"""The looks of a picture, side by side: without any, each key by itself, all of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from seethrough.experiment.gallery.gallery_plates import DYNAMIC, Plate, Section
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.standard.opaque import Standard

# Each key at a value that suits the scene's size: what is as large as a room, a cloud, a car.
WORLD: dict[str, dict[str, dict[str, float]]] = {
    "abstract": {"fog": {"fog": 120.0, "fog_start": 90.0}, "floor_grid": {"floor_grid": 10.0}},
    "walkthrough": {"fog": {"fog": 25.0}, "floor_grid": {"floor_grid": 2.0}},
    "jeep": {"fog": {"fog": 4.0, "fog_start": 2.0}, "floor_grid": {"floor_grid": 0.5}},
}


def looks(world: str) -> dict[str, Look]:
    """Name → look: "none", each key by its name, "all"."""
    found = {"none": PLAIN}
    both: dict[str, float] = {}
    for name, values in WORLD[world].items():
        found[name] = replace(PLAIN, **values)
        both |= values
    return {**found, "all": replace(PLAIN, **both)}


def sections(scenes: dict[str, tuple[Scene, Camera]]) -> Iterator[Section]:
    """Scenes by the name of the world, and from where they are seen."""
    ways: tuple[Parameters, ...] = (Standard(), DYNAMIC)
    plates = tuple(
        Plate(
            f"look-{world}-{p.technique.name}-{name}",
            f"{name}; {p.technique.name}",
            dressed(scene, look),
            camera,
            p,
        )
        for world, (scene, camera) in scenes.items()
        for p in ways
        for name, look in looks(world).items()
    )
    yield Section(
        "Looks",
        "Cues of depth and contact, keys of a study's [look]: none, each by itself, all.",
        plates,
    )
