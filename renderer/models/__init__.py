"""Recognisable things, built from code.

Every model stands on y = 0, is centred at x = z = 0, faces −z and is 1 to 2 units long, wide or
high. `MODELS` maps each name to its builder; a builder makes its mesh once, so scenes share it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from renderer.geometry import Mesh
from renderer.models import (
    animals,
    cars,
    craft,
    cycles,
    furniture,
    helicopter,
    motorbikes,
    plant,
    seats,
    wildlife,
)
from renderer.models.shapes import Shape, shade

BUILDERS: tuple[Callable[[], Shape], ...] = (
    animals.cat,
    animals.dog,
    animals.horse,
    animals.bird,
    wildlife.elephant,
    wildlife.rabbit,
    cycles.bike,
    motorbikes.motorbike,
    cars.car,
    cars.truck,
    craft.plane,
    helicopter.helicopter,
    craft.boat,
    seats.chair,
    seats.directors_chair,
    seats.armchair,
    seats.sofa,
    seats.bed,
    furniture.table,
    furniture.lamp,
    furniture.bookshelf,
    furniture.piano,
    furniture.television,
    plant.plant,
)


def _shaded(build: Callable[[], Shape]) -> Callable[[], Mesh]:
    return cache(lambda: shade(build()))


MODELS: dict[str, Callable[[], Mesh]] = {build.__name__: _shaded(build) for build in BUILDERS}
