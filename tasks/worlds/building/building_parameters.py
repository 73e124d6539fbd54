"""What a study may say of the building and the walk through it; the defaults are the published
study's, or ours where the paper prints none."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from seethrough.renderer.declared import Of, check, key
from seethrough.tasks.kit.own_models import OwnModel
from seethrough.tasks.kit.tags import KindTag
from seethrough.tasks.kit.world import scenes

METRES = 0.5  # in a world unit of the building; the abstract world has no size of its own

_UNDER_THE_CEILING = Of("99 % of `wall_height`", lambda p: 0.99 * p["wall_height"])


@dataclass(frozen=True)
class BuildingParameters:
    """The building, what stands in it, and the walk through it.

    One world unit is METRES. The paper prints the grid and the number of objects; sizes and
    speeds are ours: a building of 80 × 80 units, doors 2.1 m high, eyes at 1.6 m, walking at 3
    m/s. `count` is how often the asked type occurs in the counting task, `types` the models to
    use (none: all there are), `models` those that the study brings along.
    """

    grid: int = key(16, "cells along each outer wall", low=2, high=64)
    cell: float = key(5.0, "edge of a cell of the floor", "world units", low=1, high=100)
    room: int = key(
        3, "rooms are at least so wide, in both directions", "cells",
        low=1, high=Of("`grid`", lambda p: p["grid"]),
    )  # fmt: skip
    wall_height: float = key(5.0, "height of the walls", "world units", low=0.5, high=100)
    wall_thickness: float = key(
        0.3, "thickness of the walls", "world units",
        low=0.01, high=Of("an eighth of `cell`", lambda p: p["cell"] / 8),
    )  # fmt: skip
    door_width: float = key(
        2.4, "width of the doorways", "world units", low=0.1,
        high=Of("`cell` − 4 × `wall_thickness`", lambda p: p["cell"] - 4 * p["wall_thickness"]),
    )  # fmt: skip
    door_height: float = key(
        4.2, "height of the doorways", "world units", low=0.1, high=_UNDER_THE_CEILING
    )
    objects: int = key(50, "things in the building", low=1, high=1000)
    object_scale: float = key(
        2.0, "what models are scaled by, within `object_radius`", low=0.01, high=100
    )
    object_radius: tuple[float, float] = key(
        (1.0, 2.2), "how small and how large a thing may become: radius of the sphere about it",
        "world units", low=0.01, high=Of("`cell`", lambda p: p["cell"]),
    )  # fmt: skip
    count: tuple[int, int] = key(
        (4, 12), "how many things of the asked kind there are in the counting task, drawn from "
        "this range", low=1, high=Of("`objects`", lambda p: p["objects"]),
    )  # fmt: skip
    types: tuple[str, ...] = key(
        (), "models that stand in the building; none: all there are",
        said="an array of three or more names of models, each once",
    )  # fmt: skip
    models: tuple[OwnModel, ...] = key(
        (), "models of the study's own, a table `[[walkthrough.models]]` each"
    )
    tags: tuple[KindTag, ...] = key(
        (), "what things of a kind are; kinds are the models' names, `wall`, `outer wall`, `floor`"
    )
    scenes: str = scenes("shared")
    eye_height: float = key(
        3.2, "height of the eyes above the floor", "world units", low=0.1, high=_UNDER_THE_CEILING
    )
    fov_y: float = key(pi / 3, "angle of view, from bottom to top", "radians", low=0.1, high=2.5)
    speed: float = key(6.0, "walking speed", "world units/s", low=0.1, high=100)
    turn_gain: float = key(
        pi, "turn for a movement of the pointer over the height of the view", "radians",
        low=0.1, high=20,
    )  # fmt: skip
    key_turn_rate: float = key(
        1.5, "turn while the left or right arrow key is held", "radians/s", low=0.05, high=10
    )

    def __post_init__(self) -> None:
        check(self)

    @property
    def side(self) -> float:
        """Length of an outer wall, inside."""
        return self.grid * self.cell
