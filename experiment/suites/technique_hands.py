"""What a technique makes of what hands do: whether it reaches, and whether it can be replayed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.suites.finding import Finding
from seethrough.experiment.suites.technique_scenes import Case
from seethrough.experiment.suites.variants import pairwise
from seethrough.renderer import events
from seethrough.renderer.techniques import base
from seethrough.tasks.kit.gestures import after as gestures_done

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Technique

SIZE = (96, 72)
Draw = Callable[[Case, base.Parameters, object], NDArray[np.uint8]]


def played(technique: Technique, case: Case, p: base.Parameters) -> tuple[object, list[bool]]:
    """The state after some events of every kind, and which ones were used up."""
    shot = base.Shot(case.scene, case.camera, SIZE)
    state, used = technique.begin(p), []
    for event in some_events():
        state, taken = technique.on_event(p, state, event, shot)
        used.append(taken)
    return state, used


def reaches(technique: Technique, cases: Sequence[Case], picture: Draw) -> Finding:
    """Hands that reach for a point of the world by what it takes change what it shows there."""
    p = technique.Parameters()
    wrong, changed = [], 0
    for case in cases if technique.active(p) else ():
        shot = base.Shot(case.scene, case.camera, SIZE)
        point = case.scene.centers[np.nonzero(case.scene.targets)[0][-1]]
        before = technique.begin(p)
        gestures = technique.reach(p, before, shot, point)
        strange = {g.event for g in gestures} - technique.takes
        state = gestures_done(p, before, shot, gestures)
        same = np.array_equal(picture(case, p, None), picture(case, p, state))
        wrong += [f"{case.name}: uses {', '.join(sorted(strange))}"] if strange else []
        changed += not same
    if not changed and technique.active(p):
        wrong.append("nothing changes in any scene")
    return Finding("reaches", not wrong, "; ".join(wrong) or f"{changed} scenes changed")


def replayed(technique: Technique, case: Case) -> Finding:
    """The same events lead to the same state; only what it takes is used up."""
    p = technique.Parameters()
    (state, used), (again, _) = played(technique, case, p), played(technique, case, p)
    takes = [events.taken_as(e) in technique.takes for e in some_events()]
    stolen = [
        events.taken_as(e) for e, u, t in zip(some_events(), used, takes, strict=True) if u > t
    ]
    tried = pairwise(p, np.random.default_rng(12))
    changes = any(played(technique, case, p)[0] != technique.begin(p) for p in tried)
    holds = state == again and not stolen and (changes or not technique.takes)
    said = f"{sum(used)} of {len(used)} events used up, the same state again"
    if stolen:
        said = f"uses up {', '.join(sorted(set(stolen)))}, which it does not say it takes"
    elif not holds:
        said = "another state from the same events, or none from those that it takes"
    return Finding("replay", holds, said)


def some_events() -> list[events.Event]:
    """A pointer that moves, presses and drags, and keys."""
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
        *(events.KeyPress(0.8, k) for k in ("q", "e", "up")),
        *(events.KeyRelease(0.9, k) for k in ("q", "e", "up")),
        events.Tick(1.0),
    ]
