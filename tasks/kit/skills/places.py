"""The building as one has come to know it: what has been looked at, and which walls hide what.

A person knows from the floor plans how large the building is, sees walls where they are drawn,
and walls are remembered. Cells of five units, as wide as a step or two, are what is kept in mind.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache
from math import atan2, cos, sin

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import moved

Place = tuple[float, float]  # (x, z)
CELL = 5.0
THERE = 0.75 * CELL  # nearer than this to the middle of a cell one has reached it
DIRECTIONS = 8  # headings one looks and walks in: every 45°
# From one cell to the next in each heading: cells in (x, z), and the parts a step is walked in. One
# looks after each part: at the usual speed twice a second or more, across corners as well.
AHEAD = ((0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1))
STRIDES = (2, 3) * 4
HALF_VIEW = np.arctan(np.tan(np.pi / 6) * 4 / 3)  # half of the horizontal field of view
COS_HALF_VIEW = np.cos(HALF_VIEW)


class Grid:
    """The cells of a square building of `size` cells a side; their middles are `centers` (n, 2).

    What depends on a cell alone is worked out once, for all buildings of that size.
    """

    def __init__(self, size: int) -> None:
        line = (np.arange(size) + 0.5) * CELL - size * CELL / 2
        x, z = np.meshgrid(line, line, indexing="ij")
        self.size = size
        self.centers = np.stack([x.ravel(), z.ravel()], axis=1)
        self.sure: dict[tuple[float, ...], NDArray[np.float64]] = {}  # what walkers make of it
        self._ways: dict[int, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}
        self._units: dict[int, NDArray[np.float64]] = {}
        self._near: dict[int, NDArray[np.bool_]] = {}

    def cell(self, place: Place) -> int:
        """The cell in which (or nearest to which) a place lies."""
        half, last = self.size / 2, self.size - 1
        x, z = place
        i, j = min(max(int(x / CELL + half), 0), last), min(max(int(z / CELL + half), 0), last)
        return i * self.size + j

    def near(self, cell: int) -> NDArray[np.bool_]:
        """(n,) which cells one has reached who stands in the middle of `cell`."""
        if cell not in self._near:
            self._near[cell] = self.ways(cell)[0] < THERE
        return self._near[cell]

    def ways(self, cell: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(n,) how far and in which yaw every cell lies from the middle of `cell`."""
        if cell not in self._ways:
            way = self.centers - self.centers[cell]
            self._ways[cell] = np.hypot(way[:, 0], way[:, 1]), bearing(way)
        return self._ways[cell]

    def ahead(self, cell: int, yaw: NDArray[np.float64] | float) -> NDArray[np.bool_]:
        """(…, n) which cells lie in the picture, seen from the middle of `cell` at each yaw."""
        if cell not in self._units:
            toward = self.ways(cell)[1]
            self._units[cell] = np.stack([-np.sin(toward), -np.cos(toward)])
        across, along = self._units[cell]
        if isinstance(yaw, float):
            seen: NDArray[np.bool_] = across * -sin(yaw) + along * -cos(yaw) > COS_HALF_VIEW
            return seen
        facing = -np.sin(yaw)[..., None], -np.cos(yaw)[..., None]
        seen = across * facing[0] + along * facing[1] > COS_HALF_VIEW
        return seen


@lru_cache(maxsize=4)
def grid(size: int) -> Grid:
    """The one grid of that size."""
    return Grid(size)


