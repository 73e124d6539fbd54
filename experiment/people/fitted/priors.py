"""Where each constant may lie: what its source leaves open, or a factor where it is ours.

The free ones are fitted, within a factor of the starting profile's value. A search over what could
be reached at all also moves constants that have a source, within what that says.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import exp, log

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.errors import InputError
from seethrough.tasks.kit.skills.profile import Profile

# What may be fitted, each within a factor of the starting profile's value.
FREE = {
    "pace": 3.0,  # decisions: all mental times
    "recheck": 4.0,  # thoroughness: telling a thing as counted already
    "worth": 4.0,  # thoroughness: seconds one would spend for one more thing
    "diligence": 4.0,  # thoroughness: how much of the building may stay unseen
    "cloud_depth": 2.0,  # sharpness: how surely a thing is known again in a world that turns
    "recognise": 2.0,  # sharpness: pixels from which a kind is told
    "slip": 4.0,  # care: things lost or counted twice
    "sd_person": 4.0,
    "sd_task": 4.0,
    "sd_trial": 4.0,
    "sd_care": 4.0,
    "sd_task_walking": 4.0,
    "sd_trial_walking": 4.0,
}


@dataclass(frozen=True)
class Interval:
    """Where a constant may lie, both above 0, and who says so."""

    low: float
    high: float
    source: str


# Not fitted: their sources say about what they are, and between which values.
SOURCED = {
    "subitise": Interval(0.04, 0.12, "Trick and Pylyshyn 1994: 40 to 120 ms"),
    "count": Interval(0.25, 0.35, "Trick and Pylyshyn 1994: 250 to 350 ms"),
    "search_slope": Interval(0.025, 0.05, "Guided Search 6: 25 to 50 ms"),
    "key": Interval(0.20, 0.28, "KLM: .20 to .28 s"),
    "bits_per_second": Interval(3.0, 5.5, "DeLong and MacKenzie 2018: 4.09, mice 3 to 5.5"),
    "depth_bias": Interval(0.7, 1.0, "Loomis and Knapp 2003: distances look short"),
    "depth_noise": Interval(0.06, 0.24, "ours, factor 2"),
    "drift": Interval(0.05, 0.20, "ours, factor 2"),
    "notice": Interval(0.3, 1.2, "ours, factor 2"),
    "crowded": Interval(0.175, 0.70, "ours, factor 2"),
    "learning": Interval(0.15, 0.70, "Heathcote and others 2000; ours, factor 2"),
}


def intervals(start: Profile) -> dict[str, Interval]:
    """Every constant that a search moves: the free ones, then those that have a source."""
    free = {
        name: Interval(value / factor, min(value * factor, _MOST.get(name, np.inf)), "ours")
        for name, factor in FREE.items()
        if (value := getattr(start, name)) > 0
    }
    return free | SOURCED


_MOST = {"diligence": 1.0, "slip": 1.0}  # shares


def at(start: Profile, within: Mapping[str, Interval], u: NDArray[np.float64]) -> Profile:
    """The profile with these constants at `u` (constants,), 0 at the low end of each interval and 1
    at the high one, evenly in the logarithm."""
    changes = {
        name: exp(log(own.low) + float(np.clip(part, 0, 1)) * log(own.high / own.low))
        for (name, own), part in zip(within.items(), u, strict=True)
    }
    return Profile(**{**asdict(start), **changes})


def with_free(profile: Profile, x: NDArray[np.float64]) -> Profile:
    """The profile with its free constants scaled by exp(x), within their bounds."""
    changes = {}
    for (name, factor), value in zip(FREE.items(), x, strict=True):
        scale = exp(float(np.clip(value, -log(factor), log(factor))))
        changes[name] = min(getattr(profile, name) * scale, _MOST.get(name, np.inf))
    return replace(profile, **changes)


def moved(start: Profile, profile: Profile) -> NDArray[np.float64]:
    """(free constants,) by which logarithm each differs from where the fit began."""
    return np.log([getattr(profile, n) / getattr(start, n) for n in FREE])


def begun(start: Profile, at: str) -> Profile:
    """The profile with the free constants that `at` says: "worth=30,pace=0.9". Raises InputError
    for what is not free or lies outside its interval."""
    own = intervals(start)
    changes: dict[str, float] = {}
    for part in filter(None, at.split(",")):
        name, _, said = part.partition("=")
        value = _number(said)
        within = own[name] if name in FREE and name in own else None
        if within is None or value is None or not within.low <= value <= within.high:
            known = ", ".join(f"{n} {own[n].low:g} to {own[n].high:g}" for n in FREE if n in own)
            raise InputError(f"--at {part}: expected NAME=VALUE with one of {known}")
        changes[name] = value
    return Profile(**{**asdict(start), **changes})


def _number(text: str) -> float | None:
    """The number that a text says, or None."""
    try:
        return float(text)
    except ValueError:
        return None
