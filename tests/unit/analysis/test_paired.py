"""Paired differences: sizes, intervals, Bayes factors, equivalence, against R and the paper."""

from __future__ import annotations

import numpy as np
import oracles
import pytest
from scipy import stats

from seethrough.analysis.stats.distributions import (
    bayes_factor_t,
    noncentral_f_interval,
    noncentral_t_cdf,
)
from seethrough.analysis.stats.paired import paired, ratio_of_means, tost, within_halfwidths

MEASURES = list(oracles.values()["datasets"]["paper_exact_moments"]["R"])


def two_columns(measure: str) -> tuple[np.ndarray, np.ndarray]:
    rows = [r for r in oracles.rows("paper_exact_moments") if r["measure"] == measure]
    return tuple(np.array([float(r[c]) for r in rows]) for c in ("standard", "dyntrans"))


@pytest.mark.parametrize("measure", MEASURES)
def test_the_papers_measures_agree_with_r(measure):
    expected = oracles.values()["datasets"]["paper_exact_moments"]["R"][measure]
    result = paired(*two_columns(measure))
    got = {
        "t": result.t,
        "p": result.p,
        "diff": result.difference,
        "dz": result.dz,
        "BF10_JZS_r707": result.bf10,
    }
    for key, value in got.items():
        # BayesFactor integrates adaptively, to about 1e-7
        digits = 1e-6 if key.startswith("BF") else 1e-8
        assert value == pytest.approx(expected[key], rel=digits), key
    assert result.interval == pytest.approx(tuple(expected["ci"]), rel=1e-8)
    # two independent implementations of Royston's approximation
    assert result.shapiro_w == pytest.approx(expected["shapiro_diff_W"], rel=1e-7)
    assert result.shapiro_p == pytest.approx(expected["shapiro_diff_p"], rel=1e-5)


def test_sleep_has_the_known_bayes_factor():
    expected = oracles.values()["datasets"]["r_sleep"]["R"]["paired"]
    y = oracles.array("r_sleep", ["drug"])
    result = paired(y[:, 0], y[:, 1])
    assert result.bf10 == pytest.approx(expected["BF10_JZS_r707"], rel=1e-8)
    assert result.p == pytest.approx(expected["p"], rel=1e-10)


@pytest.mark.parametrize(
    "row", oracles.values()["paper_reconstruction"], ids=lambda r: r["measure"]
)
def test_effect_sizes_of_the_paper(row):
    """Oracle: the notes' inversion of the noncentral t and F, from the printed F alone."""
    n, f = row["n"], row["F_reported"]
    rng = np.random.default_rng(1)
    raw = rng.normal(size=n)
    unit = (raw - raw.mean()) / raw.std(ddof=1)
    sign = np.sign(row["mean_standard"] - row["mean_dyntrans"])
    result = paired(unit + sign * np.sqrt(f / n), np.zeros(n))
    assert result.dz == pytest.approx(row["dz"], rel=1e-9)
    assert result.dz_interval == pytest.approx(tuple(row["dz_ci95"]), abs=1e-8)
    low, high = noncentral_f_interval(f, 1, n - 1)
    ends = (low / (low + n - 1), high / (high + n - 1))
    assert ends == pytest.approx(
        tuple(row["partial_eta2_ci90_lambda_over_lambda_plus_df2"]), abs=1e-7
    )


@pytest.mark.parametrize(
    ("t", "df", "nc"), [(1.0, 3, 0.5), (2.5, 15, 2.0), (-0.5, 40, 1.0), (7, 15, 5)]
)
def test_noncentral_t_agrees_with_scipy_where_scipy_works(t, df, nc):
    assert noncentral_t_cdf(t, df, nc) == pytest.approx(stats.nct.cdf(t, df, nc), abs=1e-11)


def test_noncentral_t_where_scipy_is_nan():
    """P(T < −2.13) at nc = 15 is tiny, and P(T² < 2.13²) = P(F < …) is known to scipy."""
    inside = noncentral_t_cdf(2.13, 15, 15) - noncentral_t_cdf(-2.13, 15, 15)
    assert inside == pytest.approx(stats.ncf.cdf(2.13**2, 1, 15, 225.0), abs=1e-12)


def test_interval_of_f_with_more_degrees_agrees_with_scipy():
    low, high = noncentral_f_interval(29.2, 2, 14)
    assert stats.ncf.cdf(29.2, 2, 14, low) == pytest.approx(0.95, abs=1e-9)
    assert stats.ncf.cdf(29.2, 2, 14, high) == pytest.approx(0.05, abs=1e-9)


def test_bayes_factor_of_a_huge_t_does_not_overflow():
    assert bayes_factor_t(60.0, 16) > 1e10
    assert 0 < bayes_factor_t(0.0, 10_000) < 0.05


def test_equivalence_of_the_papers_t3_distance():
    """study.md: 95 % interval [−5.6, 7.2], TOST at ±20 % gives p = .20."""
    first, second = two_columns("distance T3")
    result = tost(first - second, 0.20 * first.mean())
    assert result.p == pytest.approx(0.20, abs=0.005)
    low = stats.ttest_1samp(first - second, -0.2 * first.mean(), alternative="greater").pvalue
    high = stats.ttest_1samp(first - second, 0.2 * first.mean(), alternative="less").pvalue
    assert result.p == pytest.approx(max(low, high), rel=1e-9)


def test_fieller_covers_its_own_definition():
    """An end of the interval is a ratio θ for which second − θ·first has |t| at the quantile."""
    rng = np.random.default_rng(3)
    first, second = rng.gamma(9, 2, 12), rng.gamma(9, 1, 12)
    ratio, (low, high) = ratio_of_means(first, second)
    assert low < ratio < high
    for end in (low, high):
        t = stats.ttest_1samp(second - end * first, 0).statistic
        assert abs(t) == pytest.approx(stats.t.ppf(0.975, 11), rel=1e-9)


def test_cousineau_morey_agrees_with_r():
    reference = oracles.values()["datasets"]
    y = oracles.array("loftus_masson_1994", ["exposure"])
    expected = reference["loftus_masson_1994"]["R"]["cousineau_morey_ci_half"]
    assert within_halfwidths(y) == pytest.approx(expected, rel=1e-9)
    four = oracles.array("hays_rouder_morey_2x2", ["shape", "colour"]).reshape(12, 4)
    published = reference["hays_rouder_morey_2x2"]["published"]["cousineau_morey_ci_half"]
    order = ["Round.Mono", "Round.Color", "Square.Mono", "Square.Color"]
    assert within_halfwidths(four) == pytest.approx([published[k] for k in order], rel=1e-6)
