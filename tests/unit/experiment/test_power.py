"""Power against closed forms, published values and the report's own decisions."""

from dataclasses import replace
from math import inf, log, sqrt

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats

from seethrough.analysis.stats.contrasts import estimate
from seethrough.analysis.stats.multiplicity import holm
from seethrough.analysis.stats.paired import paired, ratio_within, tost
from seethrough.analysis.stats.ranks import friedman
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.power import effects
from seethrough.experiment.power.closed import interval_of, needed, signed_power
from seethrough.experiment.power.decisions import Part, Planned, Results, Test, decide, run
from seethrough.experiment.power.planned import Score, plans_of
from seethrough.experiment.power.power import Point, curve, enough
from seethrough.experiment.power.power_data import scores_of
from seethrough.experiment.power.sources import Normal, Sampled, sizes
from seethrough.experiment.study.config import load

RNG = np.random.default_rng(5)
FASTER = Test("faster", 0, 1.0)


def shift(delta, columns=1):
    """Normal scores of that standardised mean."""
    return Normal(np.full((1, columns), delta), np.ones((1, columns)))


def test_closed_form_agrees_with_published_values():
    # Sample sizes for 80 % that every power table prints: dz .35 → 67, .5 → 34, .8 → 15.
    assert [needed(dz, 0.05) for dz in (0.35, 0.5, 0.8)] == [67, 34, 15]
    # Superpower's ANOVA_exact, σ = 1, ρ = .5, Δ = .5: dz = .5/√.5; the other tail is below 1e-5.
    assert_allclose(signed_power(0.5 / 0.5**0.5, 16, 0.05), 0.75298, atol=1e-5)
    assert_allclose(
        signed_power(0.0, 16, 0.05), 0.025, rtol=1e-9
    )  # false, and by luck the right way
    assert needed(0.0, 0.05) == needed(-0.3, 0.05) == inf
    # The larger an effect the fewer it takes, to effects that nobody could overlook.
    grown = [needed(delta, 0.05) for delta in (0.1, 0.3, 1.0, 3.0, 10.0, 100.0)]
    assert grown == sorted(grown, reverse=True) and grown[-1] == 3
    # One-sided, 80 %: dz .5 takes 27 (G*Power 3.1, t test, one sample).
    assert needed(0.5, 0.05, sides=1) == 27


def wrong_sign(delta, n, alpha):
    """Type S: P(wrong sign | p < α), two-sided."""
    right, wrong = (signed_power(d, n, alpha) for d in (delta, -delta))
    return wrong / (right + wrong)


def test_type_s_and_m_are_those_of_the_definitions():
    """n = 16: d_z .3 exaggerates 2.1 times; .1 has the wrong sign in .15 of what is significant."""
    assert_allclose(wrong_sign(0.1, 16, 0.05), 0.15, atol=0.005)
    for delta, larger in ((0.3, 2.1), (0.1, 5.6)):
        planned = [Planned("P", "", (FASTER,))]
        _, tests = curve(planned, shift(delta), [16], 20_000, 0.05, 1, {"faster": delta})
        assert_allclose(tests[0].exaggerated, larger, rtol=0.03)  # printed to two digits
        s = wrong_sign(delta, 16, 0.05)
        shown = signed_power(delta, 16, 0.05) / (1 - s) * 20_000
        assert abs(tests[0].wrong - s) < 4 * sqrt(s * (1 - s) / shown) + 1e-3


def test_drawing_agrees_with_the_closed_form_and_counts_the_right_sign_alone():
    planned = [Planned("P", "", (FASTER,))]
    for delta in (0.5, 0.0, -0.5):
        points, _ = curve(planned, shift(delta), (8, 16, 34), 4000, 0.05, 1, {"faster": delta})
        for point in points:
            exact = signed_power(delta, point.n, 0.05)
            assert abs(point.power - exact) < 4 * max(sqrt(exact * (1 - exact) / 4000), 1 / 4000)
            assert point.low <= point.power <= point.high
            other = signed_power(-delta, point.n, 0.05)
            assert abs(point.against - other) < 4 * max(sqrt(other * (1 - other) / 4000), 1 / 4000)


