"""The abstract world: a cube of spheres, cones, boxes and tori, some red (Elmqvist2009 §VI)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Color, Object, Scene
from seethrough.renderer.scene.transforms import placed, random_rotation
from seethrough.tasks.kit.enclosure import enclosing_pairs, farthest
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.kit.letters import grid_reach, letter_points
from seethrough.tasks.kit.tags import with_kind_tags
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters

RED = (1.0, 0.0, 0.0)
VERMILION = (0.835, 0.369, 0.0)  # the red of Okabe and Ito's palette, apart from blue for everybody

# Distractors of less than this in both green and blue would be black and lose their shading.
DARKEST = 0.2


@cache
def unit_mesh(shape: str) -> Mesh:
    """The one mesh all objects of a shape share: bounding radius 1, about 65 triangles on average.

    200 objects make 13k triangles, as the paper's abstract scene does (Elmqvist2009, table 2).
    """
    if shape == "sphere":
        return geometry.sphere(1.0, 1)
    if shape == "cone":
        return geometry.cone(0.7, 2 * 0.51**0.5, 20)
    if shape == "box":
        return geometry.box(*np.full(3, 2 / 3**0.5))
    return geometry.torus(0.72, 0.28, 13, 6)


def target_color(p: AbstractParameters) -> Color:
    """Pure red as published, or a red that red–green blind people tell from the distractors."""
    return RED if p.palette == "published" else VERMILION


def distractor_color(p: AbstractParameters, green: float, blue: float) -> Color:
    """Random green and blue and no red (Elmqvist2009 §VI-D); in the safe palette only blues of some
    kind."""
    if p.palette == "published":
        return (0.0, green, blue)
    return (0.0, 0.2 + 0.45 * green, 0.45 + 0.55 * blue)


@dataclass(frozen=True, eq=False)
class Cloud:
    """A place of the abstract world, and the letter that its red cones form, if they do."""

    scene: Scene
    letter: str = ""


def cloud(rng: Generator, parameters: AbstractParameters, letter: str = "") -> Cloud:
    """A place of its own for each call; see `abstract_scene`."""
    return Cloud(abstract_scene(rng, parameters, letter or None), letter)


def abstract_scene(
    rng: Generator, parameters: AbstractParameters, pattern: str | None = None
) -> Scene:
    """A world of its own for each call; with `pattern`, red cones form that letter (task T2).

    The letter lies in the plane y = 0, turned by a random angle about the vertical. Its cones
    count into the red objects, and no other cone is red. No object encloses another. Raises
    ValueError where the parameters leave no room for that.
    """
    p = parameters
    places = np.zeros((0, 3))
    if pattern is not None:
        spacing = (p.side / 2 - p.radius[1]) / grid_reach()
        places = letter_points(pattern, spacing, rng.uniform(0, 2 * np.pi))
    targets = _number_of_targets(rng, p, len(places))
    red = target_color(p)
    objects = [_object(rng, p, "cone", red, place) for place in places]
    free = p.shapes if pattern is None else tuple(s for s in p.shapes if s != "cone")
    if not free and targets > len(places):
        raise ValueError(f"shapes = {list(p.shapes)}, expected another than the pattern's cones")
    objects += [_random_object(rng, p, free, red) for _ in range(targets - len(places))]
    objects += [
        _random_object(rng, p, p.shapes, distractor_color(p, *rng.uniform(DARKEST, 1, 2)))
        for _ in range(p.others(targets))
    ]
    return with_kind_tags(Scene(tuple(_disclosed(rng, p, objects, len(places)))), p.tags)


def _number_of_targets(rng: Generator, p: AbstractParameters, least: int) -> int:
    low, high = p.target_range
    if high < least:
        rule = "targets allow" if p.targets else "target_share allows"
        raise ValueError(
            f"objects = {p.objects}, expected enough of them: the letter takes {least} red cones, "
            f"{rule} {high}"
        )
    return int(rng.integers(max(low, least), high + 1))


def _random_object(
    rng: Generator, p: AbstractParameters, shapes: tuple[str, ...], color: Color
) -> Object:
    return _object(rng, p, shapes[int(rng.integers(len(shapes)))], color, None)


def _object(
    rng: Generator,
    p: AbstractParameters,
    shape: str,
    color: Color,
    place: NDArray[np.float64] | None,
) -> Object:
    """Random size, proportions and orientation; without `place`, anywhere in the cube."""
    radius = rng.uniform(*p.radius)
    mesh = unit_mesh(shape)
    stretch = _proportions(rng, shape)
    stretch *= radius / farthest(mesh.vertices * stretch)
    if place is None:
        room = p.side / 2 - radius
        place = rng.uniform(-room, room, 3)
    matrix = placed(place, random_rotation(rng), stretch)
    return Object(mesh, matrix, color, target=color == target_color(p), kind=shape)


def _proportions(rng: Generator, shape: str) -> NDArray[np.float64]:
    if shape == "box":
        return rng.uniform(0.5, 1, 3)
    if shape == "cone":
        side = rng.uniform(0.6, 1)
        return np.array([side, 1.0, side])
    return np.ones(3)


def _disclosed(
    rng: Generator, p: AbstractParameters, objects: list[Object], fixed: int
) -> list[Object]:
    """The objects, those enclosed by another drawn again; the first `fixed` keep their place."""
    for _ in range(100):
        pairs = enclosing_pairs(objects)
        if not pairs:
            return objects
        for outer, inner in pairs:
            again = inner if inner >= fixed else outer
            old = objects[again]
            objects[again] = _object(rng, p, old.kind, old.color, None)
    raise NoScene(
        f"world.abstract.objects = {p.objects}, radius = {list(p.radius)}: expected room in a cube "
        f"of {p.side:g} for objects that do not enclose each other"
    )
