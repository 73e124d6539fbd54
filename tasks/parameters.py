"""What a study file may say about its scenes and controls; the defaults are the published study.

Source of the defaults: paper 004 §VI where it prints a number, else the comment says what we chose.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

SHAPES = ("sphere", "cone", "box", "torus")
PALETTES = ("published", "colour-blind-safe")


def _between(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise ValueError(f"{name} = {value}, expected a number from {low:g} to {high:g}")


def _range(name: str, value: tuple[float, float], low: float, high: float) -> None:
    if len(value) != 2 or not low <= value[0] <= value[1] <= high:
        raise ValueError(
            f"{name} = {list(value)}, expected [lowest, highest] from {low:g} to {high:g}"
        )


@dataclass(frozen=True)
class AbstractParameters:
    """The abstract world and the orbit about it. Lengths in world units, angles in radians.

    `radius` and `start_pitch` are ours, the paper prints neither; so are the drag of half a turn
    for the height of the view and the speed of the arrow keys.
    """

    side: float = 100.0
    objects: int = 200
    target_share: tuple[float, float] = (0.10, 0.20)
    radius: tuple[float, float] = (2.5, 5.0)
    shapes: tuple[str, ...] = SHAPES
    palette: str = "published"
    fov_y: float = pi / 3
    start_pitch: float = 0.35
    drag_gain: float = pi
    key_rate: float = 1.0

    def __post_init__(self) -> None:
        _between("side", self.side, 1, 1e4)
        _between("objects", self.objects, 1, 5000)
        _range("target_share", self.target_share, 0, 1)
        _range("radius", self.radius, 1e-3, self.side / 4)
        unknown = [s for s in self.shapes if s not in SHAPES]
        if unknown or not self.shapes or len(set(self.shapes)) < len(self.shapes):
            raise ValueError(f"shapes = {list(self.shapes)}, expected some of {list(SHAPES)}")
        if self.palette not in PALETTES:
            raise ValueError(f"palette = {self.palette!r}, expected one of {list(PALETTES)}")
        _between("fov_y", self.fov_y, 0.1, 2.5)
        _between("start_pitch", self.start_pitch, -pi / 2, pi / 2)
        _between("drag_gain", self.drag_gain, 0.1, 20)
        _between("key_rate", self.key_rate, 0.05, 10)
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

    name: str
    file: str
    size: float = 1.5
    up: str = "y"
    turn: float = 0.0
    detail: int = 30_000
    sha256: str = ""
    folder: str = ""
    reader: int = 1

    def __post_init__(self) -> None:
        if not (self.name.isprintable() and self.name.strip() and len(self.name) <= 32):
            raise ValueError(f"name = {self.name[:40]!r}, expected 1 to 32 printable characters")
        if not self.file.isprintable() or len(self.file) > 200 or not self.file:
            raise ValueError(f"file = {self.file[:40]!r}, expected a file beside the study")
        if self.up not in ("y", "z"):
            raise ValueError(f"up = {self.up!r}, expected 'y' or 'z'")
        _between("size", self.size, 0.01, 100)
        _between("turn", self.turn, -360, 360)
        _between("detail", self.detail, 0, 250_000)


@dataclass(frozen=True)
class BuildingParameters:
    """The building, what stands in it, and the walk through it. One world unit is half a metre.

    The paper prints the grid and the number of objects; sizes and speeds are ours: a building of
    80 × 80 units, doors 2.1 m high, eyes at 1.6 m, walking at 3 m/s. `count` is how often the
    asked type occurs in the counting task, `types` the models to use (none: all there are),
    `models` those that the study brings along.
    """

    grid: int = 16
    cell: float = 5.0
    room: int = 3
    wall_height: float = 5.0
    wall_thickness: float = 0.3
    door_width: float = 2.4
    door_height: float = 4.2
    objects: int = 50
    object_scale: float = 2.0
    object_radius: tuple[float, float] = (1.0, 2.2)
    count: tuple[int, int] = (4, 12)
    types: tuple[str, ...] = ()
    models: tuple[OwnModel, ...] = ()
    eye_height: float = 3.2
    fov_y: float = pi / 3
    speed: float = 6.0
    turn_gain: float = pi
    key_turn_rate: float = 1.5

    def __post_init__(self) -> None:
        _between("grid", self.grid, 2, 64)
        _between("room", self.room, 1, self.grid)
        _between("cell", self.cell, 1, 100)
        _between("wall_thickness", self.wall_thickness, 0.01, self.cell / 8)
        _between("door_width", self.door_width, 0.1, self.cell - 4 * self.wall_thickness)
        _between("wall_height", self.wall_height, 0.5, 100)
        _between("door_height", self.door_height, 0.1, 0.99 * self.wall_height)
        _between("eye_height", self.eye_height, 0.1, 0.99 * self.wall_height)
        _between("objects", self.objects, 1, 1000)
        _between("object_scale", self.object_scale, 0.01, 100)
        _range("object_radius", self.object_radius, 0.01, self.cell)
        _range("count", self.count, 1, self.objects)
        _between("fov_y", self.fov_y, 0.1, 2.5)
        _between("speed", self.speed, 0.1, 100)
        _between("turn_gain", self.turn_gain, 0.1, 20)
        _between("key_turn_rate", self.key_turn_rate, 0.05, 10)

    @property
    def side(self) -> float:
        """Length of an outer wall, inside."""
        return self.grid * self.cell
