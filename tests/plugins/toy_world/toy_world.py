"""Ten balls in a row, the last ones red."""

from dataclasses import dataclass

import numpy as np

from seethrough.api import Object, Scene, check, controls, geometry, key, keys, scenes, transforms

BALL = geometry.sphere(0.5)


@dataclass(frozen=True)
class Row:
    balls: int = key(10, "how many balls", low=2, high=100)
    scenes: str = scenes("own")
    side, fov_y, start_pitch, drag_gain, key_rate = 12.0, 1.0, 0.3, 3.0, 1.0

    def __post_init__(self):
        check(self)


@dataclass(frozen=True)
class Place:
    scene: Scene


class Toy:
    name, version, source, scenario = "toy_world", "1", "nobody", "toy_world"
    moving, controls, Parameters, takes = "orbit", "toy_world.controls", Row, keys(controls.ARROWS)
    texts = {"en": {"toy_world.controls": "Drag to turn."}}

    def make(self, rng, p):
        at = rng.uniform(-1, 1, (p.balls, 3)) + np.linspace(-5, 5, p.balls)[:, None] * [1, 0, 0]
        looks = [((1.0, 0, 0), True) if x > 0 else ((0, 0, 1.0), False) for x, _, _ in at]
        things = [
            Object(BALL, transforms.translation(*x), *look)
            for x, look in zip(at, looks, strict=True)
        ]
        return Place(Scene(tuple(things)))

    def viewer(self, place, p, aspect):
        return controls.orbit(p, aspect)

    def views(self, p, first):
        return [first]

    def path(self, first, asked):
        return 0.0


WORLD = Toy()
