"""Equal up to rounding is equal: ranks, signs and ties of computed numbers."""

from __future__ import annotations

import csv
import itertools
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from made_data import TRIAL_COLUMNS, Made, make_folder, write_rows
from scipy import stats

from seethrough.analysis.cells import table_of
from seethrough.analysis.comparison import Pair, pair_of, sd_of
from seethrough.analysis.design import Contrast, Design
from seethrough.analysis.exclude import apply_rules, focus_lost
from seethrough.analysis.report import Options, make_report, tables_of
from seethrough.analysis.sections.robust import _row
from seethrough.analysis.sections.tests.ordinal import friedman_row
from seethrough.analysis.stats.flips import sign_flip
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.paired import paired
from seethrough.analysis.stats.ranks import friedman, post_hoc, ranks, sign_test, signed_rank
from seethrough.analysis.stats.ties import difference_signs, is_constant, levels, slack
from seethrough.analysis.stats.undefined import is_defined
from seethrough.experiment.power.decisions import Test, run
from seethrough.experiment.power.planned import Score
from seethrough.experiment.power.power_data import scores_of

# Ten people, three ratings each: the sums of the other condition's are smaller by D, so the means
# differ by ±2/3, computed in many ways.
A = np.array([[1, 1, 2], [2, 2, 2], [0, 1, 1], [3, 3, 4], [1, 2, 2],
              [4, 4, 3], [0, 0, 2], [2, 3, 3], [1, 1, 1], [4, 4, 4]], dtype=float)  # fmt: skip
D = np.array([2, 2, 2, 2, 2, -2, -2, 2, 2, -2.0])


def test_thirds_that_differ_in_the_last_bit_are_tied():
    """exactRankTests: V = 38.5, p = .34375; without ties one gets 40 and .230."""
    first, second = A.mean(axis=1), (A.sum(axis=1) - D) / 3
    assert len(np.unique(np.abs(first - second))) > 1  # the rounding is there
    for result in (
        signed_rank(first - second),
        signed_rank(first - second, slack(first, second)),
        post_hoc(np.stack([first, second, first + 1], axis=1))[0].signed,
    ):
        assert (result.v, result.p) == (38.5, 0.34375)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("items", [3, 6, 7, 10])
def test_signed_ranks_of_means_are_those_of_the_sums(seed, items):
    """Whole-number sums are exact, and means of as many items have the same ranks."""
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 5, (2, 12, items))
    exact = signed_rank((a.sum(axis=1) - b.sum(axis=1)).astype(float))
    first, second = a.mean(axis=1), b.mean(axis=1)
    assert signed_rank(first - second, slack(first, second)) == exact


@pytest.mark.parametrize("seed", range(10))
def test_friedman_of_means_is_that_of_sums(seed):
    """Means taken in another order of their items, as tables give them."""
    rng = np.random.default_rng(seed)
    items = rng.integers(0, 5, (9, 4, 6)).astype(float) / 10
    sums = np.rint(items.sum(axis=2) * 10)
    means = np.stack([items[:, j, rng.permutation(6)].mean(axis=1) for j in range(4)], axis=1)
    np.testing.assert_array_equal(ranks(means), ranks(sums))
    one, other = friedman(means, rng), friedman(sums, rng)
    assert (one.chi2, one.w) == (other.chi2, other.w)


def test_steps_of_a_fortieth_are_tied_as_the_decimals_are():
    """scipy issue 17667: .5 s a step, the differences equal as decimals and not as doubles."""
    steps = [1, -1, 2, 2, -3, 1, 4, -2, 2, 5]
    a = np.array([0.075 + 0.025 * i for i in range(10)])
    b = np.array([0.075 + 0.025 * (i - s) for i, s in enumerate(steps)])
    exact = signed_rank(np.array(steps, dtype=float))
    assert signed_rank(a - b, slack(a, b)) == exact
    assert difference_signs(a, b).tolist() == np.sign(steps).tolist()


@pytest.mark.parametrize("seed", range(30))
def test_signs_are_those_of_fractions(seed):
    """Means of decimals: the sign of the exact difference of what was written."""
    rng = np.random.default_rng(seed)
    a, b = rng.integers(0, 4, (2, 40, 3))
    scale = 10.0 ** rng.integers(-3, 7)
    first, second = (a * 0.1 * scale).mean(axis=1), (b * 0.1 * scale)[:, ::-1].mean(axis=1)
    exact = [Fraction(int(x), 30) - Fraction(int(y), 30) for x, y in
             zip(a.sum(axis=1), b.sum(axis=1), strict=True)]  # fmt: skip
    assert difference_signs(first, second).tolist() == [(e > 0) - (e < 0) for e in exact]


