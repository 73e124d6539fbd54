"""A sign with a digit of bars on its front, among the things of an abstract world."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed, rotation_y
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene

SIGN = "sign "  # what things with a digit on them are, before the digit
PAPER, INK = (0.97, 0.97, 0.95), (0.10, 0.10, 0.14)
# In heights of the sign: how wide and thick it is, and how its bars lie on it.
WIDTH, DEPTH, RAISED, STROKE = 0.7, 0.05, 0.03, 0.08
LEFT, RIGHT, TOP, BOTTOM = -0.2, 0.2, 0.36, -0.36
# Seven bars from corner to corner, x to the right and y up, as calculators have them.
BARS = {
    "a": ((LEFT, TOP), (RIGHT, TOP)),
    "b": ((RIGHT, 0.0), (RIGHT, TOP)),
    "c": ((RIGHT, BOTTOM), (RIGHT, 0.0)),
    "d": ((LEFT, BOTTOM), (RIGHT, BOTTOM)),
    "e": ((LEFT, BOTTOM), (LEFT, 0.0)),
    "f": ((LEFT, 0.0), (LEFT, TOP)),
    "g": ((LEFT, 0.0), (RIGHT, 0.0)),
}
DIGITS = ("abcdef", "bc", "abged", "abgcd", "fgbc", "afgcd", "afgedc", "abc", "abcdefg", "abcdfg")


@dataclass(frozen=True, eq=False)
class SignPlace:
    """A world with a sign in it, its last object; the `digit` on it, and its front's `normal`."""

    scene: Scene
    digit: int
    normal: NDArray[np.float64]

    @property
    def sign(self) -> int:
        """The sign's index."""
        return len(self.scene.objects) - 1


@cache
def sign_mesh(digit: int) -> Mesh:
    """A plate one unit high whose front, its own +z, has the digit's bars on it.

    One mesh, so that nothing of a sign is ever seen through the rest of it, least from behind.
    """
    boxes = [((0.0, 0.0, 0.0), (WIDTH, 1.0, DEPTH), PAPER)]
    for bar in DIGITS[digit]:
        (x0, y0), (x1, y1) = BARS[bar]
        middle = ((x0 + x1) / 2, (y0 + y1) / 2, (DEPTH + RAISED) / 2)
        boxes.append((middle, (abs(x1 - x0) + STROKE, abs(y1 - y0) + STROKE, RAISED), INK))
    cube = geometry.box()
    count = len(cube.vertices)
    return Mesh(
        np.concatenate([cube.vertices * size + middle for middle, size, _ in boxes]),
        np.tile(cube.normals, (len(boxes), 1)),
        np.repeat(np.array([color for _, _, color in boxes]), count, axis=0),
        np.concatenate([cube.triangles + i * count for i in range(len(boxes))]).astype(np.int32),
    )


def sign_place(rng: Generator, p: AbstractParameters, height: float) -> SignPlace:
    """An abstract world with a sign so high, upright and turned to any side, each digit equally
    likely; nothing else in it is a target. Raises ValueError for a sign that has no room."""
    room = p.side / 2 - height / 2
    if room < 0:
        raise ValueError(f"height = {height:g}, expected a sign that fits a cube of {p.side:g}")
    digit, turn = int(rng.integers(10)), float(rng.uniform(0, 2 * np.pi))
    middle = rng.uniform(-room, room, 3)
    others = [replace(thing, target=False) for thing in abstract_scene(rng, p).objects]
    turned = rotation_y(turn)
    sign = placed(middle, turned, height)
    scene = Scene((*others, Object(sign_mesh(digit), sign, target=True, kind=f"{SIGN}{digit}")))
    return SignPlace(scene, digit, turned[:3, 2])
