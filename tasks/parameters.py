"""What a study file may say about its scenes and controls; the defaults are the published study.

Source of the defaults: paper 004 §VI where it prints a number, else the comment says what we chose.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from seethrough.renderer.declared import Of, check, key

SHAPES = ("sphere", "cone", "box", "torus")
PALETTES = ("published", "colour-blind-safe")
METRES = 0.5  # in a world unit of the building; the abstract world has no size of its own


_UNDER_THE_CEILING = Of("99 % of `wall_height`", lambda p: 0.99 * p["wall_height"])


@dataclass(frozen=True)
class AbstractParameters:
    """The abstract world and the orbit about it. Lengths in world units, angles in radians.

    `radius` and `start_pitch` are ours, the paper prints neither; so are the drag of half a turn
    for the height of the view and the speed of the arrow keys.
    """

    side: float = key(100.0, "edge of the cube that things are in", "world units", low=1, high=1e4)
    objects: int = key(200, "things in the world, targets included", low=1, high=5000)
    target_share: tuple[float, float] = key(
        (0.10, 0.20), "share of the things that are targets (red), drawn from this range for each "
        "scene", low=0, high=1,
    )  # fmt: skip
    radius: tuple[float, float] = key(
        (2.5, 5.0), "how large things are: radius of the sphere about each", "world units",
        low=1e-3, high=Of("a quarter of `side`", lambda p: p["side"] / 4),
    )  # fmt: skip
    shapes: tuple[str, ...] = key(SHAPES, "what the things are", choices=SHAPES)
    palette: str = key(
        "published", "colours of targets and distractors: as published, or such that people who do "
        "not tell red from green can do the tasks", choices=PALETTES,
    )  # fmt: skip
    fov_y: float = key(pi / 3, "angle of view, from bottom to top", "radians", low=0.1, high=2.5)
    start_pitch: float = key(
        0.35, "how far from above the first view looks down", "radians", low=-pi / 2, high=pi / 2
    )
    drag_gain: float = key(
        pi, "turn for a drag over the height of the view", "radians", low=0.1, high=20
    )
    key_rate: float = key(1.0, "turn while an arrow key is held", "radians/s", low=0.05, high=10)

    def __post_init__(self) -> None:
        check(self)
        low, high = self.target_share
        if int(high * self.objects) < -int(-low * self.objects // 1):
            raise ValueError(
                f"target_share = [{low}, {high}], expected a range that holds a whole number of "
                f"{self.objects} objects"
            )


@dataclass(frozen=True)
class OwnModel:
    """A model of the study's own: a glTF, OBJ, STL or PLY file beside the study's.

    Participants read its `name`. `size`, `up`, `turn` and `detail` are those of
    renderer/models/user.py. `sha256` of its files, the `folder` they are in and the number of the
    `reader` that shows them are found out when the study is read; what an older reader showed has
    its number, so that a study under way cannot go on with other pictures.
    """

    name: str = key(..., "what participants read", said="1 to 32 printable characters")
    file: str = key(..., "its file, beside the study's", said="the name of a file beside the study")
    size: float = key(1.5, "its longest side", "world units", low=0.01, high=100)
    up: str = key("y", "the file's upward axis; z in most STL files", choices=("y", "z"))
    turn: float = key(
        0.0, "turn to the left, until its front faces away", "degrees", low=-360, high=360
    )
    detail: int = key(
        30_000, "most triangles to cut it into for what a texture shows", low=0, high=250_000
    )
    sha256: str = key(
        "", "its file's SHA-256, found out when the study is read; where it is set, it has to be "
        "that file's", said="64 hexadecimal digits, or empty",
    )  # fmt: skip
    folder: str = ""
    reader: int = key(
        1, "which of our readers shows it, found out when the study is read", low=1, high=1000
    )

    def __post_init__(self) -> None:
        check(self)
        if not (self.name.isprintable() and self.name.strip() and len(self.name) <= 32):
            raise ValueError(f"name = {self.name[:40]!r}, expected 1 to 32 printable characters")
        if not self.file.isprintable() or len(self.file) > 200 or not self.file:
            raise ValueError(f"file = {self.file[:40]!r}, expected a file beside the study")


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