def test_what_differs_stays_apart():
    """A unit at 10¹⁵ among whole numbers, a microsecond, and a neighbour of an outlier."""
    large = 1e15 + np.array([0.0, 1, 2])
    assert levels(large, slack(large[:, None])).tolist() == [0, 1, 2]
    close = np.array([30.0, 30.000001, 30.000002])
    assert levels(close, slack(close[:, None])).tolist() == [0, 1, 2]
    beside = np.array([1e6, 2.0, 2.0 + 1e-12])
    assert levels(beside, slack(beside[:, None])).tolist() == [2, 0, 1]


def test_constant_up_to_rounding():
    assert is_constant(np.array([0.1 + 0.2, 0.3, 0.3]))
    assert not is_constant(np.array([0.3, 0.3 + 1e-9]))
    assert is_constant(np.array([]))


@pytest.mark.parametrize("n", range(1, 13))
def test_the_sign_test_counts(n):
    """Against all outcomes, in whole numbers; as close to even as can be it is exactly 1."""
    heads = [sum(flips) for flips in itertools.product((0, 1), repeat=n)]
    for wins in range(n + 1):
        far = sum(abs(2 * h - n) >= abs(2 * wins - n) for h in heads)
        assert sign_test(wins, n - wins) == far / len(heads)


@pytest.mark.parametrize("total", [999, 2000, 2001, 50_000])
def test_the_sign_test_of_many_agrees_with_scipy(total):
    wins = total // 2 - int(total**0.5)
    assert sign_test(wins, total - wins) == pytest.approx(
        stats.binomtest(wins, total).pvalue, rel=1e-9
    )


def test_permutation_p_of_an_ordinary_table_is_at_most_one():
    """The middle of the distribution: all outcomes are as far out, so p is 1 and not .99…96."""
    y = np.array([[1, 2, 3], [2, 3, 1], [3, 1, 2.0]] * 3)
    assert friedman(y, np.random.default_rng(0)).exact == 1.0
    assert signed_rank(np.array([1.0, -1, 2, -2, 3, -3, 4, -4])).p == 1.0


def test_power_by_ranks_takes_ties_as_the_report_does():
    """Means of thirds in two orders: nobody is better."""
    first = A.mean(axis=1)
    second = np.array([(row[2] / 3 + row[1] / 3) + row[0] / 3 for row in A])
    assert (first != second).any()
    scores = scores_of(Score(None, "", None), first, second)
    found = run(Test("x", 0, ranked=True), [scores[None, :, None]])
    assert not found.there.any()
    assert found.p.tolist() == [1.0]


def test_a_share_of_missed_frames_of_exactly_a_twentieth_is_not_more():
    import pandas as pd

    frames = np.arange(20, 20_001, 20)
    table = pd.DataFrame({"participant": "p", "trial": range(len(frames)), "attempt": 1,
                          "source": "human", "frames": frames, "frames_missed": frames // 20,
                          "row_id": "r", "_file": "f", "_row": 1})  # fmt: skip
    assert len(apply_rules(table, ("frames_missed",))[0]) == len(table)
    more = table.assign(frames_missed=table["frames_missed"] + 1)
    assert len(apply_rules(more, ("frames_missed",))[0]) == 0


def test_focus_is_not_lost_by_rounding():
    import pandas as pd

    table = pd.DataFrame({"time": [0.1 + 0.2, 3.0], "time_clean": [0.3, 2.99]})
    assert focus_lost(table).tolist() == [False, True]


CANCELLED = np.array([4 / 3, -1.0, -1 / 3]).mean()
"""0, of a person's three cells on a scale from −2 to 2: −1.9 · 10⁻¹⁷."""