def test_tests_are_those_of_the_report():
    """p of single studies against the report's functions, groups of unequal size among them."""
    first, second = RNG.lognormal(1, 0.5, (2, 12))
    d = first - second
    wide = np.stack([d, 1.2 * first - second, second - first / 1.2], axis=1)[None]
    assert_allclose(run(FASTER, [wide]).p[0], paired(first, second).p, rtol=1e-9)
    no_worse = Test("x", 0, parts=(Part(0, 1.0, 0.4),))
    assert_allclose(run(no_worse, [wide]).p[0], tost(d, 0.4).p_low, rtol=1e-9)
    same = Test("x", 0, parts=(Part(0, 1.0, 0.4), Part(0, -1.0, 0.4)))
    assert_allclose(run(same, [wide]).p[0], tost(d, 0.4).p, rtol=1e-9)
    ratio = Test("x", 0, parts=(Part(1), Part(2)))
    assert_allclose(run(ratio, [wide]).p[0], ratio_within(first, second, 1.2).p, rtol=1e-9)
    a, b = RNG.normal(0.4, 1, (4, 1)), RNG.normal(0, 3, (9, 1))
    found = run(Test("x", 0, weights=(1.0, -1.0)), [a[None], b[None]])
    welch = estimate([a[:, 0], b[:, 0]], [1.0, -1.0])
    assert_allclose(found.p[0], welch.p, rtol=1e-9)
    assert_allclose(found.p[0], stats.ttest_ind(a, b, equal_var=False).pvalue[0], rtol=1e-9)


def test_order_alone_is_friedmans_exact_test():
    pairs = RNG.integers(0, 4, (9, 2)).astype(float)
    d = (pairs[:, 0] - pairs[:, 1])[None, :, None]
    ranked = Test("x", 0, 1.0, ranked=True)
    assert_allclose(run(ranked, [d]).p[0], friedman(pairs, RNG).exact, rtol=1e-12)


@pytest.mark.parametrize("size", [1e-14, 1.0, 1e9])
def test_levels_are_tied_by_the_size_of_what_they_were_made_from(size):
    """4/3 − 8/3 and 2/3 − 2 differ in the last bit, whose size is that of the values: no fixed
    bound tells a tie from a difference of any measure."""
    first = size * np.array([4 / 3 - 8 / 3, 0.1 + 0.2, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5])
    second = size * np.array([2 / 3 - 2, 0.3, 0.0, 0.1, 0.2, 0.3, 0.2, 0.1])
    found = scores_of(Score(None, "", None), first, second)
    assert np.sign(found).tolist() == [0, 0, 1, 1, 1, 1, 1, 1]
    tested = run(Test("x", 0, 1.0, ranked=True), [found[None, :, None]])
    assert_allclose(tested.p[0], friedman(np.stack([first, second], axis=1), RNG).exact, rtol=1e-12)
    assert_allclose(tested.p[0], 2 / 2**6, rtol=1e-12)


def test_people_who_lack_a_score_are_left_out_of_that_test_alone():
    d = RNG.normal(0.5, 1, (1, 10, 1))
    gone = np.concatenate([d, np.full((1, 3, 1), np.nan)], axis=1)
    assert_allclose(run(FASTER, [gone]).p, run(FASTER, [d]).p, rtol=1e-12)


def test_equal_scores_are_no_evidence():
    same = np.full((1, 8, 1), 0.1 + 0.2)
    found = run(FASTER, [same])
    assert not found.there[0] and found.p[0] == 1.0


def results(*p, fits=1, there=True):
    return [Results(np.array([x]), np.array([1.0]), np.array([fits]), np.array([there])) for x in p]


def test_all_are_needed_or_one_by_holm():
    tests = (FASTER, replace(FASTER, name="b"), replace(FASTER, name="c"))
    every, some = Planned("P", "", tests), Planned("P", "", tests, any=True)
    p = (0.001, 0.02, 0.04)
    assert decide(every, results(*p), 0.05).supported[0]
    assert not decide(every, results(0.001, 0.02, 0.06), 0.05).supported[0]
    assert decide(some, results(0.016, 0.5, 0.9), 0.05).supported[0] == (
        holm([0.016, 0.5, 0.9])[0] < 0.05
    )
    assert not decide(some, results(0.02, 0.5, 0.9), 0.05).supported[0]
    wrong = decide(every, results(*p, fits=-1), 0.05)
    assert wrong.against[0] and not wrong.supported[0]
    # What nobody can test says nothing where others do; alone it supports nothing.
    gone = results(1.0, there=False)
    assert decide(every, [*results(0.01, 0.01), *gone], 0.05).supported[0]
    assert not decide(Planned("P", "", (FASTER,)), gone, 0.05).supported[0]


