"""Small scenes in which the paper's order by centres is right, and which show every case."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene

SHAPES = (
    geometry.sphere(1.0, 1),
    geometry.cone(0.9, 1.6, 20),
    geometry.box(1.3, 1.3, 1.3),
    geometry.torus(0.75, 0.25, 16, 10),
)


def column(
    seed: int,
    count: int = 14,
    targets: float = 0.4,
    impenetrable: float = 0.0,
    spread: float = 1.3,
) -> Scene:
    """Objects one behind the other, each in its own slab of depth, so that no order is in doubt."""
    rng = np.random.default_rng(seed)
    objects = []
    for i in range(count):
        target = bool(rng.random() < targets)
        position = (*rng.uniform(-spread, spread, 2), -2.5 * i)
        objects.append(
            Object(
                SHAPES[rng.integers(len(SHAPES))],
                transforms.placed(
                    position, transforms.random_rotation(rng), rng.uniform(0.6, 1.1, 3)
                ),
                tuple(rng.uniform(0.1, 1.0, 3)),
                target=target,
                impenetrable=bool(not target and rng.random() < impenetrable),
            )
        )
    shuffled = rng.permutation(count)
    return Scene(tuple(objects[k] for k in shuffled))


def before_column(seed: int = 0) -> Camera:
    """In front of a column, looking along it."""
    rng = np.random.default_rng(1000 + seed)
    eye = np.array([*rng.uniform(-1, 1, 2), 9.0])
    return look_at(eye, eye - np.array([0.0, 0.0, 1.0]), fov_y=0.55, near=0.5, far=200.0)


def room() -> tuple[Scene, Camera]:
    """Targets behind a long wall and a pillar, on a floor that is impenetrable; far to the left a
    wall leaves the picture, and one target stands free."""
    red, grey = (0.9, 0.2, 0.1), (0.7, 0.7, 0.65)
    objects = [
        Object(geometry.box(40, 0.2, 40), transforms.translation(0, -0.1, 0), grey, False, True),
        Object(geometry.box(16, 3, 0.3), transforms.translation(-5, 1.5, 0), (0.5, 0.6, 0.8)),
        Object(geometry.box(0.4, 3, 6), transforms.translation(3, 1.5, -3), (0.4, 0.7, 0.4)),
        Object(SHAPES[3], transforms.translation(0.5, 1, -3), red, target=True),
        Object(SHAPES[0], transforms.translation(-2, 1, -5), red, target=True),
        Object(SHAPES[2], transforms.translation(4.2, 1, -5), red, target=True),
        Object(SHAPES[1], transforms.translation(4, 1, 2), red, target=True),
    ]
    return Scene(tuple(objects)), look_at(
        np.array([1.0, 1.6, 8.0]), np.array([0.5, 1.0, 0.0]), fov_y=0.9, near=0.1, far=100.0
    )
