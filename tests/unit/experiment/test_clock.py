"""The clock of somebody who watches a simulated participant faster than it plays."""

import pytest

from seethrough.experiment.display.clock import FRAME, WatchClock


def watched(speed, steps):
    """How much time passes on the clock in each of these steps of the machine's."""
    machine = [100.0]
    clock, times = WatchClock(speed, lambda: machine[0]), []
    for step in steps:
        before = clock.now()
        machine[0] += step
        times.append(clock.now() - before)
    return times


def test_time_goes_faster():
    times = watched(8.0, [FRAME / 2, 0.0, FRAME / 4])
    assert times == pytest.approx([4 * FRAME, 0.0, 2 * FRAME])


def test_a_slow_frame_counts_as_one_of_a_sixtieth_of_a_second():
    """Else a machine that takes a second for a frame would skip a minute of the session."""
    assert watched(60.0, [1.0, FRAME, 30.0]) == pytest.approx([60 * FRAME] * 3)
