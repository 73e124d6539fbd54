"""Counting what one looks at: how long it takes, and where it goes wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.tasks.kit.skills.mood import Mood


def seconds_to_count(places: NDArray[np.float64], mood: Mood) -> float:
    """Time to count things that stand out, at (n, 2) places on the view.

    As many as are taken in at a glance (four) cost a fraction of a count each, wherever they are;
    every further one is counted on the way from the nearest that is not counted yet, with a saccade
    of its own.
    """
    p = mood.profile
    if len(places) == 0:
        return 0.0
    glance = min(len(places), p.subitising_range) if mood.uses("subitising") else 0
    first = p.attention_shift + p.subitise * glance
    counted = _steps(places)[max(glance - 1, 0) :] if len(places) > glance else []
    if not glance:
        first += p.count
    return first + sum(p.count + saccade(step, mood) for step in counted)


def saccade(distance: float, mood: Mood) -> float:
    """Seconds for the eyes to go that far on the view (view heights)."""
    p = mood.profile
    return p.saccade + p.saccade_per_degree * distance * p.view_angle


def _steps(places: NDArray[np.float64]) -> list[float]:
    """Lengths of the steps of a way through all places, always on to the nearest one left."""
    apart = np.hypot(*np.moveaxis(places[:, None] - places[None], -1, 0))
    here = int(np.argmin(places.sum(axis=1)))
    steps: list[float] = []
    apart[:, here] = np.inf
    for _ in range(len(places) - 1):
        nearest = int(np.argmin(apart[here]))
        steps.append(float(apart[here, nearest]))
        apart[:, nearest] = np.inf
        here = nearest
    return steps


def slips(count: int, mood: Mood) -> int:
    """How far a count of so many things is off: each may be passed over or counted twice."""
    if not mood.uses("slips") or count == 0:
        return 0
    chance = min(1.0, mood.profile.slip / mood.care)
    passed, twice = mood.rng.binomial(count, chance, 2)
    return int(twice) - int(passed)
