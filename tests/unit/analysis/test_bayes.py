"""Bayes factors of effects with several degrees of freedom, and tests that an effect is small."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import oracles
import pytest
from scipy import stats

from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.distributions import bayes_factor_f, bayes_factor_t, negligible_p

R = np.sqrt(0.5)


def by_brute_force(y: np.ndarray) -> float:
    """BF10 of a one-factor table (n, 3) from likelihood and prior themselves.

    Two orthonormal contrasts c_ij ~ N(δ_j σ, σ²); δ a bivariate Cauchy of scale √½, whose density
    is written out; p(σ) ∝ 1/σ. No mixture over g, no closed form: sums over a grid of (δ₁, δ₂) in
    polar coordinates about 0 and of ln σ.
    """
    n = len(y)
    q = np.array([[-1, 1, 0], [-1, -1, 2]]) / np.sqrt([[2], [6]])
    c = y @ q.T
    size = float(np.hypot(*c.mean(axis=0)))  # δ can be turned: only its length and angle matter
    sse = float(((c - c.mean(axis=0)) ** 2).sum())
    ln_s = np.linspace(np.log(np.sqrt(sse / (2 * n))) - 2.5, np.log(np.sqrt(sse / n)) + 2.5, 161)
    s = np.exp(ln_s)
    rho = np.exp(np.linspace(-9, 7, 321))
    angle = np.linspace(0, 2 * np.pi, 240, endpoint=False)
    radius, turn, sigma = np.meshgrid(rho, angle, s, indexing="ij", sparse=True)
    gap = size**2 - 2 * size * radius * sigma * np.cos(turn) + (radius * sigma) ** 2
    density = (1 + radius**2 / R**2) ** -1.5 / (2 * np.pi * R**2)
    area = radius**2 * np.log(rho[1] / rho[0]) * (angle[1] - angle[0])
    log_scale = 2 * n * np.log(s)

    def likelihood(sum_of_squares: np.ndarray) -> np.ndarray:
        log = -log_scale - sum_of_squares / (2 * s**2)
        return np.exp(log - peak)

    null = sse + n * size**2
    peak = float(np.max(-log_scale - null / (2 * s**2)))
    inside = (likelihood(sse + n * gap) * density * area).sum()
    return float(inside / likelihood(np.array(null)).sum())


@pytest.mark.parametrize("shift", [0.0, 0.4, 0.9])
def test_two_degrees_of_freedom_agree_with_brute_force(shift):
    rng = np.random.default_rng(3)
    y = rng.normal(size=(9, 3)) + rng.normal(size=(9, 1)) + shift * np.arange(3)
    f = repeated_measures(y, ["c"])["c"].f
    # the grid of 12 million points is good to about 1e-4
    assert bayes_factor_f(f, 2, 9) == pytest.approx(by_brute_force(y), rel=5e-4)


def test_one_degree_of_freedom_is_the_published_paired_factor():
    """R's sleep data: BayesFactor prints 17.2589."""
    y = oracles.array("r_sleep", ["drug"])
    f = repeated_measures(y, ["drug"])["drug"].f
    expected = oracles.values()["datasets"]["r_sleep"]["R"]["paired"]["BF10_JZS_r707"]
    assert bayes_factor_f(f, 1, 10) == pytest.approx(expected, rel=1e-8)
    assert bayes_factor_t(-np.sqrt(f), 10) == pytest.approx(expected, rel=1e-8)


def test_no_effect_speaks_for_the_null_and_the_more_so_the_more_contrasts():
    factors = [bayes_factor_f(0.0, q, 30) for q in (1, 2, 3, 6)]
    assert all(a > b for a, b in pairwise(factors))
    assert factors[0] < 1 / 3


def test_a_huge_effect_does_not_overflow():
    assert str(bayes_factor_f(1e9, 3, 200)) == "undefined: larger than 10^304"


@pytest.mark.parametrize(("f", "df1", "df2"), [(0.3, 3, 45), (2.0, 3, 45), (1.1, 1, 15)])
def test_a_negligible_effect_by_the_noncentral_f(f, df1, df2):
    """Campbell & Lakens 2021: p = P(F ≤ f) at the margin; scipy.stats has its own noncentral F."""
    nc = df2 * 0.06 / 0.94
    assert negligible_p(f, df1, df2, 0.06) == pytest.approx(
        stats.ncf.cdf(f, df1, df2, nc), abs=1e-9
    )


def test_the_test_of_negligibility_keeps_its_level():
    """At the margin itself p is uniform: 4,000 draws of a noncentral F, 5 % below .05."""
    nc = 45 * 0.06 / 0.94
    draws = stats.ncf.rvs(3, 45, nc, size=4000, random_state=1)
    share = np.mean([negligible_p(f, 3, 45, 0.06) < 0.05 for f in draws])
    # three standard errors of a share of .05 in 4000
    assert share == pytest.approx(0.05, abs=3 * np.sqrt(0.05 * 0.95 / 4000))
