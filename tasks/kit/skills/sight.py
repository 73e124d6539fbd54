"""One look, as short as what it shows: what a table keeps, and what a person makes of it.

Of a building's hundred things a look shows a dozen, and thousands of people look from the same
places: what depends on the look alone is worked out once and kept with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.skills.glance import CLEAR, WHOLE, WINDOW_PIXELS, likely
from seethrough.tasks.kit.skills.profile import Profile


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

    `notice` and `recognise` are somebody's chances, `weight` and `contrast` those of the look.
    """

    number: int
    notice: float
    recognise: float
    weight: float
    contrast: float


@dataclass(frozen=True, eq=False, slots=True)
class Sight:
    """A look at a building by somebody of a profile: the things visible that may be asked for.

    Of all other objects that are visible `walls` holds the indices: they are not looked at, but
    remembered. `whole` are those of the things that show opaquely.
    """

    things: list[Thing]
    whole: frozenset[int]
    walls: frozenset[int]


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
    asked = scene.targets[numbers]
    _, _, weight, _, _, contrast, area = rows[:, asked]
    pixels = area * WINDOW_PIXELS
    notice = likely(contrast * np.sqrt(pixels), p.notice, p.notice_spread)
    clear = pixels * np.minimum(contrast / CLEAR, 1.0)
    recognise = likely(clear, p.recognise, p.recognise_spread)
    columns = (numbers[asked], notice, recognise, weight, contrast)
    things = [Thing(*values) for values in zip(*(c.tolist() for c in columns), strict=True)]
    whole = frozenset(thing.number for thing in things if thing.weight >= WHOLE)
    return Sight(things, whole, frozenset(numbers[~asked].tolist()))
