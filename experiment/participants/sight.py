"""One look, as short as what it shows: what a table keeps, and what a person makes of it.

Of a building's hundred things a look shows a dozen, and thousands of people look from the same
places: what depends on the look alone is worked out once and kept with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from experiment.participants.glance import CLEAR, WINDOW_PIXELS, likely
from experiment.participants.profile import Profile
from renderer.scene import Scene
from renderer.visibility import Visibility


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
        return self.shown[0].astype(np.int64)

    def _all(self, row: int) -> NDArray[np.float64]:
        values = np.zeros(self.objects)
        values[self._index] = self.shown[row]
        return values

    @cached_property
    def pixels(self) -> NDArray[np.int64]:  # type: ignore[override]
        """(n,) see Visibility."""
        return self._all(1).astype(np.int64)

    @cached_property
    def weight(self) -> NDArray[np.float64]:  # type: ignore[override]
        """(n,) see Visibility."""
        return self._all(2)

    @cached_property
    def position(self) -> NDArray[np.float64]:  # type: ignore[override]
        """(n, 2) see Visibility."""
        position = np.full((self.objects, 2), np.nan)
        position[self._index] = self.shown[3:5].T
        return position

    @cached_property
    def contrast(self) -> NDArray[np.float64]:  # type: ignore[override]
        """(n,) see Visibility."""
        return self._all(5)

    @cached_property
    def area(self) -> NDArray[np.float64]:  # type: ignore[override]
        """(n,) see Visibility."""
        return self._all(6)


@dataclass(frozen=True, eq=False, slots=True)
class Sight:
    """A look at a building by somebody of a profile: lists of the k things visible that may be
    asked for.

    `notice` and `recognise` are chances, `weight` and `contrast` those of the look. `walls` has a
    bit set for each other object that is visible: walls are not looked at, but remembered.
    """

    index: list[int]
    notice: list[float]
    recognise: list[float]
    weight: list[float]
    contrast: list[float]
    walls: int


def sight(seen: Visibility, scene: Scene, profile: Profile) -> Sight:
    """The look `seen` of a scene; kept with looks that are kept themselves."""
    p = profile
    if not isinstance(seen, Kept):
        return _sight(shown(seen), scene, p)
    key = (p.notice, p.notice_spread, p.recognise, p.recognise_spread)
    found = seen.sights.get(key)
    if found is None:
        seen.sights.clear()  # calibration tries profile after profile
        found = seen.sights[key] = _sight(seen.shown, scene, p)
    return found


def _sight(rows: NDArray[np.float64], scene: Scene, p: Profile) -> Sight:
    asked = scene.targets[rows[0].astype(np.int64)]
    index, _, weight, _, _, contrast, area = rows[:, asked]
    pixels = area * WINDOW_PIXELS
    notice = likely(contrast * np.sqrt(pixels), p.notice, p.notice_spread)
    clear = pixels * np.minimum(contrast / CLEAR, 1.0)
    recognise = likely(clear, p.recognise, p.recognise_spread)
    return Sight(
        [int(i) for i in index.tolist()],
        notice.tolist(),
        recognise.tolist(),
        weight.tolist(),
        contrast.tolist(),
        sum(1 << int(i) for i in rows[0, ~asked].tolist()),
    )
