"""Repeated-measures ANOVA against afex (R), statsmodels and exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import oracles
import pytest
from hypothesis import given
from hypothesis import strategies as st

from seethrough.analysis.stats.anova import helmert, repeated_measures
from seethrough.analysis.stats.undefined import Undefined

# R prints 15 digits; its own sums lose a few of them on these data
DIGITS = 1e-9

DESIGNS = [
    ("r_sleep", ["drug"]),
    ("loftus_masson_1994", ["exposure"]),
    ("hays_rouder_morey_2x2", ["shape", "colour"]),
    ("statsmodels_pr3303_2x3", ["A", "B"]),
]


@pytest.mark.parametrize(("name", "factors"), DESIGNS)
def test_every_effect_agrees_with_afex(name, factors):
    reference = oracles.values()["datasets"][name]["R"]["afex"]
    effects = repeated_measures(oracles.array(name, factors), factors)
    for effect in effects.values():
        expected = reference[effect.name.replace(" × ", ":")]
        if expected["F"] < 1e-20:  # R's rounding; exactly 0 is asserted below
            continue
        got = {
            "F": effect.f,
            "df1": effect.df1,
            "df2": effect.df2,
            "p": effect.p,
            "ges": effect.ges,
            "pes": effect.pes,
        }
        if effect.df1 > 1:
            got |= {
                "GG_eps": effect.eps,
                "p_GG": effect.p_gg,
                "mauchly_W": effect.mauchly_w,
                "mauchly_p": effect.mauchly_p,
            }
        for key, value in got.items():
            assert value == pytest.approx(expected[key], rel=DIGITS), key


def test_the_interaction_that_is_exactly_zero_is_exactly_zero():
    effects = repeated_measures(
        oracles.array("hays_rouder_morey_2x2", ["shape", "colour"]), ["shape", "colour"]
    )
    assert (effects["shape × colour"].f, effects["shape × colour"].p) == (0.0, 1.0)


@pytest.mark.parametrize("name", ["r_sleep", "loftus_masson_1994", "statsmodels_pr3303_2x3"])
def test_it_agrees_with_statsmodels(name):
    factors = dict(DESIGNS)[name]
    reference = oracles.values()["datasets"][name]["python"]["statsmodels"]
    effects = repeated_measures(oracles.array(name, factors), factors)
    for effect in effects.values():
        expected = reference[effect.name.replace(" × ", ":")]
        assert effect.f == pytest.approx(expected["F"], rel=DIGITS)
        assert effect.p == pytest.approx(expected["p"], rel=DIGITS)


def test_contrasts_are_orthogonal_and_sum_to_zero():
    contrasts, lengths = helmert(6)
    np.testing.assert_array_equal(contrasts.T @ contrasts, np.diag(lengths))
    np.testing.assert_array_equal(contrasts.sum(axis=0), 0)


@given(st.lists(st.tuples(*[st.integers(-50, 50)] * 3), min_size=3, max_size=8))
def test_one_factor_against_rational_arithmetic(rows):
    """Textbook sums of squares in fractions: no rounding, another road."""
    n, k = len(rows), 3
    grand = Fraction(sum(map(sum, rows)), n * k)
    columns = [Fraction(sum(c), n) for c in zip(*rows, strict=True)]
    people = [Fraction(sum(r), k) for r in rows]
    ss_effect = n * sum((c - grand) ** 2 for c in columns)
    ss_error = sum(
        (rows[i][j] - people[i] - columns[j] + grand) ** 2 for i in range(n) for j in range(k)
    )
    effect = repeated_measures(np.array(rows, dtype=float), ["c"])["c"]
    if ss_error == 0:
        assert effect.f == Undefined("all differences are equal")
        return
    exact = (ss_effect / (k - 1)) / (ss_error / ((k - 1) * (n - 1)))
    # integers up to 50: the scores are exact, only sums and divisions round
    assert effect.f == pytest.approx(float(exact), rel=1e-12, abs=1e-12)


def test_missing_values_are_refused():
    with pytest.raises(ValueError, match="finite"):
        repeated_measures(np.array([[1.0, np.nan], [2.0, 3.0]]), ["c"])
