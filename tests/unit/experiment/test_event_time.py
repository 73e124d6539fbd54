"""Stamps of the system, on the session's clock: never later than the event, and with a bound."""

from types import SimpleNamespace

import pytest

from seethrough.experiment.display.event_time import RESOLUTION, WRAP, EventTime, x11_stamp

OFFSET = 73.0  # s that the session's clock is behind the server's


def timed(stamp, monotonic, empty=0.0, trusted=True):
    """(time, within) of an event that is dispatched at `monotonic`, on the session's clock."""
    when = EventTime(lambda: monotonic - OFFSET, lambda: monotonic)
    when._empty = empty
    when.trusted, when.stamp = trusted, stamp
    return when.moment()


@pytest.mark.parametrize("age", [0.0, 0.012, 0.999, 1.6, 5.0, 3600.0, 86400.0])
def test_an_event_happened_when_its_stamp_says_whatever_its_age(age):
    time, within = timed(123_450, 123.45 + age)
    assert time == pytest.approx(123.45 - OFFSET, abs=1e-9)
    assert within == pytest.approx(min(RESOLUTION, age), abs=1e-9)


def test_the_count_of_milliseconds_wraps_around():
    time, _ = timed(WRAP - 7, (WRAP + 5) / 1000)
    assert time == pytest.approx((WRAP - 7) / 1000 - OFFSET, abs=1e-6)


def test_what_cannot_be_known_is_known_within_a_bound():
    for stamp, trusted in [(None, True), (123_450, False), (123_600, True)]:
        # No stamp; another clock's; from the future.
        assert timed(stamp, 123.5, 50.25, trusted) == (50.25, 0.25)


def test_a_stall_between_the_readings_of_two_clocks_moves_nothing_later():
    """The program stops for 5 s after it read one clock, before it reads the other."""
    true = iter([100.0, 100.0, 105.0, *[105.0] * 30])
    when = EventTime(lambda: next(true) - OFFSET, lambda: next(true))
    when.trusted, when.stamp = True, 99_000
    assert when.moment()[0] == pytest.approx(99.0 - OFFSET, abs=1e-9)


def test_where_every_reading_is_slow_the_bound_says_so():
    """A second passes between any two readings of a clock."""
    seconds = iter(range(100, 200))
    when = EventTime(lambda: next(seconds) - OFFSET, lambda: next(seconds))
    when.trusted, when.stamp = True, 90_000
    time, within = when.moment()
    assert time <= 90.0 - OFFSET <= time + within and within <= 2 + RESOLUTION + 1e-9


def test_within_a_queue_an_event_without_a_stamp_keeps_its_place():
    """A window that loses the focus comes after the keys that came before that."""
    when = EventTime(lambda: 130.0 - OFFSET, lambda: 130.0)
    when._empty = 0.0
    when.trusted, when.queue = True, "window"
    when.drained(120.0 - OFFSET)
    when.stamp = 125_000
    assert when.moment()[0] == pytest.approx(125.0 - OFFSET)
    when.stamp = None
    assert when.moment() == pytest.approx((125.0 - OFFSET, 5.0))
    when.queue = "view"  # keeps no order with the other
    assert when.moment() == pytest.approx((120.0 - OFFSET, 10.0))
    when.drained(130.0 - OFFSET)
    assert when.moment() == (130.0 - OFFSET, 0.0)


@pytest.mark.parametrize(
    ("stamp", "same"), [(5000, True), (5003, True), (4990, False), (5020, False), (None, False)]
)
def test_the_servers_clock_is_ours_if_it_lies_between_two_readings_of_it(stamp, same):
    when = EventTime(lambda: 0.0)
    when.agrees(stamp, 5.0001, 5.0032)
    assert when.trusted is same


def event(kind, time, sent=False):
    carries = SimpleNamespace(time=time)
    return SimpleNamespace(
        type=kind, xany=SimpleNamespace(send_event=sent), xkey=carries, xbutton=carries,
        xmotion=carries,
    )  # fmt: skip


def test_what_another_program_sent_and_a_time_of_nought_are_no_stamps():
    assert [x11_stamp(event(kind, 42)) for kind in (2, 3, 4, 5, 6, 9)] == [42] * 5 + [None]
    assert x11_stamp(event(2, 42, sent=True)) is None
    assert x11_stamp(event(2, 0)) is None
