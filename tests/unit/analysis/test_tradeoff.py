"""Combined scores, changes and conditional accuracy against hand calculation."""

from __future__ import annotations

import numpy as np
import oracles
import pandas as pd
import pytest
from scipy import stats

from seethrough.analysis.before import design_before
from seethrough.analysis.stats.undefined import Undefined
from seethrough.analysis.tradeoff import accuracy_by_speed, changes, correlation, scores

DESIGN = design_before({})
MAIN = DESIGN.main


def trials(rows: list[tuple]) -> pd.DataFrame:
    """(participant, transparency, time, correct) of a pattern task."""
    table = pd.DataFrame(rows, columns=["participant", "transparency", "time", "correct"])
    return table.assign(task="pattern", scenario="abstract", correct=table["correct"].astype(float))


BOTH = trials(
    [
        ("a", "standard", 10.0, 1),
        ("a", "standard", 30.0, 0),
        ("a", "dynamic", 4.0, 1),
        ("a", "dynamic", 6.0, 1),
        ("b", "standard", 20.0, 1),
        ("b", "standard", 20.0, 1),
        ("b", "dynamic", 8.0, 0),
        ("b", "dynamic", 2.0, 1),
    ]
)


def test_scores_by_hand():
    found = scores(BOTH, MAIN)
    assert found.participants == ("a", "b")
    # mean time of right answers / share correct; right answers / total time
    np.testing.assert_allclose(found.ies, [[10 / 0.5, 5.0], [20.0, 2 / 0.5]])
    np.testing.assert_allclose(found.rcs, [[1 / 40, 2 / 10], [2 / 40, 1 / 10]])
    share, time = np.array([[0.5, 1], [1, 0.5]]), np.array([[20.0, 5], [20, 5]])
    z = stats.zscore(share, axis=None) - stats.zscore(time, axis=None)
    np.testing.assert_allclose(found.bis, z)


def test_inverse_efficiency_of_the_reference():
    """600 ms at 10 % errors is 666.667 ms (Vandierendonck 2018)."""
    expected = oracles.values()["speed_accuracy_checks"]["IES"]
    rows = [("a", level, 0.6, k > 0) for level in ("standard", "dynamic") for k in range(10)]
    found = scores(trials(rows), MAIN)
    assert found.ies[0, 0] * 1000 == pytest.approx(expected["ies"], abs=1e-6)


def test_nobody_right_makes_inverse_efficiency_undefined():
    rows = [("a", "standard", 3.0, 0), ("a", "dynamic", 2.0, 1)]
    found = scores(trials(rows), MAIN)
    assert found.ies == Undefined("someone has no right answer in a condition")


def test_accuracy_that_never_varies_makes_bis_undefined():
    rows = [("a", "standard", 3.0, 1), ("a", "dynamic", 2.0, 1)]
    assert scores(trials(rows), MAIN).bis == Undefined("accuracy does not vary")


def test_one_level_has_no_scores():
    assert scores(BOTH[BOTH["transparency"] == "standard"], MAIN) is None
    assert changes(BOTH[BOTH["transparency"] == "standard"], DESIGN) == []


def test_changes_pair_participants():
    (change,) = changes(BOTH, DESIGN)
    assert change.participants == ("a", "b")
    np.testing.assert_allclose(change.time, [[20, 5], [20, 5]])
    np.testing.assert_allclose(change.error, [[0.5, 0], [0, 0.5]])


def test_correlation_agrees_with_scipy():
    rng = np.random.default_rng(1)
    x = rng.normal(size=20)
    y = 0.5 * x + rng.normal(size=20)
    ours, theirs = correlation(x, y), stats.pearsonr(x, y)
    assert (ours.r, ours.p) == pytest.approx((theirs.statistic, theirs.pvalue), rel=1e-10)
    ends = theirs.confidence_interval()
    assert ours.interval == pytest.approx((ends.low, ends.high), rel=1e-9)


@pytest.mark.parametrize(
    ("x", "why"),
    [
        (np.ones(8), "one of the two does not change"),
        (np.arange(3.0), "fewer than four participants"),
    ],
)
def test_correlations_that_do_not_exist(x, why):
    assert correlation(x, np.arange(float(len(x)))).r == Undefined(why)


def test_conditional_accuracy_by_hand():
    rows = [("a", "standard", t, c) for t, c in [(1, 0), (2, 1), (3, 1), (4, 1), (5, 1), (6, 1)]]
    table = accuracy_by_speed(trials(rows), MAIN)
    assert table["share"].tolist() == [0.5, 1.0, 1.0]
    assert table["trials"].tolist() == [2, 2, 2]
