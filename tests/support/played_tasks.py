"""Tasks played through their events."""

import numpy as np

from seethrough.renderer.events import KeyPress, PointerPress, PointerRelease
from seethrough.tasks.catalog import TASKS, setting, world_of
from seethrough.tasks.kit.hud import Button

ASPECT = 4 / 3


PUBLISHED = ("count", "pattern", "unique", "count_in_building")  # the tasks of Elmqvist2009


def begin(name, place=None, made=None, seed=1, aspect=ASPECT):
    """A task's first state, in a scene that was made or in one of its own."""
    task = TASKS[name]
    given = setting(task, place)
    made = task.make_scene(np.random.default_rng(seed), given) if made is None else made
    return task.begin(made, given, aspect)


def begun(name, seed=1, **changes):
    task = TASKS[name]
    return task, begin(name, world_of(task).Parameters(**changes), seed=seed)


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
