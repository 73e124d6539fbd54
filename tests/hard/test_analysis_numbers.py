"""Hard data for the statistics: the answer is exact, or the result says why there is none."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import oracles
import pytest

from seethrough.analysis.cells import means
from seethrough.analysis.comparison import Pair, compare, compare_logs
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.paired import one_sample, paired, ratio_of_means, tost
from seethrough.analysis.stats.ranks import friedman
from seethrough.analysis.stats.undefined import Undefined

EQUAL = Undefined("all differences are equal")
OFFSETS = ["0.0", "1000.0", "1000000.0", "1000000000.0", "1000000000000.0", "1000000000000000.0"]


def stress(offset: str) -> np.ndarray:
    rows = [r for r in oracles.rows("stress_offset_k2") if r["offset"] == offset]
    return np.array([float(r["y"]) for r in rows]).reshape(-1, 2)


@pytest.mark.parametrize("offset", OFFSETS)
def test_any_offset_leaves_f_exact(offset):
    """36015/5519 by rational arithmetic; AnovaRM, pingouin, aov and afex all fail at 1e15."""
    f = repeated_measures(stress(offset), ["c"])["c"].f
    assert f == pytest.approx(36015 / 5519, rel=4 * np.finfo(float).eps)


def exact_f(y: np.ndarray) -> Fraction:
    """One-factor F of the doubles as they are stored, in fractions."""
    rows = [[Fraction(float(v)) for v in row] for row in y]
    n, k = len(rows), len(rows[0])
    grand = sum(map(sum, rows)) / (n * k)
    columns = [sum(c) / n for c in zip(*rows, strict=True)]
    people = [sum(r) / k for r in rows]
    effect = n * sum((c - grand) ** 2 for c in columns)
    error = sum(
        (rows[i][j] - people[i] - columns[j] + grand) ** 2 for i in range(n) for j in range(k)
    )
    return effect * (n - 1) / error


@pytest.mark.parametrize("power", range(6, 16))
@pytest.mark.parametrize("k", [2, 3, 4])
def test_unit_variance_at_a_large_offset_agrees_with_fractions(power, k):
    rng = np.random.default_rng(power * 10 + k)
    y = 10.0**power + rng.normal(size=(12, k)) + rng.normal(size=(12, 1))
    f = repeated_measures(y, ["c"])["c"].f
    # the doubles' own F: what rounding them to storage did is not the engine's doing
    assert f == pytest.approx(float(exact_f(y)), rel=1e-9)


@pytest.mark.parametrize("value", [0.0, 0.1, 7.0, -3.3, 1e300, 1e-300])
@pytest.mark.parametrize("k", [2, 3])
def test_constant_data_have_no_f(value, k):
    effect = repeated_measures(np.full((16, k), value), ["c"])["c"]
    assert (effect.f, effect.p, effect.eps, effect.pes) == (EQUAL,) * 4
    assert effect.ges == Undefined("nothing varies")


def test_a_constant_difference_of_a_tenth_is_not_ten_to_the_29():
    base = np.array([42.0, 36.75, 47.3, 54.2, 61.1, 51.7])
    result = paired(base, base + 0.1)
    assert (result.t, result.p, result.dz, result.bf10) == (EQUAL,) * 4
    assert result.difference == pytest.approx(-0.1)
    assert result.interval == (EQUAL, EQUAL)


def test_identical_conditions_of_different_people_are_not_significant():
    """pingouin says F = inf, p = 0 here."""
    base = np.random.default_rng(1).normal(50, 10, 16)
    effect = repeated_measures(np.stack([base, base, base], axis=1), ["c"])["c"]
    assert effect.p == EQUAL
    assert effect.ges == 0.0


def test_one_interaction_that_is_exactly_zero_among_others():
    rng = np.random.default_rng(2)
    people, a, b = (
        rng.integers(0, 9, (8, 1, 1)),
        rng.integers(0, 9, (8, 2, 1)),
        rng.integers(0, 9, (8, 1, 2)),
    )
    effects = repeated_measures((people + a + b).astype(float), ["a", "b"])
    assert effects["a × b"].f == EQUAL
    assert isinstance(effects["a"].f, float)


@pytest.mark.parametrize("name", ["nist_SmLs01", "nist_SmLs04", "nist_SmLs07"])
def test_nists_replicates_have_no_error_term(name):
    """Read as repeated measures (replicate = participant) the exact error sum of squares is 0."""
    rows = oracles.rows(name)
    columns: dict[str, list[float]] = {}
    for row in rows:
        columns.setdefault(row["treatment"], []).append(float(row["y"]))
    y = np.array(list(columns.values())).T
    assert repeated_measures(y, ["treatment"])["treatment"].f == EQUAL


def test_two_participants_and_three_conditions():
    """pingouin divides by zero; R and statsmodels give 75/13."""
    y = np.array([[1.0, 3.0, 4.0], [2.0, 5.0, 9.0]])
    effect = repeated_measures(y, ["c"])["c"]
    assert effect.f == pytest.approx(75 / 13, rel=1e-14)
    # two participants' contrast covariance has rank 1, so ε is at its lower bound 1/(k − 1)
    assert effect.eps == pytest.approx(0.5, rel=1e-14)
    assert effect.mauchly_w == Undefined("fewer participants than contrasts")


def test_one_participant():
    assert repeated_measures(np.array([[1.0, 3.0]]), ["c"])["c"].p == Undefined(
        "fewer than two participants"
    )
    assert one_sample(np.array([2.0])).sd == Undefined("fewer than two participants")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_values_that_are_no_numbers_never_reach_a_statistic(bad):
    y = np.ones((4, 2))
    y[2, 1] = bad
    with pytest.raises(ValueError, match="finite"):
        repeated_measures(y, ["c"])


def test_perfect_agreement_of_all_participants():
    y = np.tile([1.0, 2.0, 3.0], (16, 1))
    result = friedman(y, np.random.default_rng(0))
    assert (result.chi2, result.w) == (32.0, 1.0)
    # all 3!¹⁶ shuffles: 6 of them agree as well
    assert result.exact == pytest.approx(6.0**-15, rel=1e-9)
    assert repeated_measures(y, ["c"])["c"].f == EQUAL


def test_zero_means_have_no_ratio_and_no_margin():
    zero = np.zeros(6)
    assert ratio_of_means(zero, np.ones(6))[0] == Undefined("the baseline's mean is zero")
    table = compare([Pair("m", "m", "", 2, zero, zero)])
    assert str(table.row("m")["tost_p"]) == "undefined: no margin was declared before the data"
    assert tost(zero, 1.0).p == EQUAL


def test_a_constant_ratio_of_times_is_equal_on_the_log_scale():
    times = np.array([12.5, 40.1, 33.3, 71.9])
    logs = (np.log(times), np.log(times * 0.5))
    table = compare_logs([Pair("t", "t", "s", 2, times, times * 0.5, logs=logs)])
    assert table.row("t")["p"] == EQUAL
    assert table.row("t")["ratio"] == pytest.approx(0.5, rel=1e-12)


def test_different_participants_without_different_cells_are_left_out_by_name():
    """AnovaRM accepts this table, 7 rows in each cell, and answers F = .011445."""
    import pandas as pd

    table = pd.DataFrame(oracles.rows("hard_swiss_cheese")).rename(columns={"id": "participant"})
    table["y"] = table["y"].astype(float)
    cells = means(table, "y", {"c": ("c0", "c1")})
    assert [(m.participant, m.cells) for m in cells.missing] == [
        ("s0", ("c0",)),
        ("s1", ("c1",)),
    ]
    expected = oracles.values()["hard_cases"]["swiss_cheese"]["complete_cases_n6"]
    effect = repeated_measures(cells.whole().values, ["c"])["c"]
    # the oracle is printed to six decimals
    assert effect.f == pytest.approx(expected["F"], abs=5e-7)
    assert effect.p == pytest.approx(expected["p"], abs=5e-7)


def test_levels_and_factors_of_any_name():
    """Names that break other tools' formulas: `C`, a space, a category that nobody used."""
    import pandas as pd

    rng = np.random.default_rng(4)
    table = pd.DataFrame(
        [
            {"participant": f"p {i}", "C": level, "y": rng.normal()}
            for i in range(6)
            for level in ("C", "with space", "Q('x')")
        ]
    )
    table["C"] = pd.Categorical(table["C"], categories=["unused", "C", "with space", "Q('x')"])
    cells = means(table, "y", {"C": ("C", "with space", "Q('x')")})
    assert cells.values.shape == (6, 3)
    assert isinstance(repeated_measures(cells.values, ["C"])["C"].f, float)


def test_a_million_rows():
    y = np.random.default_rng(5).normal(1e9, 1, size=(250_000, 2, 2))
    effects = repeated_measures(y, ["a", "b"])
    # differences first: exact at this offset, so numpy's t is a fair judge
    gaps = ((y[:, 0, 0] - y[:, 1, 0]) + (y[:, 0, 1] - y[:, 1, 1])) / 2
    t = gaps.mean() / (gaps.std(ddof=1) / np.sqrt(len(gaps)))
    assert effects["a"].f == pytest.approx(t * t, rel=1e-9)
    # F = .0011: its interval would be [0, 0], and not hold the estimate
    assert isinstance(effects["a"].pes_interval[1], Undefined)
    assert (
        0 == effects["b"].pes_interval[0] < effects["b"].pes < effects["b"].pes_interval[1] < 1e-3
    )
