"""The one sentence: whether anyone bought speed with errors."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from seethrough.analysis.design import Design, Factor, Measured, Task
from seethrough.analysis.page.blocks import Table
from seethrough.analysis.sections.tradeoff import CHANGES, _row, _sentence
from seethrough.analysis.tradeoff import Change, changes

RNG = np.random.default_rng(3)


def change(time_ratio, error_change):
    n = len(time_ratio)
    time = np.stack([np.full(n, 50.0), 50.0 * np.asarray(time_ratio)], axis=1)
    error = np.stack([np.full(n, 0.1), 0.1 + np.asarray(error_change)], axis=1)
    names = tuple(f"P{i:02d}" for i in range(n))
    return Change("count", "absolute relative error", names, time, np.log(time), error)


def said(c):
    table = Table("tradeoff", "t", CHANGES, (_row(c),), tuple(x.name for x in CHANGES), "")
    return str(_sentence(table, [c], 0.05))


def test_a_group_that_becomes_faster_and_worse_bought_speed():
    text = said(change(np.linspace(0.5, 0.6, 16), RNG.permutation([0.05] * 13 + [-0.05] * 3)))
    assert "most of those who became faster made more errors" in text
    assert "no sign" not in text


def test_faster_and_better_or_by_chance_is_no_sign_of_it():
    better = change(np.linspace(0.5, 0.6, 16), RNG.permutation([-0.05] * 13 + [0.05] * 3))
    chance = change(np.linspace(0.5, 0.6, 16), RNG.permutation([-0.05, 0.05] * 8))
    for c in (better, chance):
        assert "nowhere is it shown that more of the faster made more errors" in said(c)


@pytest.mark.parametrize(("worse", "p"), [(13, 0.02127075), (8, 1.0)])
def test_the_sign_test_is_the_exact_binomial(worse, p):
    # 2 · P(X ≤ 16 − worse), X binomial (16, ½): 2 · (1 + 16 + 120 + 560) / 65536 for 13 of 16.
    row = _row(change(np.full(16, 0.5), [0.05] * worse + [-0.05] * (16 - worse)))
    assert row["p_errors"] == pytest.approx(p, abs=1e-8)


def test_of_what_is_no_error_less_is_worse():
    """All become faster, and thirteen of sixteen score more: nobody bought anything; the more time
    somebody gains, the more points as well, which is a positive r."""
    gain = np.concatenate([np.full(13, 0.05), np.full(3, -0.05)])
    errors = change(np.linspace(0.5, 0.6, 16), -gain)
    points = replace(errors, error=1 - errors.error, less_is_worse=True)
    assert "nowhere is it shown" in said(points)
    (plain, own) = _row(errors), _row(points)
    for name in CHANGES:
        if name.style == "int":
            assert own[name.name] == plain[name.name]
    assert own["faster_better"] == 13 and own["r"] == pytest.approx(plain["r"]) and own["r"] > 0


SCORES = Measured("score", "score", direction="more", label="points")
EASE = Measured("ease", "ease", direction="more", scale="ordinal", label="ease")
RIGHT = Measured("correct", "correct", direction="more", scale="binary", label="right answers")
TIME = Measured("time", "time", unit="s", log=True)


def test_what_times_are_set_against_is_never_a_share_that_it_is_not():
    """Of five points 1 − 4 is no share wrong, and right answers come before them."""
    view = Factor("view", "within", ("a", "b"), "a")
    rows = [
        {"participant": f"p{i}", "task": "find", "view": level, "time": seconds, "correct": right,
         "ease": 4.0, "score": score}
        for i in range(5)
        for level, seconds, right, score in (("a", 20.0 + i, 1.0, 3.0), ("b", 10.0 + i, 0.0, 9.0))
    ]  # fmt: skip
    for measures, label, worse in (
        ((TIME, EASE, RIGHT), "share wrong", 5),
        ((TIME, EASE), "ease, less is worse", 0),
        ((TIME, SCORES, RIGHT), "points, less is worse", 0),
    ):
        design = Design((view,), (Task("find", "T1", measures),))
        (found,) = changes(pd.DataFrame(rows), design)
        assert found.error_label == label
        assert _row(found)["faster_worse"] == worse
        assert (found.error >= 0).all()
