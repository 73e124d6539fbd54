"""Which effects a trial calls for, each with its reason; nothing else is worked out.

`--without NAME` leaves an effect out everywhere, `--explain` prints what a trial used and why.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

EFFECTS = {
    "crowding": "things close together on the view hide one another",
    "subitising": "up to four things are counted at a glance",
    "slips": "things are lost or counted twice in passing",
    "view_changes": "what was counted is mixed up when the view turns",
    "motor_noise": "turns do not end exactly where they should",
    "depth_noise": "distances are misjudged, more so through transparent things",
    "drift": "one's own place is misjudged after walking",
    "learning": "the first trials of a task take longer",
    "fatigue": "times vary more as the session goes on",
    "people": "people differ in pace and care",
    "trial_noise": "times vary from trial to trial",
}

_COUNTING = ("count", "count_in_building")
WALKING = ("unique", "count_in_building")


@dataclass(frozen=True)
class EffectUse:
    """Whether an effect was used in a trial, and the reason."""

    effect: str
    used: bool
    reason: str


def checked(without: Iterable[str]) -> frozenset[str]:
    """The names, if all are effects. Raises ValueError that lists the names there are."""
    names = frozenset(without)
    unknown = sorted(names - set(EFFECTS))
    if unknown:
        raise ValueError(f"--without = {', '.join(unknown)}: expected some of {', '.join(EFFECTS)}")
    return names


def plan_effects(task: str, trials_done: int, without: frozenset[str]) -> dict[str, EffectUse]:
    """Each effect with whether a trial of `task` needs it. `trials_done`: of this task before."""
    uses = {}
    for effect in EFFECTS:
        if effect in without:
            uses[effect] = EffectUse(effect, False, "left out by --without")
        else:
            uses[effect] = EffectUse(effect, *_needed(effect, task, trials_done))
    return uses


def _needed(effect: str, task: str, trials_done: int) -> tuple[bool, str]:
    if effect == "subitising":
        many = task == "count"
        return many, "many things at a glance" if many else "no groups are counted at a glance"
    if effect == "slips":
        return task in _COUNTING, "counting" if task in _COUNTING else "nothing is counted"
    if effect == "view_changes":
        return (task == "count"), (
            "counting over several views" if task == "count" else "no count goes from view to view"
        )
    if effect in ("depth_noise", "drift"):
        return task in WALKING, "places in the building" if task in WALKING else "no walking"
    if effect == "crowding":
        flat = task in ("count", "pattern")
        return flat, "many small things on the view" if flat else "few things on the view at once"
    if effect == "learning":
        return True, f"trial {trials_done + 1} of this task"
    reasons = {
        "motor_noise": "the view is turned by hand",
        "fatigue": "a session takes up to 80 minutes",
        "people": "drawn once per person",
        "trial_noise": "drawn once per trial",
    }
    return True, reasons[effect]
