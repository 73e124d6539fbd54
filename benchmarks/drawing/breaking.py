"""Scenes built to break one order of objects each."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene

Views = tuple[Scene, list[Camera]]
RED = (1.0, 0.0, 0.0)


def long_walls(aspect: float, views: int) -> Views:
    """Breaks the order by centres: walls whose centres lie farther away than what they hide."""
    rng = np.random.default_rng(11)
    wall = geometry.box(0.2, 4.0, 60.0)
    objects = [
        Object(wall, transforms.translation(x, 0.0, -26.0), tuple(rng.uniform(0.4, 0.9, 3)))
        for x in (-6.0, -2.0, 2.0, 6.0)
    ]
    shapes = (geometry.sphere(0.7, 2), geometry.torus(0.6, 0.25, 24, 12))
    for i in range(24):
        place = (rng.choice([-8.0, -4.0, 0.0, 4.0, 8.0]), rng.uniform(-1, 1), rng.uniform(-16, 0))
        turned = transforms.placed(place, transforms.random_rotation(rng))
        color = RED if i % 3 == 0 else tuple(rng.uniform(0.2, 1, 3))
        objects.append(Object(shapes[i % 2], turned, color, target=i % 3 == 0))
    sides = np.linspace(-9.0, 9.0, views)
    eyes = [np.array([x, 1.0, 9.0]) for x in sides]
    aim = np.array([0.0, 0.0, -8.0])
    return Scene(tuple(objects)), [look_at(e, aim, fov_y=0.9, near=0.5, far=90) for e in eyes]


def small_crossings(aspect: float, views: int) -> Views:
    """Breaks what `doubt` leaves to the centres: many pairs that intersect, each a small part."""
    rng = np.random.default_rng(13)
    plate, ring = geometry.box(1.2, 1.2, 0.1), geometry.torus(0.5, 0.18, 24, 12)
    objects = []
    for i in range(12):
        place = np.array([4.5 * (i % 4 - 1.5), 3.6 * (i // 4 - 1), rng.uniform(-3, 3)])
        for _ in range(2):
            turn = transforms.random_rotation(rng)
            color = tuple(rng.uniform(0.2, 1, 3))
            objects.append(Object(plate, transforms.placed(place, turn), color))
        behind = place + np.array([0.1, 0.1, -1.6])
        turned = transforms.placed(behind, transforms.random_rotation(rng))
        objects.append(Object(ring, turned, RED, target=True))
    turns = np.linspace(-0.3, 0.3, views)
    eyes = [np.array([34 * np.sin(t), 2.0, 34 * np.cos(t)]) for t in turns]
    return Scene(tuple(objects)), [look_at(e, np.zeros(3), fov_y=0.6, near=1, far=60) for e in eyes]


def crossings(aspect: float, views: int) -> Views:
    """Breaks every order of objects: long boxes that cross each other and form cycles, rings
    through rings, targets between."""
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
        color = RED if i < 8 else tuple(rng.uniform(0.2, 1, 3))
        objects.append(Object(ring, place, color, target=i < 8))
    turns = np.linspace(0, 2 * np.pi, views, endpoint=False)
    eyes = [np.array([16 * np.sin(t), 4.0, 16 * np.cos(t)]) for t in turns]
    return Scene(tuple(objects)), [look_at(e, np.zeros(3), fov_y=0.7, near=1, far=60) for e in eyes]


BREAKING = {
    "long walls": long_walls,
    "small crossings": small_crossings,
    "crossings": crossings,
}
