"""What a simulated participant has before its eyes, and what it makes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import asin, atan2

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.events import Event
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.profile import Profile

# Thresholds count the pixels of a window of 800 × 600, whatever the size of the id picture.
WINDOW_PIXELS = 480_000


@dataclass(frozen=True, eq=False)
class Glance:
    """What is displayed now; `look` draws and measures it, which costs time on the machine."""

    view: View
    look: Callable[[], Visibility]
    now: float


# A strategy gives the next events and gets what is displayed after them.
Strategy = Iterator[list[Event]]


def heading(view: View) -> tuple[float, float]:
    """(yaw, height) in radians: which way one looks, and from how far above one looks down."""
    rotation = view.camera.rotation
    return atan2(-rotation[2, 0], rotation[0, 0]), asin(min(1.0, max(-1.0, rotation[1, 2])))


def likely(strength: NDArray[np.float64], half: float, spread: float) -> NDArray[np.float64]:
    """Probability that something of that strength gets through: ½ at `half`, logistic in its ln."""
    # Whatever is weaker than e^-50 of the threshold is as good as that.
    z = np.log(np.maximum(strength, half * 1e-20) / half) / spread
    return 1.0 / (1.0 + np.exp(np.minimum(-1.702 * z, 700.0)))


def window_pixels(seen: Visibility) -> NDArray[np.float64]:
    """(n,) pixels of the window that show each object, those half shown counted half."""
    return seen.area * WINDOW_PIXELS


def clear_pixels(seen: Visibility, index: NDArray[np.int64]) -> NDArray[np.float64]:
    """(k,) of these things, the pixels that show them as clearly as pixels can."""
    clear: NDArray[np.float64] = (
        seen.area[index] * WINDOW_PIXELS * np.minimum(seen.contrast[index] / CLEAR, 1.0)
    )
    return clear


def blurred(clear: NDArray[np.float64], p: Profile) -> NDArray[np.float64]:
    """How many times less sure the distance of a thing is than that of one seen large and clear.

    Variances add up; that of a thing whose kind can be told half of the time is twice as large.
    """
    return np.sqrt(1 + p.recognise / np.maximum(clear, 1.0))


def noticed(seen: Visibility, mood: Mood) -> NDArray[np.int64]:
    """Indices of what is noticed in one look: contrast × √pixels against a threshold.

    The square root is spatial summation as an ideal observer of white noise has it. Luck is drawn
    for every object of the scene, so that more visible things meet the same luck, and more of it.
    """
    p = mood.profile
    index = np.nonzero(seen.pixels > 0)[0]
    strength = seen.contrast[index] * np.sqrt(seen.area[index] * WINDOW_PIXELS)
    chance = likely(strength, p.notice, p.notice_spread)
    return index[mood.rng.random(len(seen.pixels))[index] < chance]


def recognised(seen: Visibility, index: NDArray[np.int64], mood: Mood) -> NDArray[np.bool_]:
    """Of what is noticed, whose kind can be told: enough pixels that stand out."""
    p = mood.profile
    chance = likely(clear_pixels(seen, index), p.recognise, p.recognise_spread)
    return mood.rng.random(len(seen.pixels))[index] < chance


CLEAR = 0.2  # contrast above which a thing is as clear as it gets [ours]


def uncrowded(
    seen: Visibility, index: NDArray[np.int64], mood: Mood
) -> tuple[NDArray[np.int64], int]:
    """What is left after crowding, and how many were lost: near neighbours run together."""
    if not mood.uses("crowding"):
        return index, 0
    luck = mood.rng.random(len(seen.pixels))
    place = seen.position[index]
    apart = np.hypot(*np.moveaxis(place[:, None] - place[None], -1, 0))
    np.fill_diagonal(apart, np.inf)
    # Of a crowded pair only the weaker one can be lost.
    weaker = window_pixels(seen)[index]
    crowded = ((apart < mood.profile.crowding) & (weaker[:, None] <= weaker[None])).any(axis=1)
    lost = crowded & (luck[index] < mood.profile.crowded)
    return index[~lost], int(lost.sum())
