"""What the gallery shows: every mode, mask, granularity and some hard cases, as scenes to draw."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from renderer import geometry, transforms
from renderer.camera import Camera, look_at
from renderer.plan import Technique
from renderer.scene import Object, Scene
from renderer.techniques.dynamic import GRANULARITIES, MASKS, DynamicTransparency
from renderer.techniques.standard import Standard
from tasks.abstract_scene import abstract_scene
from tasks.building import unique_building
from tasks.controls import orbit, walk
from tasks.parameters import AbstractParameters, BuildingParameters

DYNAMIC = DynamicTransparency()
RED = (0.9, 0.15, 0.1)


@dataclass(frozen=True, eq=False)
class Plate:
    """One picture: its file name, and what it shows in words."""

    name: str
    caption: str
    scene: Scene
    camera: Camera
    technique: Technique


def plates(aspect: float, seed: int = 1) -> Iterator[Plate]:
    """All pictures, scenario by scenario."""
    parameters = AbstractParameters()
    scene = abstract_scene(np.random.default_rng(seed), parameters)
    camera = orbit(parameters, aspect).camera()
    near = look_at(camera.eye * 0.55, np.zeros(3), fov_y=0.6, near=5, far=250)
    yield Plate("abstract-standard", "The abstract world, standard", scene, near, Standard())
    yield Plate("abstract-dynamic", "The same, dynamic transparency", scene, near, DYNAMIC)
    yield from _options(scene, near)
    building = BuildingParameters()
    house = unique_building(np.random.default_rng(seed), building)
    view = walk(building, house.start, 1.5).camera()
    yield Plate("walkthrough-standard", "The building, standard", house.scene, view, Standard())
    yield Plate("walkthrough-dynamic", "The same through its walls", house.scene, view, DYNAMIC)
    yield from _jeep()
    yield from _hard()


def _options(scene: Scene, camera: Camera) -> Iterator[Plate]:
    for mask in MASKS:
        technique = replace(DYNAMIC, mask=mask, width=14)
        yield Plate(f"mask-{mask}", f"Mask: {mask}", scene, camera, technique)
    for granularity in GRANULARITIES:
        technique = replace(DYNAMIC, granularity=granularity)
        caption = f"Granularity: {granularity}"
        yield Plate(f"granularity-{granularity}", caption, scene, camera, technique)
    light = replace(DYNAMIC, mode="active", pointer=(0.65, 0.5), radius=0.25, softness=0.08)
    yield Plate("mode-active", "Active mode: a searchlight in the middle", scene, camera, light)
    for layers in (1, 2):
        technique = replace(DYNAMIC, layers=layers)
        caption = f"At most {layers} transparent layer{'s' * (layers > 1)}"
        yield Plate(f"layers-{layers}", caption, scene, camera, technique)
    technique = replace(DYNAMIC, model="additive")
    yield Plate("model-additive", "Additive transparency", scene, camera, technique)
    crowd = replace(scene, objects=tuple(replace(o, target=True) for o in scene.objects))
    yield Plate("all-targets-product", "200 targets, masks multiply", crowd, camera, DYNAMIC)
    technique = replace(DYNAMIC, combine="min")
    yield Plate("all-targets-min", "200 targets, the least mask counts", crowd, camera, technique)


def _jeep() -> Iterator[Plate]:
    from renderer.models.jeep import jeep_scene

    camera = look_at(np.array([2.2, 1.5, -2.6]), np.array([0.0, 0.42, 0.0]), fov_y=0.47)
    scene = jeep_scene()
    yield Plate("jeep-standard", "The jeep, standard", scene, camera, Standard())
    yield Plate("jeep-dynamic", "Engine, gearbox, axles and seats inside", scene, camera, DYNAMIC)


def _hard() -> Iterator[Plate]:
    """Walls longer than their room, crossing boxes, nested dolls, many layers, the near plane."""
    eye = look_at(np.array([0.0, 1.5, 9.0]), np.zeros(3), fov_y=0.7, near=0.2, far=80)
    ring = geometry.torus(0.9, 0.3, 32, 16)
    wall = Object(geometry.box(0.2, 4, 40), transforms.translation(-1.2, 0, -10), (0.75, 0.72, 0.6))
    target = Object(ring, transforms.placed((-3.2, 0.5, -2), scale=1.4), RED, target=True)
    yield Plate(
        "hard-long-wall", "A wall longer than its room", Scene((wall, target)), eye, DYNAMIC
    )
    cross = [
        Object(geometry.box(6, 0.8, 0.8), transforms.rotation_z(a) @ transforms.rotation_y(b), c)
        for a, b, c in (
            (0.3, 0.7, (0.2, 0.5, 0.9)),
            (1.6, 0.2, (0.9, 0.7, 0.2)),
            (2.6, -0.6, (0.3, 0.8, 0.4)),
        )
    ]
    ball = Object(geometry.sphere(1.6, 3), transforms.translation(0, 0, -3), RED, target=True)
    yield Plate("hard-crossing", "Boxes that cross each other", Scene((*cross, ball)), eye, DYNAMIC)
    colors = (RED, (0.2, 0.7, 0.3), (0.2, 0.4, 0.9))
    dolls = tuple(
        Object(geometry.sphere(r, 3), np.eye(4), c, target=r < 1, group=1)
        for r, c in zip((0.7, 1.4, 2.1), colors, strict=True)
    )
    yield Plate(
        "hard-dolls", "Nested dolls, a group", Scene(dolls), eye, replace(DYNAMIC, width=25)
    )
    panes = tuple(
        Object(geometry.box(5, 5, 0.1), transforms.translation(0.2 * i - 1, 0, 3 - 0.4 * i), c)
        for i, c in enumerate(np.random.default_rng(2).uniform(0.2, 1, (12, 3)).tolist())
    )
    deep = Scene((*panes, replace(target, transform=transforms.translation(0.5, 0, -4))))
    yield Plate("hard-deep", "Twelve panes before a target", deep, eye, DYNAMIC)
    kept = replace(DYNAMIC, min_transmittance=0.5)
    yield Plate("hard-deep-kept", "The same, half its light kept for sure", deep, eye, kept)
    close = look_at(np.array([0.0, 0.0, 0.45]), np.array([0.0, 0, -3]), fov_y=1.2, near=0.3, far=30)
    cut = Scene((replace(ball, transform=transforms.translation(0.6, 0, -3.2)), *cross))
    yield Plate("hard-inside", "From inside the boxes", cut, close, DYNAMIC)
