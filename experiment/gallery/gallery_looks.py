"""The looks of a picture, side by side: without any, each key by itself, all of them."""

from __future__ import annotations

from collections.abc import Iterator

from seethrough.experiment.gallery.gallery_plates import DYNAMIC, Plate, Section
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.standard.opaque import Standard

# Each key at a value that suits the scene's size: what is as large as a room, a cloud, a car.
EDGES = {
    "occlusion": Look(occlusion=0.8),
    "antialiasing": Look(antialiasing="edges"),
    "outlines": Look(antialiasing="edges", outlines=1.5),
}
WORLD = {
    "abstract": {
        "fog": Look(fog=120.0, fog_start=90.0),
        "floor_grid": Look(floor_grid=10.0),
        "ground_shadows": Look(ground_shadows=0.7, shadow_reach=60.0),
    },
    "walkthrough": {
        "fog": Look(fog=25.0),
        "floor_grid": Look(floor_grid=2.0),
        "ground_shadows": Look(ground_shadows=0.8),
    },
    "jeep": {
        "fog": Look(fog=4.0, fog_start=2.0),
        "floor_grid": Look(floor_grid=0.5),
        "ground_shadows": Look(ground_shadows=0.8),
    },
}


def looks(world: str) -> dict[str, Look]:
    """Name → look: "none", each key by its name, "all"."""
    alone = WORLD[world] | EDGES
    every = {key: getattr(look, key) for look in alone.values() for key in look.on}
    return {"none": PLAIN, **alone, "all": Look(**every)}


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
