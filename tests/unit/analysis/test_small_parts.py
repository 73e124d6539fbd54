"""Small parts of the statistics, each by its closed form."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy import stats

from seethrough.analysis.load.ledger import POINTER, read_ledger
from seethrough.analysis.sections.answers import answers_other
from seethrough.analysis.stats.distributions import normal_two_sided
from seethrough.analysis.stats.split_plot import sum_coding
from seethrough.analysis.stats.undefined import Undefined
from seethrough.analysis.tradeoff import correlation


@pytest.mark.parametrize("z", [0.0, 0.3, -1.0, 1.959963984540054, -4.0])
def test_two_tails_of_the_normal(z):
    assert normal_two_sided(z) == pytest.approx(2 * stats.norm.sf(abs(z)), rel=1e-14)


def test_sum_contrasts():
    assert_array_equal(sum_coding(3), [[1, 0], [0, 1], [-1, -1]])


@pytest.mark.parametrize("slope", [2.0, -3.0])
def test_of_a_perfect_correlation_nothing_is_inferred(slope):
    x = np.array([1.0, 2.0, 4.0, 7.0, 11.0])
    found = correlation(x, slope * x)
    assert abs(found.r) == pytest.approx(1.0, abs=1e-12)
    assert found.p == Undefined("the correlation is perfect")


def test_a_correlation_is_fishers():
    x, y = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 7.0]), np.array([2.0, 1.0, 4.0, 3.0, 6.0, 4.0])
    found, known = correlation(x, y), stats.pearsonr(x, y)
    assert (found.r, found.p) == pytest.approx((known.statistic, known.pvalue), rel=1e-10)
    ends = known.confidence_interval(0.95)
    assert found.interval == pytest.approx((ends.low, ends.high), rel=1e-10)


@pytest.mark.parametrize(
    ("row", "named"),
    [
        ({"p": 0.1, "geometric_level": 2.0, "ratio": 0.9}, "ratio"),
        ({"p_exact": 0.1, "difference": 0.2}, "difference"),
        ({"contrast": "a/view=cut", "ratio": None}, "estimate"),
        ({"contrast": "a/view=cut", "ratio": 0.8}, "ratio"),
    ],
)
def test_a_stated_prediction_is_answered_by_the_rows_own_estimate(row, named):
    assert answers_other._estimate(row) == named


def test_a_ledger_elsewhere_is_known_by_its_address(tmp_path):
    address = "postgresql://lab@host/studies"
    (tmp_path / POINTER).write_text(address + "\n", encoding="utf-8")
    found = read_ledger(tmp_path)
    assert (found.where, found.entries) == (address, None)
