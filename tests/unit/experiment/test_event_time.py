"""Stamps of the system, on the session's clock."""

from experiment.event_time import WRAP, EventTime


def timed(stamp, monotonic, now=50.0):
    when = EventTime(lambda: now, lambda: monotonic)
    when.stamp = stamp
    return when.time()


def test_an_event_happened_as_long_ago_as_its_stamp_says():
    assert timed(123_450, 123.462) == 50.0 - 0.012


def test_the_count_of_milliseconds_wraps_around():
    monotonic = (WRAP + 5) / 1000
    assert timed(WRAP - 7, monotonic) == 50.0 - 0.012


def test_without_a_stamp_or_with_one_of_another_clock_it_is_the_time_of_dispatch():
    assert timed(None, 123.0) == 50.0
    assert timed(100_000, 123.0) == 50.0  # 23 s old: another clock
    assert timed(123_100, 123.0) == 50.0  # from the future: another clock
