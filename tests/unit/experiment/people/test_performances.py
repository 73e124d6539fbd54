"""Simulated people play as they did when what they do was written down."""

import json

import pytest
from performance_figures import FIGURES, PLAYED, figures

KNOWN = json.loads(FIGURES.read_text("utf-8"))


def test_every_performance_has_its_figures():
    assert set(KNOWN) == {" ".join(map(str, played)) for played in PLAYED}


@pytest.mark.parametrize("played", PLAYED, ids=lambda played: " ".join(map(str, played)))
def test_a_performance_is_what_it_was(played):
    """python tests/support/performance_figures.py writes them, where one is changed on purpose."""
    found, known = figures(*played), KNOWN[" ".join(map(str, played))]
    assert set(found) == set(known)
    for key, value in known.items():
        if key in ("seconds", "times", "moves", "presses"):
            # libraries of mathematics differ in the last digits, and sums of turns cancel
            assert found[key] == pytest.approx(value, rel=1e-6, abs=1e-6), key
        else:
            assert found[key] == value, key
