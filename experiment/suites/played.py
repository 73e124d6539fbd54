"""A trial played by a simulated person, step by step, for suites that try a task."""

from __future__ import annotations

import datetime
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.suites.plain_looks import plain_look
from seethrough.renderer.events import (
    Event,
    FocusChange,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.tasks.kit.base import Outcome, Setting, Task, View

ASPECT = 4 / 3
MOST_EVENTS = 20_000
NEAR = 0.05  # view heights from a thing's middle that still hit it
CLOCKS = ("time", "monotonic", "perf_counter", "process_time", "time_ns", "monotonic_ns")
DATES = ("now", "utcnow", "today")
KEYS = (*"0123456789ackrxyz", "left", "right", "up", "down", "enter", "space", "backspace", "tab")


@dataclass(frozen=True, eq=False)
class Played:
    """The states of a trial: `states[i + 1]` is `states[i]` after `events[i]`."""

    states: list[object]
    events: list[Event]
    outcome: Outcome | None


class ReadsTheClock(Exception):
    """What runs depends on when it runs."""


@contextmanager
def no_clock(plugin: object = None) -> Iterator[None]:
    """Whoever asks what time it is, is found out; in the module of a `plugin` also where it has
    taken a clock by another name, or a date."""

    def refuse(*_: object) -> float:
        raise ReadsTheClock("expected the times of events, not the clock's")

    no_date = type("datetime", (datetime.datetime,), dict.fromkeys(DATES, refuse))
    kept: list[tuple[object, str, object]] = [(time, n, getattr(time, n)) for n in CLOCKS]
    clocks = {clock for _, _, clock in kept}
    module = sys.modules.get(type(plugin).__module__)
    for name, value in list(vars(module).items()) if module else ():
        if value is datetime.datetime or (callable(value) and _among(value, clocks)):
            kept.append((module, name, value))
        elif value is datetime:
            kept.append((datetime, "datetime", datetime.datetime))
    for where, name, value in kept:
        setattr(where, name, no_date if isinstance(value, type) else refuse)
    try:
        yield
    finally:
        for where, name, value in kept:
            setattr(where, name, value)


def _among(value: object, clocks: set[object]) -> bool:
    """Whether it is one of the clocks; what cannot be hashed is none."""
    try:
        return value in clocks
    except TypeError:
        return False


def begun(task: Task, setting: Setting, seed: int, aspect: float = ASPECT) -> object:
    """A trial's first state."""
    return task.begin(task.make_scene(np.random.default_rng(seed), setting), setting, aspect)


def played(task: Task, setting: Setting, seed: int, aspect: float = ASPECT) -> Played:
    """A trial played by a simulated person who sees all that is in the view."""
    states, events = [begun(task, setting, seed, aspect)], list[Event]()
    person = SimulatedParticipant(np.random.default_rng(seed))
    person.begin_trial(task.name, 0.0)
    now, outcome = 0.0, None
    while outcome is None and len(events) < MOST_EVENTS:
        view = task.view(states[-1])
        batch = person.events(view, partial(plain_look, view, aspect), now, task.name)
        for event in (plainly_pointed(view, event, aspect) for event in batch):
            events.append(event)
            states.append(task.on_event(states[-1], event))
        now = max(now, *(event.time for event in batch))
        outcome = task.outcome(states[-1])
    return Played(states, events, outcome)


def plainly_pointed(view: View, event: Event, aspect: float = ASPECT) -> Event:
    """The event, told what it hits where the view wants to know: the thing whose middle is nearest,
    as `plain_look` has it."""
    if view.aim is None or not isinstance(event, KeyPress | PointerPress):
        return event
    if isinstance(event, KeyPress) and event.key not in ("enter", "space"):
        return event
    place = view.aim if isinstance(event, KeyPress) else (event.x, event.y)
    away = np.hypot(*(plain_look(view, aspect).position - np.array(place)).T)
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
