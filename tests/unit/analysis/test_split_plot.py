"""Groups of unequal size, contrasts with their own error, trends, ranks of groups: against R.

References: afex 1.2.1, base R 4.2.2 and exactRankTests, by tests/data/statistics/split_plot.R.
"""

from __future__ import annotations

from math import comb, prod

import numpy as np
import oracles
import pytest
from scipy import stats

from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.contrasts import estimate, trend, within_margin
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.split_plot import split_plot
from seethrough.analysis.stats.undefined import Undefined

WITHIN, BETWEEN = ("view", "light"), ("training", "age")
R = {row["what"]: float(row["value"]) for row in oracles.rows("contrasts")}


@pytest.fixture(scope="module")
def data():
    """y (28, 3, 2), the two groups' codes (28, 2), and the groups' names."""
    rows = oracles.rows("split_plot_data")
    y = oracles.array("split_plot_data", list(WITHIN), who="participant")
    people = {r["participant"]: (r["training"], r["age"]) for r in rows}
    levels = (["none", "some", "much"], ["young", "old"])
    codes = [[known.index(x) for known, x in zip(levels, own, strict=True)]
             for own in people.values()]  # fmt: skip
    return y, np.array(codes)


@pytest.mark.parametrize("measured", [(), ("age",), ("age", "training")])
def test_every_effect_is_afexs(data, measured):
    """15 effects of two factors within and two between, groups of 3 to 7: type III."""
    y, codes = data
    ours = split_plot(y, WITHIN, codes, BETWEEN, measured)
    case = " ".join(["measured", *measured])
    theirs = {r["effect"]: r for r in oracles.rows("split_plot") if r["case"] == case}
    assert set(ours) == set(theirs) and len(ours) == 15
    for name, row in theirs.items():
        e = ours[name]
        got = (e.df1, e.df2, e.f, e.p, e.ges, e.pes, e.eps, e.eps_hf)
        columns = ("df1", "df2", "F", "p", "ges", "pes", "eps", "hf")
        assert got == pytest.approx([float(row[c]) for c in columns], rel=1e-9), name


def test_of_one_group_it_is_the_plain_analysis(data):
    y, codes = data
    plain = repeated_measures(y, WITHIN)
    assert split_plot(y, WITHIN, codes[:, :0], ()) == plain


def test_an_offset_costs_no_digit(data):
    """Integers stay exact at 10¹⁵: every F within and between is the same to the last digits."""
    y, codes = data
    whole = np.rint(1000 * y)
    plain, far = (split_plot(v, WITHIN, codes, BETWEEN) for v in (whole, whole + 1e15))
    for name, effect in plain.items():
        assert far[name].f == pytest.approx(effect.f, rel=1e-9), name


def test_few_people_are_judged_by_the_lower_bound(data):
    """Six levels, five people: N − r = 4 ≤ q = 5, and ε means nothing."""
    rng = np.random.default_rng(2)
    few = repeated_measures(rng.normal(size=(5, 6)), ["c"])["c"]
    assert few.few and few.decisive == few.p_lower
    many = repeated_measures(rng.normal(size=(7, 6)), ["c"])["c"]
    assert not many.few and many.decisive == many.p_gg
    two = repeated_measures(rng.normal(size=(2, 2)), ["c"])["c"]
    assert not two.few  # one contrast needs no ε


def test_a_cell_of_groups_without_people_is_refused():
    groups = np.array([[0, 0], [0, 1], [1, 0], [1, 0]])
    with pytest.raises(ValueError, match="a group has nobody"):
        split_plot(np.random.default_rng(1).normal(size=(4, 2)), ["w"], groups, ["a", "b"])


def test_people_who_do_not_differ_have_no_test():
    y = np.repeat([[1.0, 2.0]], 6, axis=0)
    codes = np.array([[0], [0], [0], [1], [1], [1]])
    found = split_plot(y, ["w"], codes, ["g"])
    assert {type(e.f) for e in found.values()} == {Undefined}


def test_groups_are_compared_by_welch(data):
    y, codes = data
    level = y.reshape(len(y), -1).mean(axis=1)
    young, old = level[codes[:, 1] == 0], level[codes[:, 1] == 1]
    found = estimate([old, young], [1.0, -1.0])  # R sorts: old first
    sign = np.sign(found.t * R["welch t"])
    got = (sign * found.t, found.df, found.p, *sorted(sign * x for x in found.interval))
    names = ("welch t", "welch df", "welch p", "welch low", "welch high")
    assert got == pytest.approx([R[n] for n in names], rel=1e-9)


def test_one_group_is_students_t(data):
    y, _ = data
    scores = y[:, 0].mean(axis=1) - y[:, 1].mean(axis=1)
    views = list(dict.fromkeys(r["view"] for r in oracles.rows("split_plot_data")))
    scores = y[:, views.index("plain")].mean(axis=1) - y[:, views.index("cut")].mean(axis=1)
    found = estimate([scores], [1.0])
    got = (found.t, found.df, found.p)
    assert got == pytest.approx([R[f"one {n}"] for n in ("t", "df", "p")], rel=1e-9)


@pytest.mark.parametrize(
    ("sizes", "why"),
    [((2, 9), "a group of fewer than 3"), ((1,), "fewer than two participants")],
)
def test_too_few_for_a_contrast_are_refused(sizes, why):
    rng = np.random.default_rng(3)
    weights = [1.0, -1.0][: len(sizes)]
    assert estimate([rng.normal(size=n) for n in sizes], weights).p == Undefined(why)


