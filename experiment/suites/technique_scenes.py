"""Small scenes on which techniques are tried: plain ones, and what breaks pictures."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
RED, GREY, BLUE = (0.9, 0.2, 0.1), (0.7, 0.7, 0.65), (0.2, 0.5, 0.9)


@dataclass(frozen=True, eq=False)
class Case:
    """A scene, from where it is seen, and what it is about."""

    name: str
    scene: Scene
    camera: Camera


def scattered(seed: int, count: int = 14, impenetrable: float = 0.0) -> Case:
    """Things of all shapes one behind the other, two of five of them targets."""
    rng = np.random.default_rng(seed)
    objects = []
    for k in range(count):
        target = bool(rng.random() < 0.4)
        turn, scale = transforms.random_rotation(rng), rng.uniform(0.6, 1.1, 3)
        place = (*rng.uniform(-1.3, 1.3, 2), -2.0 * k)
        hard = bool(not target and rng.random() < impenetrable)
        pose = transforms.placed(place, turn, scale)
        color = tuple(rng.uniform(0.1, 1.0, 3))
        objects.append(Object(SHAPES[rng.integers(4)], pose, color, target, hard, kind="thing"))
    eye = np.array([*rng.uniform(-1, 1, 2), 9.0])
    camera = look_at(eye, eye - np.array([0.0, 0, 1]), fov_y=0.55, near=0.5, far=200)
    return Case(f"scattered {seed}", Scene(tuple(objects)), camera)


def room() -> Case:
    """Targets behind walls, on an impenetrable floor; one of them free."""
    at = transforms.translation
    objects = (
        Object(geometry.box(40, 0.2, 40), at(0, -0.1, 0), GREY, impenetrable=True, kind="floor"),
        Object(geometry.box(16, 3, 0.3), at(-5, 1.5, 0), (0.5, 0.6, 0.8), kind="wall"),
        Object(geometry.box(0.4, 3, 6), at(3, 1.5, -3), (0.4, 0.7, 0.4), kind="wall"),
        Object(SHAPES[3], at(0.5, 1, -3), RED, True, kind="ring"),
        Object(SHAPES[0], at(-2, 1, -5), RED, True, kind="ball"),
        Object(SHAPES[2], at(4.2, 1, -5), RED, True, kind="crate"),
        Object(SHAPES[1], at(4, 1, 2), RED, True, kind="cone"),
        Object(SHAPES[2], at(-0.5, 0.7, 2.5), BLUE, kind="crate"),
    )
    eye, middle = np.array([1.0, 1.6, 8.0]), np.array([0.5, 1.0, 0.0])
    return Case("room", Scene(objects), look_at(eye, middle, fov_y=0.9, near=0.1, far=100))


def close() -> Case:
    """The viewer inside a shell, a box that the near plane cuts, and a target behind both."""
    objects = (
        Object(geometry.sphere(3.0, 2), transforms.translation(0, 0, 1), GREY),
        Object(SHAPES[2], transforms.placed((0.5, 0.2, -0.7), transforms.rotation_y(0.4)), BLUE),
        Object(SHAPES[0], transforms.translation(0, 0, -5), RED, True),
        Object(SHAPES[3], transforms.translation(-0.8, 0.3, -3.4), (0.3, 0.8, 0.3)),
    )
    return Case("close", Scene(objects), Camera(np.zeros(3), np.eye(3), 0.9, 0.3, 60))


def mirrored() -> Case:
    """Mirrored and flattened things, an open shell, and things that reach into one another."""
    half = geometry.sphere(1.0, 2)
    few = half.triangles[: len(half.triangles) // 2]
    shell = replace(half, triangles=few, convex=False)
    flip = np.diag([-1.0, 1, 1, 1])
    objects = (
        Object(SHAPES[1], transforms.translation(-1, 0, 0) @ flip, BLUE),
        Object(shell, transforms.placed((0.6, 0, 1), transforms.rotation_x(0.5)), GREY),
        Object(SHAPES[3], transforms.placed((0.2, -0.4, 0.4), None, (1, -1, 0.4)), (0.3, 0.8, 0.3)),
        Object(SHAPES[2], transforms.placed((-0.4, -0.3, 0.1), transforms.rotation_y(0.7)), GREY),
        Object(SHAPES[0], transforms.translation(-0.3, 0.2, -4) @ flip, RED, True),
        Object(SHAPES[2], transforms.placed((1.4, 0.5, -3), None, 0.8), RED, True),
    )
    eye = np.array([0.3, 0.4, 7.0])
    return Case("mirrored", Scene(objects), look_at(eye, np.zeros(3), fov_y=0.6, near=1, far=50))


def cases() -> tuple[Case, ...]:
    """All of them."""
    return (scattered(1), scattered(2, impenetrable=0.3), scattered(3), room(), close(), mirrored())


def covered() -> Case:
    """A wall across the view and, behind most of it, one large target: in the middle of the picture
    no edge of anything, about it the borders of whatever a technique opens."""
    at = transforms.translation
    objects = (
        Object(geometry.box(20, 20, 0.2), at(0, 0, 0), GREY, kind="wall"),
        Object(geometry.box(4.2, 3.2, 0.2), at(0, 0, -1), RED, True, kind="slab"),
    )
    eye = np.array([0.0, 0.0, 5.0])
    return Case("covered", Scene(objects), look_at(eye, np.zeros(3), fov_y=0.9, near=0.5, far=50))


def fixed() -> Case:
    """A scene in which nothing may be seen through: no technique has anything to do."""
    case = scattered(4)
    objects = tuple(replace(o, impenetrable=True, target=False) for o in case.scene.objects)
    return Case("all impenetrable", Scene(objects), case.camera)
