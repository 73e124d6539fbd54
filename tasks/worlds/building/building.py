"""The building of the walkthrough: a random floor with 50 things to find in it (Elmqvist2009
§VI)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed, rotation_y
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.kit.own_models import mesh_of
from seethrough.tasks.kit.tags import with_kind_tags
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters
from seethrough.tasks.worlds.building.floor import Floor, random_floor
from seethrough.tasks.worlds.building.walls import inner_walls, rooms, shell

Models = Mapping[str, Callable[[], Mesh]]

START_CLEARANCE = 3.0  # no object so near the start that the walker begins inside it
DOOR_CLEARANCE = 1.5  # free space before and behind a doorway


@dataclass(frozen=True, eq=False)
class Building:
    """A scene of the walkthrough, and the type of thing the task asks for.

    `floor` is the plan; `start` the walker's first place (x, z).
    """

    scene: Scene
    floor: Floor
    parameters: BuildingParameters
    asked: str
    start: tuple[float, float]

    @cached_property
    def asked_objects(self) -> list[int]:
        """Indices of the objects of the asked type."""
        return [i for i, o in enumerate(self.scene.objects) if o.kind == self.asked]


def unique_building(
    rng: Generator, parameters: BuildingParameters, models: Models | None = None
) -> Building:
    """A building in which exactly one type occurs once, every other type at least twice (T3)."""
    names = _names(parameters, models)
    free = parameters.objects - 1
    if free and (len(names) < 2 or free < 2):
        raise NoScene(
            f"world.building.objects = {parameters.objects}, types = {names}: expected one object "
            "of one type and at least two each of others"
        )
    asked, *others = _shuffled(rng, names)
    others = others[: free // 2]
    counts = {asked: 1} | _shares(rng, others, free, least=2)
    return _furnished(rng, parameters, models, asked, counts)


def count_building(
    rng: Generator, parameters: BuildingParameters, models: Models | None = None
) -> Building:
    """A building with a random number of one type (T4), the rest any mixture of the others."""
    names = _names(parameters, models)
    asked, *others = _shuffled(rng, names)
    truth = int(rng.integers(parameters.count[0], parameters.count[1] + 1))
    if truth < parameters.objects and not others:
        raise NoScene(f"world.building.types = {names}: expected at least two")
    counts = {asked: truth} | _shares(rng, others, parameters.objects - truth, least=0)
    return _furnished(rng, parameters, models, asked, counts)


def _library(p: BuildingParameters, models: Models | None) -> Models:
    if models is not None:
        return models
    from seethrough.renderer.models import (
        MODELS,
    )  # the meshes are only built by those who need them

    return {**MODELS, **{own.name: partial(mesh_of, own) for own in p.models}}


def _names(p: BuildingParameters, models: Models | None) -> list[str]:
    library = _library(p, models)
    unknown = [t for t in p.types if t not in library]
    if unknown:
        raise ValueError(f"types = {unknown}, expected some of {sorted(library)}")
    return sorted(p.types or library)


def _shuffled(rng: Generator, names: list[str]) -> list[str]:
    return [names[i] for i in rng.permutation(len(names))]


def _shares(rng: Generator, names: list[str], total: int, least: int) -> dict[str, int]:
    """How many of each: `least` each, the rest evenly likely among them."""
    if not names:
        return {}
    extra = rng.multinomial(total - least * len(names), [1 / len(names)] * len(names))
    return {name: least + int(n) for name, n in zip(names, extra, strict=True)}


def _furnished(
    rng: Generator,
    p: BuildingParameters,
    models: Models | None,
    asked: str,
    counts: dict[str, int],
) -> Building:
    """The building with `counts` objects of each type, in a random order."""
    library = _library(p, models)
    floor = random_floor(rng, p)
    cells = p.grid // 2 + 0.5
    start = (cells * p.cell - p.side / 2,) * 2
    kinds = _shuffled(rng, [name for name, n in sorted(counts.items()) for _ in range(n)])
    sizes = {name: shown_size(library[name](), p) for name in sorted(counts)}
    places = _places(rng, p, floor, start, np.array([sizes[k][1] for k in kinds]))
    things = []
    for kind, (x, z) in zip(kinds, places, strict=True):
        mesh, scale = library[kind](), sizes[kind][0]
        matrix = placed((x, 0.0, z), rotation_y(rng.uniform(0, 2 * np.pi)), scale)
        things.append(Object(mesh, matrix, target=True, kind=kind))
    scene = with_kind_tags(Scene((*things, *inner_walls(floor, p), *shell(p))), p.tags)
    scene = replace(scene, rooms=rooms(floor, p, scene))
    return Building(scene, floor, p, asked, start)


def shown_size(mesh: Mesh, p: BuildingParameters) -> tuple[float, float]:
    """(scale, radius of the footprint about the mesh's origin), in world units.

    Models are scaled alike, but never beyond `object_radius`: a truck must pass for furniture's
    neighbour, a cat must be seen across a room.
    """
    low, high = p.object_radius
    scale = float(np.clip(p.object_scale * mesh.radius, low, high) / mesh.radius)
    footprint = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2]).max()
    return scale, float(footprint * scale)


def _places(
    rng: Generator,
    p: BuildingParameters,
    floor: Floor,
    start: tuple[float, float],
    radii: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(n, 2) random places at which no footprint meets a wall, a doorway, another or the start.

    The largest are placed first, so that the small ones fill what is left.
    """
    places = np.full((len(radii), 2), np.nan)
    blocked = _blocked(p, floor)
    done: list[int] = []
    for i in np.argsort(-radii, kind="stable"):
        for _ in range(2000):
            half = p.side / 2 - radii[i]
            place = rng.uniform(-half, half, 2)
            others = places[done]
            near = np.hypot(*(others - place).T) < radii[done] + radii[i]
            if not (
                near.any()
                or np.hypot(*(place - start)) < START_CLEARANCE + radii[i]
                or (_distance_to_boxes(place, blocked) < radii[i]).any()
            ):
                break
        else:
            raise NoScene(
                f"world.building.objects = {p.objects}, object_radius = {list(p.object_radius)}: "
                f"expected room for them on a floor of {p.side:g} × {p.side:g}"
            )
        places[i] = place
        done.append(int(i))
    return places


def _blocked(p: BuildingParameters, floor: Floor) -> NDArray[np.float64]:
    """(n, 2, 2) rectangles, lowest and highest (x, z): the inner walls, and before their doors."""
    boxes = []
    for wall in floor.walls:
        t = p.wall_thickness / 2
        along = [(wall.start - t, wall.end + t), (wall.level - t, wall.level + t)]
        half, free = p.door_width / 2, DOOR_CLEARANCE + t
        door = [(wall.door - half, wall.door + half), (wall.level - free, wall.level + free)]
        for extent in (along, door):
            x, z = extent if wall.axis == 0 else extent[::-1]
            boxes.append([(x[0], z[0]), (x[1], z[1])])
    return np.array(boxes).reshape(-1, 2, 2)


def _distance_to_boxes(
    place: NDArray[np.float64], boxes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n,) distance of a point (2,) from each rectangle, 0 inside."""
    outside = np.maximum(np.maximum(boxes[:, 0] - place, place - boxes[:, 1]), 0)
    return np.hypot(outside[:, 0], outside[:, 1])
