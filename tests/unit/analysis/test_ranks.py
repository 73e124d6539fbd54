"""Friedman, signed ranks and sign test against R, scipy and full enumeration."""

from __future__ import annotations

import itertools

import numpy as np
import oracles
import pytest
from scipy import stats

from seethrough.analysis.stats.ranks import (
    SignedRank,
    friedman,
    post_hoc,
    ranks,
    share_interval,
    sign_test,
    signed_rank,
)
from seethrough.analysis.stats.undefined import Undefined


def rng() -> np.random.Generator:
    return np.random.default_rng(5)


@pytest.mark.parametrize(
    ("name", "factor", "digits"),
    [("loftus_masson_1994", "exposure", 1e-12), ("r_friedman_RoundingTimes", "method", 1e-12)],
)
def test_friedman_agrees_with_r(name, factor, digits):
    reference = oracles.values()["datasets"][name]["R"]
    reference = reference.get("friedman", reference)
    result = friedman(oracles.array(name, [factor]), rng())
    assert result.chi2 == pytest.approx(reference["chisq"], rel=digits)
    assert result.p == pytest.approx(reference["p"], rel=1e-11)
    assert result.w == pytest.approx(reference["W"], rel=digits)


@pytest.mark.parametrize("ties", [False, True])
def test_the_exact_p_is_the_share_of_all_shuffles(ties):
    y = np.array([[1, 2, 3], [2, 3, 1], [1, 3, 2], [1, 2, 2 if ties else 4]], dtype=float)
    r = ranks(y)
    centre = r.sum() / 3
    observed = np.sum((r.sum(axis=0) - centre) ** 2)
    shuffles = itertools.product(*(itertools.permutations(row) for row in r))
    hits = [np.sum((np.sum(s, axis=0) - centre) ** 2) >= observed - 1e-9 for s in shuffles]
    result = friedman(y, rng())
    assert result.method == "exact"
    assert result.exact == pytest.approx(np.mean(hits), rel=1e-12)


@pytest.mark.parametrize("row", oracles.values()["friedman_small_sample"][:3], ids=str)
def test_known_exact_p_values(row):
    """Find a table with the listed χ² and compare with the listed exact p (5 decimals)."""
    n, k = row["n"], row["k"]
    draw = np.random.default_rng(1)
    while True:
        y = draw.permuted(np.tile(np.arange(1.0, k + 1), (n, 1)), axis=1)
        if stats.friedmanchisquare(*y.T).statistic == pytest.approx(row["stat"]):
            break
    result = friedman(y, draw)
    assert result.exact == pytest.approx(row["p_exact"], abs=6e-6)
    assert result.p == pytest.approx(row["p_chi2"], abs=6e-6)


def test_two_conditions_are_the_sign_test():
    row = oracles.values()["friedman_small_sample"][3]
    y = np.array([[1.0, 2.0]] * row["wins"] + [[2.0, 1.0]] * (16 - row["wins"]))
    result = friedman(y, rng())
    assert result.exact == pytest.approx(row["p_exact_sign"], abs=1e-8)
    assert result.p == pytest.approx(row["p_chi2"], abs=1e-8)


def test_drawn_permutations_are_near_the_asymptotic_p():
    y = np.random.default_rng(2).normal(size=(60, 5))
    result = friedman(y, rng())
    assert result.method == "20000 permutations"
    # four standard errors of 20,000 draws, and χ² itself is near at n = 60
    assert result.exact == pytest.approx(result.p, abs=0.02)


def test_all_tied_is_undefined():
    result = friedman(np.ones((6, 3)), rng())
    assert result.chi2 == Undefined("every participant gives all conditions the same value")


@pytest.mark.parametrize("seed", range(5))
def test_signed_ranks_agree_with_scipy_without_ties(seed):
    scores = np.random.default_rng(seed).normal(0.3, 1, size=14)
    ours, theirs = signed_rank(scores), stats.wilcoxon(scores, method="exact")
    assert ours.p == pytest.approx(theirs.pvalue, rel=1e-12)
    positive = stats.rankdata(np.abs(scores))[scores > 0].sum()
    assert ours.v == positive


def test_signed_ranks_with_ties_against_all_signs():
    scores = np.array([1.0, 1.0, -1.0, 2.0, 3.0, 0.0, 3.0])
    size = stats.rankdata(np.abs(scores[scores != 0]))
    observed = size[scores[scores != 0] > 0].sum()
    sums = [np.dot(size, s) for s in itertools.product([0, 1], repeat=len(size))]
    share = np.mean([abs(s - size.sum() / 2) >= abs(observed - size.sum() / 2) for s in sums])
    assert signed_rank(scores).p == pytest.approx(share, rel=1e-12)


def test_sign_test_and_share_agree_with_scipy():
    assert sign_test(15, 1) == pytest.approx(stats.binomtest(15, 16).pvalue, rel=1e-12)
    assert sign_test(0, 0) == 1.0
    expected = stats.binomtest(15, 16).proportion_ci(0.95)
    assert share_interval(15, 16) == pytest.approx((expected.low, expected.high), rel=1e-9)


def test_post_hoc_agrees_with_holm_and_the_studentised_range():
    y = oracles.array("loftus_masson_1994", ["exposure"])
    pairs = post_hoc(y)
    gap = abs(pairs[2].rank_difference) / np.sqrt(3 * 4 / (12 * 10))
    assert pairs[2].nemenyi_p == pytest.approx(stats.studentized_range.sf(gap, 3, np.inf))
    raw = sorted(p.signed.p for p in pairs)
    assert min(p.holm_p for p in pairs) == pytest.approx(min(1, 3 * raw[0]))


@pytest.mark.parametrize("k", [2, 3, 4, 10])
@pytest.mark.parametrize("q", [0.0, 0.5, 3.3, 6.0])
def test_the_studentised_range_agrees_with_scipy(q, k):
    from seethrough.analysis.stats.distributions import studentized_range_tail

    expected = stats.studentized_range.sf(q, k, np.inf)
    assert studentized_range_tail(q, k) == pytest.approx(expected, abs=1e-9)  # scipy's own error


def test_where_no_two_levels_differ_there_is_no_signed_rank_and_nothing_to_correct():
    gone = Undefined("all differences are zero")
    assert signed_rank(np.zeros(5)) == SignedRank(0, gone, gone, "")
    y = np.random.default_rng(2).standard_normal((12, 3))
    y[:, 1] = y[:, 0]
    same, *others = post_hoc(y)
    assert same.signed == SignedRank(0, gone, gone, "") and same.holm_p == gone
    assert others[0].signed.p == others[1].signed.p  # both are column 0 − column 2
    assert [p.holm_p for p in others] == [min(1.0, 2 * others[0].signed.p)] * 2
