"""The one sentence: whether anyone bought speed with errors."""

import numpy as np
import pytest

from seethrough.analysis.page.blocks import Table
from seethrough.analysis.sections.tradeoff import CHANGES, _row, _sentence
from seethrough.analysis.tradeoff import Change

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
