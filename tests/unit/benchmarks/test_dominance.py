"""Who sees more finds at least as much, and no later; who sees the same does the same."""

import numpy as np
import pytest

from seethrough.benchmarks.drawing import dominance
from seethrough.benchmarks.drawing.dominance import PAIRS, Shown, compared, play

SEEDS = range(24)


@pytest.mark.parametrize("less, more", PAIRS)
def test_who_sees_more_recalls_as_much_and_as_soon(less, more):
    """Paired seeds: a loss would have to lie outside its 95 % interval to be one."""
    rows = compared(less, more, SEEDS)
    assert len(rows) >= dominance.LOOKS
    for what, gain, half in rows:
        assert gain + half >= 0, what


def test_a_gain_that_is_there_is_found():
    rows = {what: (gain, half) for what, gain, half in compared(*PAIRS[0], SEEDS)}
    for k in (1, 2, 3):
        gain, half = rows[f"recall after {k} looks"]
        assert gain - half > 0


def test_equal_pictures_and_equal_history_are_equal_behaviour():
    assert play(Shown(0.7), 3) == play(Shown(0.7), 3)
    assert play(Shown(0.7), 3) != play(Shown(0.7), 4)


def test_who_sees_hardly_anything_quits():
    """An inverted U: least and most visible take less time than what lies between."""
    seconds = {
        views: np.mean([play(Shown(views), seed).seconds for seed in SEEDS])
        for views in (0.0, 0.5, 1.0)
    }
    assert seconds[0.0] < seconds[0.5] > seconds[1.0]
