"""Scenes on which pictures break, for every technique, beside many that stand by chance.

The suite's own scenes have the viewer inside of things, near planes that cut, mirrored and open
meshes (technique_scenes.py); these are the rest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from seethrough.experiment.suites.technique_scenes import (
    BLUE,
    RED,
    SHAPES,
    Case,
    close,
    mirrored,
    room,
    scattered,
)
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene

AHEAD = Camera(np.zeros(3), np.eye(3), 0.9, 0.1, 200.0)
SCENES = 20


def many() -> Case:
    """200 targets and 100 things among them, by chance into one another."""
    rng = np.random.default_rng(5)
    objects = [
        Object(
            SHAPES[i % 3],
            transforms.placed(rng.uniform(-4, 4, 3), transforms.random_rotation(rng), 0.35),
            tuple(rng.uniform(0.2, 1, 3)),
            target=i < 200,
        )
        for i in range(300)
    ]
    eye = np.array([0, 0, 14.0])
    camera = look_at(eye, np.zeros(3), fov_y=0.7, near=1, far=60)
    return Case("200 targets", Scene(tuple(objects)), camera)


def deep() -> Case:
    """Fifty plates one behind the other before a target."""
    plates = [
        Object(geometry.box(2, 2, 0.1), transforms.translation(0, 0, -5 - k), BLUE)
        for k in range(50)
    ]
    ball = Object(geometry.sphere(3.0, 2), transforms.translation(0, 0, -60), RED, True)
    return Case("50 layers", Scene((*plates, ball)), AHEAD)


def coplanar() -> Case:
    """Two boxes whose front faces lie in one plane, and one twice at the same place."""
    box, at = geometry.box(1, 1, 1), transforms.translation
    objects = (
        Object(box, at(-0.4, 0, -4), (0.3, 0.5, 0.9)),
        Object(box, at(0.4, 0.3, -4), (0.3, 0.8, 0.3)),
        Object(box, at(0.4, -1.2, -5), (0.6, 0.6, 0.3)),
        Object(box, at(0.4, -1.2, -5), (0.6, 0.6, 0.3)),
        Object(geometry.sphere(0.6, 2), at(0, 0, -8), RED, True),
    )
    return Case("coplanar", Scene(objects), AHEAD)


def flat_and_behind() -> Case:
    """A target without volume, one behind the viewer, one that the near plane cuts."""
    at, cube = transforms.translation, geometry.box(1.3, 1.3, 1.3)
    sheet = replace(cube, vertices=cube.vertices * [1, 1, 0])
    objects = (
        Object(geometry.box(2, 2, 0.2), at(0, 0, -3), BLUE),
        Object(sheet, at(0, 0, -6) @ transforms.rotation_y(0.3), RED, True),
        Object(SHAPES[0], at(0, 0, 5), RED, True),
        Object(SHAPES[0], at(0.9, 0, -0.6), (0.9, 0.6, 0.1), True),
    )
    return Case("flat, behind, near plane", Scene(objects), AHEAD)


def small() -> Case:
    """One thing before a target, both a few pixels of 4096 × 4096: the reference tries every point
    of a target at every pixel of the picture."""
    turn = transforms.rotation_y(0.4)
    objects = (
        Object(SHAPES[2], transforms.placed((0.02, 0, -40), turn, 0.05), BLUE),
        Object(SHAPES[0], transforms.placed((0.0, 0, -44), None, 0.03), RED, True),
    )
    return Case("small", Scene(objects), AHEAD)


HARD = (many, deep, coplanar, flat_and_behind, close, mirrored)
SIZES = ((room, (1, 1)), (many, (301, 7)), (small, (4096, 4096)))


def twenty() -> Iterator[Case]:
    """Scenes in which things stand by chance, some of them impenetrable, and rooms seen from
    round about."""
    for seed in range(14):
        yield scattered(100 + seed, 8 + seed, impenetrable=0.3 * (seed % 3 == 2))
    plan = room()
    for k in range(SCENES - 14):
        turn = 2 * np.pi * k / (SCENES - 14) + 0.2
        eye = np.array([8.0 * np.sin(turn), 1.4 + 0.4 * k, 8.0 * np.cos(turn)])
        camera = look_at(eye, np.array([0.3, 1.0, 0.0]), fov_y=0.9, near=0.1, far=100)
        yield Case(f"room from {np.degrees(turn):.0f}°", plan.scene, camera)
