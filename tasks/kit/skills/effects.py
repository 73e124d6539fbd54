"""Which effects a trial calls for, each with its reason; nothing else is worked out.

`--without NAME` leaves an effect out everywhere, `--explain` prints what a trial used and why.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

EFFECTS = {
    "crowding": "things close together on the view hide one another",
    "subitising": "up to four things are counted at a glance",
    "slips": "things are lost or counted twice in passing",
    "view_changes": "what was counted is mixed up when the view turns",
    "motor_noise": "turns do not end exactly where they should",
    "depth_noise": "distances are misjudged, more so of what shows little of itself",
    "drift": "one's own place is misjudged after walking",
    "learning": "the first trials of a task take longer",
    "fatigue": "times vary more as the session goes on",
    "people": "people differ in pace and care",
    "trial_noise": "times vary from trial to trial",
}

# Of those that a task may not call for, what to say then (tasks/kit/skills/strategy.py says why one
# does).
UNCALLED = {
    "crowding": "few things on the view at once",
    "subitising": "no groups are counted at a glance",
    "slips": "nothing is counted",
    "view_changes": "no count goes from view to view",
    "depth_noise": "no walking",
    "drift": "no walking",
}


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


def plan_effects(
    called: Mapping[str, str], trials_done: int, without: frozenset[str]
) -> dict[str, EffectUse]:
    """Each effect with whether a trial needs it: of UNCALLED those that its task has `called` for,
    each with a reason. `trials_done`: of this task before."""
    uses = {}
    for effect in EFFECTS:
        if effect in without:
            uses[effect] = EffectUse(effect, False, "left out by --without")
        else:
            uses[effect] = EffectUse(effect, *_needed(effect, called, trials_done))
    return uses


def _needed(effect: str, called: Mapping[str, str], trials_done: int) -> tuple[bool, str]:
    if effect in UNCALLED:
        return effect in called, called.get(effect, UNCALLED[effect])
    if effect == "learning":
        return True, f"trial {trials_done + 1} of this task"
    reasons = {
        "motor_noise": "the view is turned by hand",
        "fatigue": "a session takes up to 80 minutes",
        "people": "drawn once per person",
        "trial_noise": "drawn once per trial",
    }
    return True, reasons[effect]