def test_equivalence_of_groups_is_two_one_sided_tests():
    rng = np.random.default_rng(5)
    a, b = rng.normal(0, 1, 9), rng.normal(0.2, 2, 7)
    found = estimate([a, b], [1.0, -1.0])
    from scipy import stats

    lower = stats.ttest_ind(a + 1.5, b, equal_var=False, alternative="greater").pvalue
    upper = stats.ttest_ind(a - 1.5, b, equal_var=False, alternative="less").pvalue
    assert within_margin(found, 1.5) == pytest.approx((lower, upper, max(lower, upper)), rel=1e-9)


def test_trends_take_the_levels_own_numbers():
    """R's contr.poly(4, scores = c(80, 180, 380, 400)); the linear weights give a slope."""
    x = [80.0, 180.0, 380.0, 400.0]
    assert trend(x, 2) == pytest.approx([R[f"quadratic {i}"] for i in range(1, 5)], rel=1e-9)
    y = 3.0 + 0.25 * np.array(x)
    assert trend(x) @ y == pytest.approx(0.25, rel=1e-12)
    assert trend(x, 2) @ y == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(ValueError, match="a trend of degree 2 needs 3 different levels"):
        trend([1.0, 2.0], 2)


def test_ranks_of_groups_are_kruskal_and_walliss(data):
    y, codes = data
    level = y.reshape(len(y), -1).mean(axis=1)
    found = kruskal_wallis([level[codes[:, 0] == g] for g in range(3)], np.random.default_rng(1))
    assert (found.h, found.p) == pytest.approx((R["kruskal h"], R["kruskal p"]), rel=1e-9)
    # the permutation p is near χ² at this size, within .015, and drawn: four errors of 20,000
    assert found.exact == pytest.approx(found.p, abs=0.03) and "permutations" in found.method


@pytest.mark.parametrize("ones", [(4, 1, 0), (3, 2, 0), (2, 2, 1)])
@pytest.mark.parametrize("sizes", [(7, 7, 7), (90, 110, 100)])
def test_three_groups_of_yes_and_no_have_the_p_of_all_ways_to_deal_the_yes(ones, sizes):
    """Of 5 yes among n: each way (a, b, c) has Π C(size, own) / C(n, 5); as far as the observed one
    or farther by Σ own² / size, in whole numbers, for that alone varies in H."""
    groups = [np.repeat([1.0, 0.0], [k, n - k]) for k, n in zip(ones, sizes, strict=True)]
    found = kruskal_wallis(groups, np.random.default_rng(3))

    def far(ways):
        return sum(k * k * prod(sizes) // n for k, n in zip(ways, sizes, strict=True))

    every = [(a, b, 5 - a - b) for a in range(6) for b in range(6 - a)]
    chance = {ways: prod(map(comb, sizes, ways)) / comb(sum(sizes), 5) for ways in every}
    p = min(1.0, sum(c for ways, c in chance.items() if far(ways) >= far(ones)))
    error = np.sqrt(p * (1 - p) / 20_000)  # of the drawn share; one is added above and below
    counts = [[k, n - k] for k, n in zip(ones, sizes, strict=True)]
    pearson = stats.chi2_contingency(counts, correction=False).statistic
    assert found.h == pytest.approx(pearson * (sum(sizes) - 1) / sum(sizes), rel=1e-9)
    assert found.method == "20000 permutations"
    assert found.exact == pytest.approx(p, abs=4 * error + 1 / 20_000)


def test_two_groups_with_ties_are_enumerated():
    """exactRankTests' wilcox.exact of 1 2 2 3 5 against 2 4 5 5 6 7."""
    groups = [np.array([1.0, 2, 2, 3, 5]), np.array([2.0, 4, 5, 5, 6, 7])]
    found = kruskal_wallis(groups, np.random.default_rng(1))
    assert found.exact == pytest.approx(R["exact rank sum p"], rel=1e-12)
    assert found.method == "exact"


def test_groups_that_are_all_alike_have_no_test():
    same = [np.ones(4), np.ones(5)]
    assert kruskal_wallis(same, np.random.default_rng(1)).exact == Undefined("all values are equal")


def test_welch_keeps_its_size_where_the_pooled_error_does_not():
    """4 and 12 people, s.d. 3 and 1, no difference: 4,000 studies from a seed."""
    rng = np.random.default_rng(7)
    runs = 4000
    small, large = 3 * rng.standard_normal((runs, 4)), rng.standard_normal((runs, 12))
    ours = np.mean([estimate([a, b], [1, -1]).p < 0.05 for a, b in zip(small, large, strict=True)])
    codes = np.repeat([[0], [1]], [4, 12], axis=0)
    pooled = np.mean([
        split_plot(np.concatenate([a, b]), (), codes, ["g"])["g"].p < 0.05
        for a, b in zip(small[:1000], large[:1000], strict=True)
    ])  # fmt: skip
    error = np.sqrt(0.05 * 0.95 / runs)
    assert ours < 0.06 + 3 * error  # definitions of this analysis: .05 to .06 for groups of four
    assert pooled > 0.15


@pytest.mark.parametrize(
    ("x", "quadratic"),
    [((0, 1, 2), (1, -2, 1)), ((0, 2, 1), (1, 1, -2)), ((3, 1, 2), (1, 1, -2)),
     ((1, 2, 3, 4), (1, -1, -1, 1)), ((2, 1, 4, 3), (-1, 1, 1, -1))],
)  # fmt: skip
def test_a_quadratic_trend_opens_upwards_whatever_the_order_of_the_levels(x, quadratic):
    w = np.array(quadratic, float)
    assert trend(x, 2) == pytest.approx(w / np.sqrt((w**2).sum()), abs=1e-12)
