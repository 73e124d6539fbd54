"""One look, as short as what it shows: what a table keeps, and what a person makes of it.

Of a building's hundred things a look shows a dozen, and thousands of people look from the same
places: what depends on the look alone is worked out once and kept with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.skills.glance import CLEAR, WINDOW_PIXELS, likely
from seethrough.tasks.kit.skills.profile import Profile

BUILT = ("wall", "outer wall", "floor")


def shown(seen: Visibility) -> NDArray[np.float64]:
    """(7, k) index, pixels, weight, x, y, contrast and area of the k visible objects."""
    if isinstance(seen, Kept):
        return seen.shown
    index = np.nonzero(seen.pixels > 0)[0]
    columns = (index, seen.pixels[index], seen.weight[index], seen.position[index, 0],
               seen.position[index, 1], seen.contrast[index], seen.area[index])  # fmt: skip
    return np.stack(columns).astype(float)


class Kept(Visibility):
    """A look from a table: its arrays over all objects are made when somebody asks for them."""

    def __init__(self, objects: int, shown: NDArray[np.float64]) -> None:
        # Values of a frozen class: written past its guard, as its own `__init__` would.
        self.__dict__.update(objects=objects, shown=shown, sights={})

    objects: int
    shown: NDArray[np.float64]
    sights: dict[tuple[float, ...], Sight]

    @cached_property
    def _index(self) -> NDArray[np.int64]:
        index: NDArray[np.int64] = self.shown[0].astype(np.int64)
        return index

    def _all(self, row: int) -> NDArray[np.float64]:
        values = np.zeros(self.objects)
        values[self._index] = self.shown[row]
        return values

    @cached_property
    def pixels(self) -> NDArray[np.int64]:
        """(n,) see Visibility."""
        return self._all(1).astype(np.int64)

    @cached_property
    def weight(self) -> NDArray[np.float64]:
        """(n,) see Visibility."""
        return self._all(2)

    @cached_property
    def position(self) -> NDArray[np.float64]:
        """(n, 2) see Visibility."""
        position = np.full((self.objects, 2), np.nan)
        position[self._index] = self.shown[3:5].T
        return position

    @cached_property
    def contrast(self) -> NDArray[np.float64]:
        """(n,) see Visibility."""
        return self._all(5)

    @cached_property
    def area(self) -> NDArray[np.float64]:
        """(n,) see Visibility."""
        return self._all(6)


class Thing(NamedTuple):
    """Something visible that may be asked for, by its number in the scene.

    `notice` and `recognise` are somebody's chances, `clear` counts the pixels that show it clearly.
    """

    number: int
    notice: float
    recognise: float
    clear: float


@dataclass(frozen=True, eq=False, slots=True)
class Sight:
    """A look at a building by somebody of a profile: `things` that stand about in it, and `walls`
    (all else) with the chance that enough of one is seen to remember where it goes."""

    things: list[Thing]
    walls: dict[int, float]


def sight(seen: Visibility, scene: Scene, profile: Profile) -> Sight:
    """The look `seen` of a scene; kept with looks that are kept themselves."""
    if not isinstance(seen, Kept):
        return _sight(shown(seen), scene, profile)
    found = seen.sights.get(profile.eyes)
    if found is None:
        seen.sights.clear()  # calibration tries profile after profile
        found = seen.sights[profile.eyes] = _sight(seen.shown, scene, profile)
    return found


def _sight(rows: NDArray[np.float64], scene: Scene, p: Profile) -> Sight:
    numbers = rows[0].astype(np.int64)
    contrast, area = rows[5:7]
    pixels = area * WINDOW_PIXELS
    notice = likely(contrast * np.sqrt(pixels), p.notice, p.notice_spread)
    clear = pixels * np.minimum(contrast / CLEAR, 1.0)
    recognise = likely(clear, p.recognise, p.recognise_spread)
    asked = ~built(scene)[numbers]
    columns = (numbers[asked], notice[asked], recognise[asked], clear[asked])
    things = [Thing(*values) for values in zip(*(c.tolist() for c in columns), strict=True)]
    # A wall may fill the view, and then nothing sets it off: its pixels alone count.
    extent = likely(pixels[~asked], p.recognise, p.recognise_spread)
    return Sight(things, dict(zip(numbers[~asked].tolist(), extent.tolist(), strict=True)))


@lru_cache(maxsize=64)
def built(scene: Scene) -> NDArray[np.bool_]:
    """(n,) which objects are the building itself: walls and floors look like no thing (scenes are
    compared by identity)."""
    return np.array([thing.kind in BUILT for thing in scene.objects], dtype=bool)
