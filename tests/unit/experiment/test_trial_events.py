"""What a trial takes of the events that come in, and what times it makes of them."""

from dataclasses import dataclass
from types import SimpleNamespace

import pytest
from scripted_session import ANSWERS, FRAME, FakeDisplay, MemoryRecorder, ScriptedInput, study

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.window import Window
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.renderer.events import (
    FocusChange,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.tasks.catalog import TASKS


@dataclass
class Acts(ScriptedInput):
    """Sends events of its own in one frame of the first trial; `at` makes them from the time."""

    at: object = None
    when: int = 1
    page: object = None

    def events(self, view):
        events = super().events(view)
        if self.trials == 1 and self.frames == self.when and self.at is not None:
            at, self.at = self.at, None
            return sorted([*at(self.clock.now()), *events], key=lambda e: e.time)
        return events

    def ask(self, page):
        answers = super().ask(page)
        return {**answers, **(self.page or {})} if page.name in ("leave", "menu") else answers


NO_TRAINING = {"trials": 0}


def acted(at, when=1, flip_within=0.0, config=None, **script):
    """The first trial's record and the events that it took."""
    clock, recorder = SimulatedClock(64.0), MemoryRecorder()
    person = Acts(clock, ANSWERS, at=at, when=when, **script)
    world = Surroundings(
        FakeDisplay(clock), person, clock, recorder, TASKS, flip_within=lambda: flip_within
    )
    run_session(config or study(practice=NO_TRAINING), 1, world)
    return recorder.ended[0], [e for e in recorder.events if not isinstance(e, Tick)]


def test_what_may_have_come_before_the_first_frame_answers_nothing_and_is_counted():
    """Known no better than from before it to after: it may have been meant for what was before."""
    record, _ = acted(
        lambda now: [
            KeyPress(now - FRAME - 0.01, "7", 0.2),
            KeyRelease(now - 0.1, "7"),
            PointerPress(now - FRAME - 0.01, 0.5, 0.5),
        ]
    )
    assert record.outcome.answer == "20" and record.early == 2 and record.time == 4 * FRAME


def test_a_release_and_a_drag_that_began_before_the_trial_are_none_of_it():
    _, taken = acted(
        lambda now: [
            PointerPress(now - FRAME - 0.01, 0.5, 0.5),
            KeyRelease(now - 0.05, "up"),
            PointerMove(now - 0.04, 0.6, 0.5, 0.1, 0.0, True),
            PointerRelease(now - 0.03, 0.6, 0.5),
            PointerPress(now - 0.02, 0.6, 0.5),
            PointerMove(now - 0.01, 0.7, 0.5, 0.1, 0.0, True),
        ]
    )
    assert [type(e).__name__ for e in taken[:3]] == ["PointerMove", "PointerPress", "PointerMove"]
    assert [e.dragging for e in taken[:3:2]] == [False, True]


def test_what_was_typed_under_a_page_is_not_taken_after_it_and_held_keys_came_up():
    """Esc is answered; keys of that while come in only with the next frame, as after a stall."""

    class Late(Acts):
        def events(self, view):
            events = super().events(view)
            if self.trials == 1 and self.frames == 3:  # the page lay there from 2.25 to 0.25 s ago
                under = self.clock.now() - 1.0
                return [KeyPress(under, "7"), KeyPress(under, "enter"), *events]
            return events

    clock, recorder = SimulatedClock(64.0), MemoryRecorder()
    held = lambda now: [KeyPress(now - 0.1, "left"), KeyPress(now, "escape")]  # noqa: E731
    person = Late(clock, ANSWERS, at=held, when=2, page={"button": "0"})
    world = Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS)
    run_session(study(practice=NO_TRAINING), 1, world)
    first = recorder.ended[0]
    assert first.outcome.answer == "20" and first.early == 2
    assert first.away == 2.0 and first.time == 4 * FRAME + 2.0
    (up,) = [e for e in recorder.events if isinstance(e, KeyRelease)]
    assert up.key == "left" and (up.time, up.within) == (first.first_frame + 2 * FRAME, 2.0)


def test_a_trials_time_carries_the_bounds_of_its_first_frame_and_its_answer():
    def answer(now):
        return [KeyPress(now, "1"), KeyPress(now, "enter", 0.125)]

    record, _ = acted(answer, when=2, flip_within=0.0625)
    assert record.time == 2 * FRAME and record.within == 0.125 + 0.0625