@dataclass(eq=False)
class Layout:
    """Cells and walls of a scene. `segments` (n, 2, 2) in (x, z); `pieces` of a wall are of these.

    Which walls hide what from a cell is worked out once.
    """

    grid: Grid
    segments: NDArray[np.float64]
    pieces: dict[int, list[int]]
    _blocked: dict[int, NDArray[np.uint8]] = field(default_factory=dict)

    def hidden(self, cell: int, walls: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(n,) which cells one of these wall segments hides from the middle of `cell`."""
        if cell not in self._blocked:
            centers = self.grid.centers
            blocked = crossings(centers[cell], centers, self.segments).T
            self._blocked[cell] = np.packbits(blocked, axis=1)  # 300 MB of a study would be 40
        found = np.bitwise_or.reduce(self._blocked[cell].compress(walls, axis=0), axis=0)
        return np.unpackbits(found, count=len(self.grid.centers)).view(bool)


@lru_cache(maxsize=64)
def layout(scene: Scene) -> Layout:
    """The layout of a scene (scenes are compared by identity)."""
    return _read(scene)


def _read(scene: Scene) -> Layout:
    floor = next(o for o in scene.objects if o.kind == "floor")
    half = float(np.abs(moved(floor.mesh.vertices, floor.transform)[:, [0, 2]]).max())
    size = max(1, int(2 * half // CELL))
    segments: list[NDArray[np.float64]] = []
    pieces = {}
    for index, thing in enumerate(scene.objects):
        if thing.kind in ("wall", "outer wall"):
            own = _pieces(thing)
            pieces[index] = list(range(len(segments), len(segments) + len(own)))
            segments += own
    return Layout(grid(size), np.array(segments).reshape(-1, 2, 2), pieces)


def _pieces(wall: Object) -> list[NDArray[np.float64]]:
    """A wall's middle line in (x, z), open at its doorway."""
    along = np.unique(wall.mesh.vertices[:, 0].round(6))  # 0, the doorway, the length
    ends = np.zeros((len(along), 3))
    ends[:, 0] = along
    if wall.kind == "outer wall":
        corners = moved(wall.mesh.vertices, wall.transform)[:, [0, 2]]
        low, high = corners.min(axis=0), corners.max(axis=0)
        middle = (low + high) / 2
        long = np.argmax(high - low)
        a, b = middle.copy(), middle.copy()
        a[long], b[long] = low[long], high[long]
        return [np.array([a, b])]
    # Walls are as thick as they are: their middle lines must not leave a gap where they meet.
    ends[[0, -1], 0] += np.array([-1, 1]) * np.ptp(wall.mesh.vertices[:, 2])
    line = moved(ends, wall.transform)[:, [0, 2]]
    return [line[:2], line[2:]]


class Known:
    """What one knows of a building in a trial: arrays (n,) over cells, and a set of walls.

    Looking again from the same place shows the same things: of all looks from one place only the
    best counts, and looks from different places multiply.
    """

    def __init__(self, plan: Layout) -> None:
        n = len(plan.grid.centers)
        self.layout = plan
        self.walls = np.zeros(len(plan.segments), dtype=bool)
        self.unclear: dict[int, int] = {}  # things noticed but not made out → their cells
        self._before = np.ones(n)  # chance that a thing was missed from all places before this
        self._best = np.zeros(n)  # how sure one is of what is seen from here
        self._hidden: NDArray[np.bool_] | None = None

    @property
    def unseen(self) -> NDArray[np.float64]:
        """(n,) 1 where a thing could well be that was not seen, 0 where none can be."""
        unseen = self._before * (1.0 - self._best)
        if self.unclear:
            unseen[list(self.unclear.values())] = 1.0
        return unseen

    @property
    def left(self) -> float:
        """Share of the building not seen yet."""
        unseen = self.unseen
        return float(np.add.reduce(unseen)) / len(unseen)

    def see_walls(self, objects: Iterable[int]) -> None:
        """Remember the walls among objects, given by index, that are visible for the first time."""
        new = [k for index in objects for k in self.layout.pieces.get(index, ())]
        if new:
            self.walls[new], self._hidden = True, None

    def hidden(self, cell: int) -> NDArray[np.bool_]:
        """(n,) cells whose middle a known wall hides from `cell`, in which one stands."""
        if self._hidden is None:
            self._hidden = self.layout.hidden(cell, self.walls)
        return self._hidden

    def inspect(self, quality: NDArray[np.float64]) -> None:
        """Cells (n,) are looked at: `quality` is how sure a thing there would be seen."""
        self._best = np.maximum(self._best, quality)

    def gain(self, quality: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) how much would be seen anew by looking with that quality from here."""
        return self._before * np.maximum(quality - self._best, 0.0)

    def move(self) -> None:
        """One stands somewhere else now."""
        self._before, self._hidden = self._before * (1.0 - self._best), None
        self._best = np.zeros(len(self._best))

    def doubt(self) -> None:
        """All seen and nothing found: whatever was seen from elsewhere may have been missed."""
        self._before = np.ones(len(self._before))


def crossed(
    eye: NDArray[np.float64], points: NDArray[np.float64], segments: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) whether the way from `eye` to each point (n, 2) crosses one of the segments (m, 2, 2).

    A way through a segment's end crosses it: walls meet at their ends, and nobody sees between.
    A segment that only touches the eye or the point is not crossed.
    """
    found: NDArray[np.bool_] = np.any(crossings(eye, points, segments), axis=1)
    return found


def crossings(
    eye: NDArray[np.float64], points: NDArray[np.float64], segments: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n, m) whether the way from `eye` to each point crosses each segment; see `crossed`."""
    a, b = segments[:, 0] - eye, segments[:, 1] - eye
    way = points - eye
    # The way separates the segment's ends, and the segment separates the way's ends.
    side_a = way[:, None, 0] * a[:, 1] - way[:, None, 1] * a[:, 0]
    side_b = way[:, None, 0] * b[:, 1] - way[:, None, 1] * b[:, 0]
    span = b - a
    at_eye = span[:, 1] * a[:, 0] - span[:, 0] * a[:, 1]
    at_point = at_eye + span[:, 0] * way[:, None, 1] - span[:, 1] * way[:, None, 0]
    return (side_a * side_b <= 0) & (at_eye * at_point < 0)


def bearing(way: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) yaw in which the (x, z) ways lead: 0 along −z, positive to the left."""
    return np.arctan2(-way[..., 0], -way[..., 1])


def turn_to(x: float, z: float) -> float:
    """The same for one way."""
    return atan2(-x, -z)


def apart(a: float, b: float) -> float:
    """Angle from b to a, in (−π, π]."""
    return -((b - a + np.pi) % (2 * np.pi) - np.pi)
