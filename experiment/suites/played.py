"""A trial played by a simulated person, step by step, for suites that try a task."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.random import Generator

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.suites.plain_looks import plain_look
from seethrough.tasks.kit.base import Outcome, Setting, Task, View
from seethrough.tasks.kit.events import (
    Event,
    FocusChange,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)

ASPECT = 4 / 3
MOST_EVENTS = 20_000
NEAR = 0.05  # view heights from a thing's middle that still hit it
CLOCKS = ("time", "monotonic", "perf_counter", "process_time", "time_ns", "monotonic_ns")
KEYS = (*"0123456789ackrxyz", "left", "right", "up", "down", "enter", "space", "backspace", "tab")


@dataclass(frozen=True, eq=False)
class Played:
    """The states of a trial: `states[i + 1]` is `states[i]` after `events[i]`."""

    states: list[Any]
    events: list[Event]
    outcome: Outcome | None


class ReadsTheClock(Exception):
    """What runs depends on when it runs."""


@contextmanager
def no_clock() -> Iterator[None]:
    """Whoever asks what time it is, is found out."""

    def refuse(*_: Any) -> float:
        raise ReadsTheClock("expected the times of events, not the clock's")

    kept = {name: getattr(time, name) for name in CLOCKS}
    for name in CLOCKS:
        setattr(time, name, refuse)
    try:
        yield
    finally:
        for name, clock in kept.items():
            setattr(time, name, clock)


def begun(task: Task, setting: Setting, seed: int, aspect: float = ASPECT) -> Any:
    """A trial's first state."""
    return task.begin(task.make_scene(np.random.default_rng(seed), setting), setting, aspect)


def played(task: Task, setting: Setting, seed: int) -> Played:
    """A trial played by a simulated person who sees all that is in the view."""
    states, events = [begun(task, setting, seed)], list[Event]()
    person = SimulatedParticipant(np.random.default_rng(seed))
    person.begin_trial(task.name, 0.0)
    now, outcome = 0.0, None
    while outcome is None and len(events) < MOST_EVENTS:
        view = task.view(states[-1])
        batch = person.events(view, partial(plain_look, view, ASPECT), now, task.name)
        for event in (plainly_pointed(view, event) for event in batch):
            events.append(event)
            states.append(task.on_event(states[-1], event))
        now = max(now, *(event.time for event in batch))
        outcome = task.outcome(states[-1])
    return Played(states, events, outcome)


def plainly_pointed(view: View, event: Event) -> Event:
    """The event, told what it hits where the view wants to know: the thing whose middle is nearest,
    as `plain_look` has it."""
    if view.aim is None or not isinstance(event, KeyPress | PointerPress):
        return event
    if isinstance(event, KeyPress) and event.key not in ("enter", "space"):
        return event
    place = view.aim if isinstance(event, KeyPress) else (event.x, event.y)
    away = np.hypot(*(plain_look(view, ASPECT).position - np.array(place)).T)
    found = int(np.argmin(np.where(np.isfinite(away), away, np.inf)))
    return replace(event, thing=found if away[found] < NEAR else -1)


def anything(rng: Generator, count: int) -> list[Event]:
    """Events that a participant might send who does not know what to do."""
    found: list[Event] = []
    now = 0.0
    for kind in rng.integers(0, 8, count):
        now += float(rng.exponential(0.2))
        x, y = float(rng.uniform(0, ASPECT)), float(rng.uniform(0, 1))
        key = KEYS[int(rng.integers(len(KEYS)))]
        dx, dy = rng.normal(0, 0.1, 2).tolist()
        found.append(
            (
                Tick(now),
                KeyPress(now, key),
                KeyRelease(now, key),
                PointerPress(now, x, y),
                PointerRelease(now, x, y),
                PointerMove(now, x, y, dx, dy, False),
                PointerMove(now, x, y, dx, dy, True),
                FocusChange(now, bool(rng.integers(2))),
            )[kind]
        )
    return found


def same(a: View, b: View) -> bool:
    """Whether two views show the same from the same place, under the same words."""
    plain = [[e for e in view.hud if not hasattr(e, "look")] for view in (a, b)]
    return (
        np.array_equal(a.scene.transforms, b.scene.transforms)
        and np.array_equal(a.camera.eye, b.camera.eye)
        and np.array_equal(a.camera.rotation, b.camera.rotation)
        and plain[0] == plain[1]
        and a.captured == b.captured
    )