def test_an_answer_given_in_time_counts_though_it_came_in_after_the_limit():
    """The program stood still for 5 s: what was typed before the limit was typed before it."""

    class Stalls(Acts):
        def events(self, view):
            events = super().events(view)
            if self.trials == 1 and self.frames == 2:
                typed = self.clock.now()
                self.clock.advance(typed + 5.0)
                return [KeyPress(typed, "8"), KeyPress(typed, "enter"), Tick(typed + 5.0)]
            return events

    clock, recorder = SimulatedClock(64.0), MemoryRecorder()
    world = Surroundings(FakeDisplay(clock), Stalls(clock, ANSWERS), clock, recorder, TASKS)
    config = study(practice=NO_TRAINING, task={"limit": 2.0})
    run_session(config, 1, world)
    assert recorder.ended[0].outcome.answer == "8" and not recorder.ended[0].timed_out


def test_focus_that_is_away_when_the_answer_is_confirmed_is_subtracted():
    """Confirmed by the pointer, say: lost at the second frame, the answer comes at the fourth."""
    record, _ = acted(lambda now: [FocusChange(now, False)], when=2)
    assert (record.time, record.away) == (4 * FRAME, 2 * FRAME)


def test_focus_lost_before_the_first_frame_counts_from_it():
    record, _ = acted(lambda now: [FocusChange(now - FRAME - 1.0, False)])
    assert (record.time, record.away) == (4 * FRAME, 4 * FRAME)


def test_a_page_while_the_focus_is_away_counts_once():
    def lost(now):
        return [FocusChange(now - FRAME / 2, False), KeyPress(now, "escape")]

    record, _ = acted(lost, when=2, page={"button": "0"})
    assert record.time == 4 * FRAME + 2.0
    assert record.away == 2.0 + FRAME / 2 + 2 * FRAME


def test_focus_lost_under_a_page_counts_from_its_end():
    """What happened under it comes in after it, and no tick before says that it could not."""

    class Late(Acts):
        def events(self, view):
            events = super().events(view)
            if self.trials == 1 and self.frames == 3:
                return [FocusChange(self.clock.now() - 1.0, False), *events]
            return events

    clock, recorder = SimulatedClock(64.0), MemoryRecorder()
    asks = lambda now: [KeyPress(now, "escape")]  # noqa: E731
    person = Late(clock, ANSWERS, at=asks, when=2, page={"button": "0"})
    world = Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS)
    run_session(study(practice=NO_TRAINING), 1, world)
    first = recorder.ended[0]
    assert first.time == 4 * FRAME + 2.0 and first.away == 2.0 + 2 * FRAME
    times = [e.time for e in recorder.events]
    assert times == sorted(times)


def test_a_page_over_a_trial_is_no_missed_frame():
    """60 Hz, frames every 0.25 s would all be missed; here the period is longer than a frame."""
    clock, recorder = SimulatedClock(64.0), MemoryRecorder()
    person = Acts(clock, ANSWERS, at=lambda now: [KeyPress(now, "escape")], page={"button": "0"})
    world = Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS, period=FRAME)
    run_session(study(practice=NO_TRAINING), 1, world)
    first = recorder.ended[0]
    assert first.away == 2.0 and first.frames_missed == 0 and first.worst_frame == FRAME


@pytest.mark.parametrize("early", [0.0, FRAME + 0.01])
def test_a_trial_that_is_repeated_has_times_that_a_report_can_read(early):
    """Also where F1 was pressed while the first frame was being drawn."""
    page = {"button": "1", "note": ""}
    record, _ = acted(lambda now: [KeyPress(now - early, "f1")], page=page)
    assert record.repeat and record.time > 0 and record.time - record.away >= 0


def test_the_windows_events_come_in_the_order_of_their_times_and_never_run_back():
    """Keys and pointer have queues of their own; what is later than the tick waits for the next."""
    moments = iter([2.0, 3.0])
    window = SimpleNamespace(_pump=lambda: next(moments), _closed=False)
    move, late = PointerMove(1.25, 0.5, 0.5, 0.0, 0.0), KeyPress(2.5, "enter")
    window._events = [KeyPress(1.5, "1"), late, move]
    assert Window.events(window, None) == [move, KeyPress(1.5, "1"), Tick(2.0)]
    assert Window.events(window, None) == [late, Tick(3.0)]