def test_the_interval_of_n_carries_the_pilots_doubt():
    """A 95 % interval holds the truth; its end is ∞ where the pilot is not significant itself."""
    delta = 0.75
    missed = 1 - signed_power(delta, 16, 0.05)
    rng, endless, covered = np.random.default_rng(2), 0, 0
    for _ in range(100):
        d = rng.normal(delta, 1, 16)
        low, high = interval_of(d.mean() / d.std(ddof=1), 16, 15)
        covered += low <= delta <= high
        endless += needed(low, 0.05) == inf
    assert 85 <= covered <= 100
    assert needed(interval_of(0.4, 16, 15)[0], 0.05) == inf
    assert abs(endless / 100 - missed) < 3 * sqrt(missed * (1 - missed) / 100)


def test_what_the_page_says_of_few_people_and_skewed_scores():
    """Lognormal values of equal means and s.d. of .8 and .3 of them, r = .6 of logarithms."""
    rng = np.random.default_rng(1)
    spread = [sqrt(log(1 + cv * cv)) for cv in (0.8, 0.3)]
    for n, said in ((8, 0.11), (16, 0.10), (32, 0.08)):
        z = rng.standard_normal((2, 8000, n))
        z[1] = 0.6 * z[0] + 0.8 * z[1]
        first, second = (np.exp(s * x - s * s / 2) for s, x in zip(spread, z, strict=True))
        found = run(FASTER, [(first - second)[..., None]])
        assert abs((found.p < 0.05).mean() - said) < 0.005 + 3 * sqrt(0.1 * 0.9 / 8000)


def test_sizes_of_groups_add_up():
    assert sizes((1.0,), 7) == [7]
    assert sizes((10, 4), 14) == [10, 4] and sizes((10, 4), 7) == [5, 2]
    assert sizes((0.9, 0.1), 8) == [6, 2] or min(sizes((0.9, 0.1), 8)) == 2


def test_sampled_people_stay_together():
    people = Sampled((np.arange(10.0)[:, None] * [1, 10],), (1.0,))
    (drawn,) = people.draw(np.random.default_rng(1), 5, 8)
    assert drawn.shape == (5, 8, 2) and np.array_equal(drawn[..., 1], 10 * drawn[..., 0])


def test_a_study_is_asked_its_own_predictions_and_nothing_else():
    plans = plans_of(effects.design_of(load("published")))
    assert [p.name for p in plans.planned] == ["P1", "P2", "P3"]
    first, second, third = plans.planned
    assert [t.name for t in first.tests] == ["completion time overall"] and first.tests[0].sign == 1
    assert "right answers T2 pattern not worse" in [t.name for t in second.tests]
    assert not any("right answers T1" in t.name for t in second.tests)  # judged by how far off
    (part,) = third.tests[0].parts
    assert part.shift == -2.5
    distance = next(t for t in second.tests if t.name.startswith("distance"))
    assert distance.parts[0].shift == 3.0 and distance.parts[0].sign == 1.0


def test_a_study_without_predictions_is_asked_its_contrasts():
    study = load("clutter")
    plans = plans_of(effects.design_of(study))
    factors = {f.name for f in study.factors}
    asked = {s.contrast.factor for s in plans.scores}
    assert (
        asked <= factors
        and plans.planned
        and all(t.sign == 0 for p in plans.planned for t in p.tests)
    )


def test_groups_are_set_against_each_other():
    """Two groups and d .5 take 64 each (every table of power); what is not played is said."""
    effect = effects.effect_of(load("training"), "training=0.5 sd", None, None)
    (time,) = (p for p in effect.put if p.test.name.startswith("completion time"))
    assert sorted(time.test.weights) == [-1.0, 1.0]
    points, tests = curve(effect.planned, effect.source, [128], 4000, 0.05, 1, effect.truth)
    found = next(t for t in tests if t.name == time.test.name)
    assert abs(found.power - 0.80) < 4 * sqrt(0.8 * 0.2 / 4000)
    assert abs(found.exaggerated - 1.12) < 0.05  # M at a power of .8 (Gelman and Carlin 2014)
    assert points and any("ranks between groups are not played" in line for line in effect.alone)


