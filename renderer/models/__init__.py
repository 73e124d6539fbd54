"""Recognisable things, built from code.

Every model stands on y = 0, is centred at x = z = 0, faces −z, and its longest side is 1 to 2
units: what differs in size in the world does not in the study, where all must be found alike.
`MODELS` maps each name to its builder; a builder makes its mesh once, so that scenes share it.
The jeep, a scene of its own, is in `jeep`, a user's own files are read by `user`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from seethrough.renderer.models import furniture, seats
from seethrough.renderer.models.forms.shapes import Shape, shade
from seethrough.renderer.models.nature import animals, plant, wildlife
from seethrough.renderer.models.vehicles import cars, craft, cycles, helicopter, motorbikes
from seethrough.renderer.scene.geometry import Mesh

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


def proxy(name: str) -> Mesh:
    """The model in 300 to 900 triangles, for outlines, masks and the simulated participant.

    Closed, in the model's place, of its mean colour, made once. Raises KeyError for no model.
    """
    from seethrough.renderer.models import proxies

    return proxies.proxy(name)
