"""A watched participant: events arrive when they are due, each once, and move the pointer."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from seethrough.experiment.display.display import Leave
from seethrough.experiment.people.watched_input import WatchedInput
from seethrough.renderer.events import KeyPress, PointerMove, PointerPress, Tick

PLAN = [
    KeyPress(3.0, "b"),
    PointerMove(1.0, 0.2, 0.4, 0.1, 0.0, False),
    PointerPress(2.0, 0.6, 0.7),
]


class Standing:
    """Stands in for the window, the participant and its eyes at once."""

    def __init__(self):
        self.time, self.pressed, self.asked = 0.0, [], []
        self.pointed, self.begun = [], []
        self.clock, self.technique, self.size = SimpleNamespace(now=lambda: self.time), "t", (8, 6)
        self.aspect = 4 / 3

    def begin_trial(self, *what):
        self.begun.append(what)

    def events(self, view, look=None, now=None, task=None, drawn_with=None, aspect=None):
        if look is None:  # the window's own
            return self.pressed
        assert (drawn_with, aspect) == ("t", 4 / 3)  # as the window draws it
        self.asked.append((now, task))
        return list(PLAN) if len(self.asked) == 1 else []

    def point(self, at):
        self.pointed.append(at)

    def resize(self, size):
        self.size = size

    def look(self, view):
        return view


@pytest.fixture
def world():
    return Standing()


@pytest.fixture
def watched(world):
    return WatchedInput(world, world, world)


def at(watched, world, time):
    world.time = time
    return watched.events("view")


def test_events_come_at_their_time_in_their_order_and_once(watched, world):
    watched.begin_trial("count", False)
    assert world.begun == [("count", False), ("count", 0.0)]
    move, press, key = sorted(PLAN, key=lambda e: e.time)
    assert at(watched, world, 0.5) == [Tick(0.5)]
    assert at(watched, world, 1.0) == [move, Tick(1.0)]  # due to the instant
    assert at(watched, world, 1.0) == [Tick(1.0)]
    assert at(watched, world, 2.5) == [press, Tick(2.5)]
    assert at(watched, world, 9.0) == [key, Tick(9.0)]
    assert world.pointed == [(0.2, 0.4), (0.6, 0.7)]
    # A new plan is asked for when the old one is through, not before.
    assert world.asked == [(0.5, "count")]
    assert at(watched, world, 10.0) == [Tick(10.0)]
    assert world.asked == [(0.5, "count"), (10.0, "count")]


def test_what_was_planned_for_a_trial_ends_with_it(watched, world):
    at(watched, world, 0.0)
    watched.begin_trial("unique", True)
    assert at(watched, world, 9.0) == [Tick(9.0)]


def test_escape_ends_it_and_other_keys_do_not(watched, world):
    world.pressed = [KeyPress(0.0, "enter")]
    at(watched, world, 0.1)
    world.pressed = [KeyPress(0.0, "enter"), KeyPress(0.1, "escape")]
    with pytest.raises(Leave):
        at(watched, world, 0.2)
