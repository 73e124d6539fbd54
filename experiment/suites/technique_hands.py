"""What a technique makes of what hands do: whether it reaches, and whether it can be replayed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.suites.finding import Finding, NothingToTest
from seethrough.experiment.suites.technique_scenes import Case
from seethrough.experiment.suites.variants import pairwise
from seethrough.renderer import events
from seethrough.renderer.techniques import base
from seethrough.tasks.kit.gestures import after as gestures_done

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Technique

SIZE = (96, 72)
MOST_WORKING = 3  # parameters tried for hands that work with some only
Draw = Callable[[Case, base.Parameters, object], NDArray[np.uint8]]


def played(technique: Technique, case: Case, p: base.Parameters) -> object:
    """The state after some events of every kind."""
    return _walked(technique, case, p)[-1].state


@dataclass(frozen=True)
class _Step:
    """An event, whether it was used up and changed the state, and the state after it."""

    event: events.Event
    used: bool
    changed: bool
    state: object


def _walked(technique: Technique, case: Case, p: base.Parameters) -> list[_Step]:
    shot = base.Shot(case.scene, case.camera, SIZE)
    state, steps = technique.begin(p), []
    for event in some_events(technique.takes):
        before = state
        state, used = technique.on_event(p, state, event, shot)
        steps.append(_Step(event, used, bool(state != before), state))
    return steps


def reaches(technique: Technique, cases: Sequence[Case], picture: Draw) -> Finding:
    """Hands that reach for a point of the world by what it takes change what it shows there.

    Tried with the parameters as they are; where hands do nothing then, with some others with which
    they do. Raises NothingToTest where they never do.
    """
    plain = technique.Parameters()
    some = [plain, *pairwise(plain, np.random.default_rng(12))]
    working = [p for p in some if technique.active(p)][:MOST_WORKING]
    if not working:
        raise NothingToTest("what it shows never depends on what hands do")
    working = working[:1] if technique.active(plain) else working
    wrong, changed = [], 0
    for p, case in product(working, cases):
        shot = base.Shot(case.scene, case.camera, SIZE)
        point = case.scene.centers[np.nonzero(case.scene.targets)[0][-1]]
        before = technique.begin(p)
        gestures = technique.reach(p, before, shot, point)
        strange = {g.event for g in gestures} - technique.takes
        state = gestures_done(p, before, shot, gestures)
        same = np.array_equal(picture(case, p, None), picture(case, p, state))
        wrong += [f"{case.name}: uses {', '.join(sorted(strange))}"] if strange else []
        changed += not same
    if not changed:
        wrong.append("nothing changes in any scene")
    return Finding("reaches", not wrong, "; ".join(wrong) or f"{changed} pictures changed")


def replayed(technique: Technique, case: Case) -> Finding:
    """The same events lead to the same state; only what it takes is used up or changes it; and
    all that it takes does so, with some parameters."""
    p, takes = technique.Parameters(), technique.takes
    steps, again = _walked(technique, case, p), _walked(technique, case, p)
    tried = [steps, *(_walked(technique, case, q) for q in pairwise(p, np.random.default_rng(12)))]
    every = [step for walked in tried for step in walked]
    heard = {events.taken_as(step.event) for step in every if step.used or step.changed}
    strange = {events.taken_as(step.event) for step in every if step.used} - takes
    strange |= heard - takes - {""}  # time may change anything
    if [step.state for step in steps] != [step.state for step in again]:
        return Finding("replay", False, "another state from the same events")
    if strange:
        names = ", ".join(sorted(strange))
        return Finding("replay", False, f"answers to {names}, which it does not say it takes")
    if takes - heard:
        names = ", ".join(sorted(takes - heard))
        return Finding("replay", False, f"says it takes {names}, which never changes anything")
    if not takes:
        said = f"none of {len(steps)} events is used up or changes anything"
        return Finding("replay", True, said)
    most = max(tried, key=lambda walked: sum(step.changed for step in walked))
    used, changed = sum(step.used for step in most), sum(step.changed for step in most)
    said = f"of {len(most)} events {used} are used up and {changed} change its state"
    return Finding("replay", True, f"{said}, to the same again")


def some_events(takes: frozenset[str]) -> list[events.Event]:
    """A pointer that moves, presses and drags, a wheel, and keys, with those that are taken."""
    keys = dict.fromkeys(("q", "e", "up", *(t[4:] for t in sorted(takes) if t.startswith("key:"))))
    moves: list[events.Event] = [
        events.PointerMove(0.1 * k, 0.5 + 0.05 * k, 0.45, 0.05, 0.0) for k in range(4)
    ]
    return [
        *moves,
        events.PointerPress(0.5, 0.65, 0.45),
        events.Wheel(0.55, 0.65, 0.45, 2.0),
        events.SecondPress(0.56, 0.65, 0.45),
        events.SecondRelease(0.57, 0.65, 0.45),
        events.PointerMove(0.6, 0.7, 0.5, 0.05, 0.05, dragging=True),
        events.PointerRelease(0.7, 0.7, 0.5),
        *(events.KeyPress(0.8, k) for k in keys),
        *(events.KeyRelease(0.9, k) for k in keys),
        events.Tick(1.0),
    ]