def test_means_of_what_cancels_are_tied_with_zero():
    """Three people without a difference and three for one side: p = 2 / 2³, χ² 3."""
    assert CANCELLED != 0
    first = np.array([CANCELLED] * 3 + [1 / 3, 2 / 3, 1.0])
    y = np.stack([first, np.zeros(6)], axis=1)
    found = friedman(y, np.random.default_rng(0), largest=2.0)
    assert (found.chi2, found.exact) == (3.0, 0.25)
    assert ranks(np.stack([first, first * 0, first * 0 + 1], axis=1), 2.0)[0].tolist() == [
        1.5,
        1.5,
        3,
    ]
    pair = post_hoc(np.stack([first, first * 0, first * 0 + 1], axis=1), 2.0)[0]
    assert (pair.signed.n, pair.signed.v) == (3, 6.0)


def test_groups_of_means_of_what_cancels_are_tied():
    """R's wilcox.test with ties: the same ranks as for whole sixths."""
    parts = [[CANCELLED, 0.0, 1 / 3], [0.0, 0.0, 2 / 3]]
    whole = [[0.0, 0.0, 2.0], [0.0, 0.0, 4.0]]
    rng = np.random.default_rng(0)
    mine, right = (
        kruskal_wallis([np.array(g) for g in groups], rng, largest)
        for groups, largest in ((parts, 2.0), (whole, 0.0))
    )
    assert mine == right


def test_cells_know_how_large_what_they_are_made_of_is():
    """The report's Friedman rows tie what the plain test does not."""
    values = np.array([[[4 / 3, -1.0, -1 / 3], [0.0, 0, 0]]] * 3 + [[[1.0, 1, 1], [0, 0, 0]]] * 3)
    factors = {"view": ("a", "b"), "item": ("x", "y", "z")}
    cells = table_of(values, np.ones(values.shape, int), [f"p{i}" for i in range(6)], factors)
    pair = pair_of("k", "k", "", 2, cells, Contrast("view", "a", "b", "a", "b", False))
    context = SimpleNamespace(rng=np.random.default_rng)
    row = friedman_row(pair, context, 1)
    assert (row["chi2"], row["p_exact"]) == (3.0, 0.25)


def test_means_of_one_set_of_trials_in_two_orders_do_not_differ_without_normality_either():
    """What the main table calls equal is not given a p of its rounding (it was .339)."""
    times = np.random.default_rng(1).uniform(5, 30, (12, 3))
    first, second = times.mean(axis=1), times[:, ::-1].mean(axis=1)
    assert (first != second).any()
    assert not is_defined(paired(first, second).p)
    context = SimpleNamespace(rng=np.random.default_rng, design=Design((), ()))
    row = _row(context, Pair("k", "k", "", 2, first, second), False, 1)
    assert [is_defined(row[name]) for name in ("p", "p_flip", "p_without")] == [False] * 3


@pytest.mark.parametrize("base", [0.0, 1e9])
def test_sign_flips_tie_what_is_as_far_off(base):
    """Thirds on a large offset: all 2¹⁰ signs of whole numbers, counted."""
    steps = np.array([1, -2, 3, 1, 0, 2, -1, 2, 1, 3.0])
    first, second = base + (4 + steps) / 3, np.full(10, base + 4 / 3)
    flips = np.array(list(itertools.product((-1, 1), repeat=10)))
    right = float(np.mean(np.abs(flips @ steps) >= abs(steps.sum())))
    scale = float(np.max(np.abs([first, second])))
    assert sign_flip(first - second, np.random.default_rng(0), scale)[0] == right


@pytest.mark.parametrize("share", [0.9, 0.7, 1 / 3])
@pytest.mark.parametrize("n", [6, 7, 18, 19])
def test_shares_that_are_all_alike_have_no_spread(share, n):
    """numpy's s.d. of eighteen .9 is 2 · 10⁻¹⁶, and their mean's t against .8 then 10¹⁵."""
    assert sd_of(np.full(n, share)) == 0.0


def test_equal_log_times_show_no_learning(tmp_path):
    """All trials of a set took as long: slopes of 10⁻¹⁷ are not tested."""
    folder = make_folder(tmp_path / "data", Made(participants=6, trials=7))
    for table in folder.rglob("*_trials_data.csv"):
        with open(table, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            time = 7.3 + 0.1 * (int(row["block"]) - 1) + 0.37 * (int(row["slot"]) - 1)
            row["time"] = row["time_clean"] = repr(time)
        write_rows(table, TRIAL_COLUMNS, rows)
    report = make_report(folder, Options())
    table = next(t for t in tables_of(report) if t.key == "learning")
    assert not is_defined(table.rows[0]["p"])
    assert table.rows[0]["ratio"] == pytest.approx(1, abs=1e-12)
