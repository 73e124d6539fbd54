"""Clicks: a press and a release at one place, or a key where the cross stands."""

import pytest

from seethrough.renderer.events import (
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.tasks.kit.clicking import RATE, SLIP, clicking


def after(*events, aspect=4 / 3):
    state = clicking(aspect)
    for event in events:
        state = state.on_event(event)
    return state


def test_a_click_ends_with_the_release_and_hits_what_the_press_was_told():
    press = PointerPress(1.0, 0.4, 0.5, thing=7)
    assert after(press).clicks == 0
    done = after(press, PointerRelease(1.1, 0.4, 0.5))
    assert (done.clicks, done.thing, done.at) == (1, 7, (0.4, 0.5))


def test_a_drag_is_no_click():
    """Farther than a hand slips; a little less still is one."""
    for way, clicks in ((0.9 * SLIP, 1), (1.1 * SLIP, 0)):
        done = after(
            PointerPress(1.0, 0.4, 0.5, thing=7),
            PointerMove(1.1, 0.4 + way, 0.5, way, 0.0, dragging=True),
            PointerRelease(1.2, 0.4 + way, 0.5),
        )
        assert done.clicks == clicks


def test_keys_move_a_cross_and_enter_clicks_there():
    """Half a second to the right and down, however often the clock ticks."""
    for ticks in ((), (0.1, 0.2, 0.31), (0.25,)):
        done = after(
            KeyPress(0.0, "d"), KeyPress(0.0, "s"), *map(Tick, ticks),
            KeyRelease(0.5, "d"), KeyRelease(0.5, "s"), Tick(9.0),
        )  # fmt: skip
        assert done.at == pytest.approx((2 / 3 + RATE / 2, 0.5 + RATE / 2), abs=1e-12)
        assert len(done.elements()) == 1
    hit = done.on_event(KeyPress(9.1, "enter", thing=-1))
    assert (hit.clicks, hit.thing) == (1, -1)
    assert done.on_event(KeyPress(9.1, "enter")).clicks == 0  # nobody looked what is there
    assert not done.on_event(PointerMove(9.2, 0.1, 0.1, 0.0, 0.0)).elements()


def test_the_cross_stays_in_the_view():
    done = after(KeyPress(0.0, "a"), KeyPress(0.0, "w"), Tick(60.0))
    assert done.at == (0.0, 0.0)
