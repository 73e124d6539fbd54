"""A part of `bench statistics` in little: tests and intervals hold what they say."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.benchmarks.inference import sizes
from seethrough.benchmarks.inference.sizes import Studies, inside, kinds


def test_every_line_holds_in_a_small_part_of_the_runs():
    """Three hundredths of the runs: at SLACK standard errors of that, no line is off."""
    rows = list(sizes.sizes(0.03))
    assert [r["figure"] + r["scene"] for r in rows if r["met"] is False] == []
    assert len({(r["figure"], r["scene"]) for r in rows}) == len(rows) > 40


def test_a_test_that_does_not_hold_is_seen():
    """A level of .15 for .05, and an interval that covers .80 for .95, in 400 studies."""
    wrong = Studies(
        "wrong",
        lambda rng: {"test": bool(rng.random() < 0.15), "interval": bool(rng.random() < 0.80)},
        400,
        {"interval": 0.95},
    )
    rows = [row for _, row in sizes._measure(wrong, 400, np.random.default_rng(1))]
    assert [row["met"] for row in rows] == [False, False]


def test_worst_comes_first_and_undefined_does_not_count(monkeypatch):
    good = Studies("good", lambda rng: {"a": None if rng.random() < 0.5 else False}, 100, {})
    bad = Studies("bad", lambda rng: {"a": True}, 100, {})
    monkeypatch.setattr(sizes, "kinds", lambda: [good, bad])
    assert [row["scene"] for row in sizes.sizes()] == ["bad", "good"]
    (_, row) = sizes._measure(good, 100, np.random.default_rng(1))[0]
    assert row["value"] == 0.0


@pytest.mark.parametrize(("ends", "held"), [((0.0, 1.0), True), ((0.6, 1.0), False)])
def test_an_interval_holds_what_lies_in_it(ends, held):
    assert inside(ends, 0.5) is held


def test_what_is_known_to_be_off_has_no_bound():
    off = {name for kind in kinds() for name in kind.off}
    assert off == {
        "Friedman χ², two levels",
        "TOST, shares right",
        "no worse, shares right",
        "omnibus F, uncorrected",
        "F of raw times",
        "carry-over",
        "interval of the difference, raw times",
        "interval of the ratio, raw times (Fieller)",
        # of the further designs: pooled or raw where spreads differ, or beside what is bounded
        "F of raw times, Greenhouse–Geisser",
        "Friedman, χ²",
        "contrast of levels between groups",
        "contrast of levels, own error",
        "contrast of raw times",
        "groups × levels, Greenhouse–Geisser",
        "groups, Welch",
        "groups, pooled F",
        "interval between groups, Welch",
        "interval of a contrast of levels",
        "levels, Greenhouse–Geisser",
        # said beside each cell's table, and above aligned ranks
        "aligned ranks",
        "interval of a cell's mean",
    }
