"""Counting what one looks at: how long it takes, and where it goes wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.tasks.kit.skills.mood import Mood

CLUSTER = 0.06  # things nearer than this on the view, in its heights, are one glance (2°) [ours]


def seconds_to_count(places: NDArray[np.float64], mood: Mood) -> float:
    """Time to count things at (n, 2) places on the view, from one to the nearest not yet counted.

    Up to four close together are subitised; each next group, and each thing beyond four, is
    counted. Every move of the eyes costs a shift of attention and a saccade by its angle.
    """
    p = mood.profile
    if len(places) == 0:
        return 0.0
    most = p.subitising_range if mood.uses("subitising") else 1
    steps = _steps(places)
    total, in_group = p.attention_shift + p.count, 1
    for step in steps:
        if step < CLUSTER and in_group < most:
            total += p.subitise
            in_group += 1
        else:
            total += p.count + p.attention_shift + saccade(step, mood)
            in_group = 1
    return total


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
