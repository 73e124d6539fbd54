"""Tasks played through their events."""

import numpy as np

from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.events import KeyPress, PointerPress, PointerRelease
from seethrough.tasks.kit.hud import Button
from seethrough.tasks.parameters import AbstractParameters, BuildingParameters

ASPECT = 4 / 3


def begun(name, seed=1, **changes):
    task = TASKS[name]
    kind = AbstractParameters if task.scenario == "abstract" else BuildingParameters
    return task, task.begin(np.random.default_rng(seed), kind(**changes), ASPECT)


def play(task, state, events):
    for event in events:
        state = task.on_event(state, event)
    return state


def keys(text, time=1.0):
    return [KeyPress(time, key) for key in text]


def click(rect, time=1.0):
    x, y = rect.x + rect.width / 2, rect.y + rect.height / 2
    return [PointerPress(time, x, y), PointerRelease(time, x, y)]


def of(kind, view):
    return [e for e in view.hud if isinstance(e, kind)]


def button(view, text):
    return next(b.rect for b in of(Button, view) if b.text == text)
