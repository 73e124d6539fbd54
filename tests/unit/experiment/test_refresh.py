"""The refresh rate from flip times that were made with a known one."""

from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.experiment.commands.studies import check_machine
from seethrough.experiment.display import refresh, system_window, window
from seethrough.experiment.study.config import load
from seethrough.experiment.verdicts import Verdicts

RATES = [59.94, 60.0, 74.97, 120.0, 143.98, 240.0]
STUDY = load("published")


def flips(rate, seed, count=25, jitter=0.0, missed=0.0):
    """Times of flips that wait for a retrace: some come late by `jitter`, some skip retraces."""
    rng = np.random.default_rng(seed)
    retraces = np.cumsum(1 + (rng.random(count) < missed) * rng.integers(1, 4, count))
    return retraces / rate + jitter / rate * rng.random(count)


@pytest.mark.parametrize("rate", RATES)
def test_regular_flips_give_their_rate(rate):
    assert refresh.rate_of(flips(rate, 1)) == pytest.approx(rate, rel=1e-9)


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("seed", range(20))
def test_late_and_missed_flips_change_little(rate, seed):
    found = refresh.rate_of(flips(rate, seed, jitter=0.2, missed=0.25))
    # Only the first and the last flip's lateness counts: at most 0.2 of 24 periods or more.
    assert found == pytest.approx(rate, rel=0.2 / 24 / (1 - 0.2 / 24))


@pytest.mark.parametrize("rate", RATES)
def test_retraces_that_were_missed_are_counted_as_such(rate):
    times = flips(rate, 3, missed=0.25)
    # What dividing flips by seconds would say: far from the display's rate.
    assert (len(times) - 1) / (times[-1] - times[0]) < 0.8 * rate
    assert refresh.rate_of(times) == pytest.approx(rate, rel=1e-9)


def test_flips_that_do_not_wait_have_no_rate():
    rng = np.random.default_rng(5)
    assert refresh.rate_of(np.cumsum(rng.uniform(5e-5, 3e-4, 25))) is None
    assert refresh.rate_of([]) is None and refresh.rate_of([1.0]) is None


@pytest.mark.parametrize("seed", range(50))
def test_flips_that_other_programs_hold_up_do_not_pass_for_a_display(seed):
    """Each takes next to nothing, or waits for its turn on the processor: 1 to 20 ms."""
    rng = np.random.default_rng(seed)
    held_up = rng.random(25) < rng.uniform(0.3, 1.0)
    took = np.where(held_up, rng.exponential(4e-3, 25) + 1e-3, 2e-4)
    assert refresh.rate_of(np.cumsum(took)) is None


class Measured:
    """A window whose display has that rate."""

    rate: float | None = None

    def __init__(self, table, *_):
        self.measured, self.declared = self.rate, table.refresh

    def close(self):
        pass


WRONG = "FAILS, write the measured one into [display]"


@pytest.mark.parametrize(
    ("rate", "said", "fit"),
    [
        (59.94, "59.9 Hz measured, 60 declared: as declared: ok", True),
        (143.98, f"144.0 Hz measured, 60 declared: NOT AS DECLARED: {WRONG}", False),
        (30.0, f"30.0 Hz measured, 60 declared: NOT AS DECLARED: {WRONG}", False),
        (None, "the display does not wait; frames are paced by a timer: ok", True),
    ],
)
def test_the_check_compares_the_measured_rate_with_the_declared_one(
    rate, said, fit, monkeypatch, capsys
):
    monkeypatch.setattr(system_window, "available", lambda: True)
    monkeypatch.setattr(window, "Window", type("Fixed", (Measured,), {"rate": rate}))
    verdicts = Verdicts()
    check_machine._refresh(STUDY, verdicts)
    assert capsys.readouterr().out == f"machine     refresh: {said}\n"
    assert verdicts.sum_up() == (0 if fit else 1)


def test_a_window_measures_by_flips_of_its_own_without_the_first_ones(monkeypatch):
    made = []

    class Flipping:
        def flip(self):
            made.append(None)

    times = iter(flips(75.0, 2, count=window.FLIPS, jitter=0.1))
    monkeypatch.setattr(window.time, "perf_counter", lambda: float(next(times)))
    bare = window.Window._bare_flips(SimpleNamespace(_window=Flipping()))
    assert len(made) == window.FLIPS
    assert refresh.rate_of(bare) == pytest.approx(75.0, rel=0.01)