def test_published_effects_are_the_papers():
    effect = effects.effect_of(load("published"), "published", None, None)
    put = {p.test.name: p for p in effect.put}
    overall = put["completion time overall"]
    # lognormal moments by hand: median ratio of 65.17 (27.75) and 28.69 (11.02)
    a, b = log(1 + (27.75 / 65.17) ** 2), log(1 + (11.02 / 28.69) ** 2)
    ratio = (28.69 / sqrt(1 + (11.02 / 28.69) ** 2)) / (65.17 / sqrt(1 + (27.75 / 65.17) ** 2))
    assert overall.said == f"ratio {ratio:.3g}" and a > b > 0
    assert overall.interval[0] <= overall.n <= overall.interval[1]
    assert put["distance T3 unique not worse"].interval[1] == inf
    assert any("prints no numbers" in line for line in effect.alone)


def test_an_assumed_effect_needs_what_the_tables_say(tmp_path, capsys):
    out = tmp_path / "p.html"
    words = ["power", "published", "--effect", "P1=0.5 sd", "--participants", "30..38"]
    assert cli.main([*words, "--replications", "4000", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "assumed: In each test of P1" in said and "\nP2" not in said
    (line,) = (x for x in said.splitlines() if x.startswith("P1 "))
    assert abs(int(line.split()[1]) - 34) <= 2  # 4,000 draws: s.e. .006, and .01 an n
    text = out.read_text("utf-8")
    assert text.index("Assumed.") < text.index("<svg") and ">34<" in text


@pytest.mark.parametrize(
    "effect, more, message",
    [
        ("P9=0.2 sd", [], r"--effect = P9: expected one of P1, P2, P3, transparency"),
        ("P1=20 %", [], r"--effect: 20 %: expected --spread S as well"),
        ("P1=20 units", [], r"--effect: 20 units: completion time overall: expected sd or %"),
        ("nowhere", [], r'--effect = nowhere: expected "PREDICTION=0.2 sd", published, or a data'),
    ],
)
def test_bad_effects_are_refused_in_a_line(effect, more, message):
    with pytest.raises(InputError, match=message):
        effects.effect_of(load("published"), effect, None, None)


def test_printed_numbers_are_for_the_published_study_alone():
    with pytest.raises(InputError, match="--effect = published: expected the published study's"):
        effects.effect_of(load("clutter"), "published", None, None)


@pytest.mark.parametrize(
    ("more", "value", "said"),
    [
        ({"log": True}, log(2), "ratio 0.5"),  # twice as long with the baseline
        ({"unit": "s"}, 2.0, "-2 s"),  # scores are baseline − level, and it says level − baseline
        ({}, 0.0, "+0"),
        ({"single": True}, 2.0, "2"),  # no difference: its own value
    ],
)
def test_a_true_estimate_is_said_as_the_report_does(more, value, said):
    assert effects._said(Test("of a measure", 0, **more), value) == said


@pytest.mark.parametrize(
    ("powers", "least"),
    [
        ({5: 0.85, 10: 0.79, 20: 0.8, 40: 0.9}, 20),  # 5 was luck: with 10 it fell again
        ({40: 0.9, 5: 0.3, 20: 0.8}, 20),  # whatever the order that they stand in
        ({5: 0.9, 10: 0.79}, None),
        ({5: 0.8}, 5),
    ],
)
def test_people_are_enough_from_where_power_stays_at_80_percent(powers, least):
    points = [Point("P1", n, power, 0, 1, 0) for n, power in powers.items()]
    assert enough([*points, Point("P2", 5, 0.1, 0, 1, 0)]) == {"P1": least, "P2": None}


def test_one_test_that_is_significant_the_other_way_is_against():
    """Three studies: one test of two against, both, neither significant."""
    size, there = np.ones(3), np.ones(3, bool)
    first = Results(np.array([0.01, 0.01, 0.5]), size, np.array([-1, -1, -1]), there)
    second = Results(np.array([0.5, 0.01, 0.5]), size, np.array([1, -1, -1]), there)
    for any_ in (False, True):
        planned = Planned("P1", "", (Test("a", 0), Test("b", 1)), any_)
        found = decide(planned, [first, second], 0.05)
        assert found.against.tolist() == [True, True, False]
        assert not found.supported.any()


def test_a_fifth_less_is_a_ratio_of_four_fifths():
    """Differences of logarithms, baseline − level; a spread of 30 % is a factor of 1.3."""
    found = effects._size(Test("time", 0, log=True), 20.0, "%", 30.0)
    assert found == pytest.approx((log(5 / 4), log(1.3)), rel=1e-12)
    assert effects._size(Test("errors", 0, unit="objects"), 2.0, "objects", 3.0) == (2.0, 3.0)
    assert effects._size(Test("errors", 0), 0.4, "sd", None) == (0.4, 1.0)
