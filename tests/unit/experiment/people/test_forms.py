"""What simulated people answer on pages, from the times that their trials took."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.experiment.people.forms import Opinions

OPTIONS = ("plain", "neither", "cut")


def forms(**times: list[float]) -> Opinions:
    made = Opinions(SimpleNamespace(rng=np.random.default_rng(1)))
    for level, spent in times.items():
        made._levels = (("view", level),)
        for seconds in spent:
            made.begin("find")
            made.spent("find", seconds)
    return made


@pytest.mark.parametrize(
    "times",
    [
        {"plain": [0.0, 0.0], "cut": [0.0]},  # a task that answers at once, as one begins
        {"plain": [0.0], "cut": [3.0]},
        {"plain": [3.0], "cut": [0.0]},
        {"plain": [3.0]},
        {},
    ],
)
def test_where_a_level_took_no_time_nothing_is_preferred(times):
    assert OPTIONS[forms(**times)._preference(OPTIONS)] == "neither"


def test_who_was_much_faster_with_a_level_prefers_it():
    """Five doublings of time: a chance of 1 / (1 + e^-15) to prefer the quick one."""
    assert OPTIONS[forms(plain=[64.0], cut=[2.0])._preference(OPTIONS)] == "cut"
    assert OPTIONS[forms(plain=[2.0], cut=[64.0])._preference(OPTIONS)] == "plain"
