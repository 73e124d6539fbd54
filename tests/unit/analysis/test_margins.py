"""Equivalence and no-worse against declared margins: closed forms, codings, and their level."""

from __future__ import annotations

import numpy as np
import pytest
from made_data import Made, make_folder
from scipy import stats

from seethrough.analysis.comparison import Pair, compare, compare_logs
from seethrough.analysis.design import Measured
from seethrough.analysis.equivalence import Margin, equivalence, log_equivalence, margin_of
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.plan import make_plan
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.stats.paired import ratio_of_means, ratio_within
from seethrough.analysis.stats.undefined import Undefined
from seethrough.experiment.study.config import parse, shipped

RNG = np.random.default_rng(8)
FIRST = RNG.gamma(9, 3, 14)
SECOND = 1.1 * FIRST + RNG.normal(0, 3, 14)
DECLARED = {"time": 1.2, "count_error": 0.05, "correct": 0.10, "distance": 3.0}
TIME, SHARE, DISTANCE = Margin(1.2, ratio=True), Margin(0.10, more=True), Margin(3.0)


def test_absolute_margins_are_two_t_tests():
    row = equivalence(FIRST, SECOND, DISTANCE)
    gaps = FIRST - SECOND
    low = stats.ttest_1samp(gaps, -3.0, alternative="greater").pvalue
    high = stats.ttest_1samp(gaps, 3.0, alternative="less").pvalue
    assert row["tost_p"] == pytest.approx(max(low, high), rel=1e-10)
    # a distance is worse when it is larger: second − first < 3
    assert row["noninferior_p"] == pytest.approx(low, rel=1e-10)
    ends = stats.ttest_1samp(gaps, 0).confidence_interval(0.90)
    assert (row["low90"], row["high90"]) == pytest.approx(tuple(ends), rel=1e-10)


def test_a_ratio_of_means_is_tested_without_taking_the_mean_as_known():
    row = equivalence(FIRST, SECOND, TIME)
    upper = stats.ttest_1samp(SECOND - 1.2 * FIRST, 0, alternative="less").pvalue
    lower = stats.ttest_1samp(SECOND - FIRST / 1.2, 0, alternative="greater").pvalue
    assert row["tost_p"] == pytest.approx(max(lower, upper), rel=1e-10)
    assert row["noninferior_p"] == pytest.approx(upper, rel=1e-10)
    assert row["tost_margin"] == 1.2


def test_the_ratio_tests_are_fiellers_interval():
    """At an end of the 90 % interval as the margin, the one-sided p is .05."""
    low, high = ratio_of_means(FIRST, SECOND, level=0.90)[1]
    assert ratio_within(FIRST, SECOND, high).p_low == pytest.approx(0.05, rel=1e-9)
    assert ratio_within(SECOND, FIRST, 1 / low).p_low == pytest.approx(0.05, rel=1e-9)
    row = equivalence(FIRST, SECOND, TIME)
    assert (row["low90"], row["high90"]) == (low, high)


def test_logarithms_are_tested_against_the_margins_logarithm():
    a, b = np.log(FIRST), np.log(np.abs(SECOND))
    row = log_equivalence(a, b, TIME)
    upper = stats.ttest_1samp(b - a, np.log(1.2), alternative="less")
    lower = stats.ttest_1samp(b - a, -np.log(1.2), alternative="greater")
    assert row["tost_p"] == pytest.approx(max(lower.pvalue, upper.pvalue), rel=1e-10)
    assert row["noninferior_p"] == pytest.approx(upper.pvalue, rel=1e-10)
    ends = np.exp(stats.ttest_1samp(b - a, 0).confidence_interval(0.90))
    assert (row["low90"], row["high90"]) == pytest.approx(tuple(ends), rel=1e-10)


def test_shares_right_and_shares_wrong_pass_and_fail_together():
    """.938 → .854 right, 6 % → 15 % wrong: the same answers, the same p, whatever the coding."""
    right = np.repeat([1.0, 2 / 3], [13, 3]), np.repeat([1.0, 2 / 3], [9, 7])
    coded_right = equivalence(*right, SHARE)
    coded_wrong = equivalence(*(1 - r for r in right), Margin(0.10))
    assert coded_right["noninferior_p"] == pytest.approx(coded_wrong["noninferior_p"], rel=1e-9)
    assert coded_right["tost_p"] == pytest.approx(coded_wrong["tost_p"], rel=1e-9)
    assert coded_right["noninferior_p"] > 0.05


def test_more_right_answers_are_never_worse():
    rng = np.random.default_rng(1)
    low, high = rng.uniform(0.5, 0.6, 16), rng.uniform(0.8, 0.9, 16)
    assert equivalence(low, high, SHARE)["noninferior_p"] < 1e-6
    assert equivalence(high, low, SHARE)["noninferior_p"] > 0.999
    assert equivalence(high, low, Margin(0.05))["noninferior_p"] < 1e-6


def test_without_a_declared_margin_nothing_is_equivalent():
    row = compare([Pair("m", "m", "", 2, FIRST, SECOND)]).row("m")
    gone = Undefined("no margin was declared before the data")
    names = ("tost_margin", "tost_p", "noninferior_p", "low90", "high90")
    assert [row[name] for name in names] == [gone] * 5
    logs = (np.log(FIRST), np.log(FIRST) + 0.1)
    timed = Pair("t", "t", "s", 2, FIRST, SECOND, logs=logs)
    assert compare_logs([timed]).row("t")["tost_p"] == gone


def test_z_scores_have_no_ratio():
    z = Pair("bis", "bis", "", 2, FIRST - FIRST.mean(), FIRST.mean() - SECOND, ratio_scale=False)
    row = compare([z]).row("bis")
    assert str(row["ratio"]) == "undefined: differences of z scores have no ratio"
    assert str(row["ratio_low"]) == str(row["ratio"])


def test_the_test_of_a_ratio_keeps_its_level_where_a_share_of_the_observed_mean_does_not():
    """At the margin itself, 16 people, s.d. .35 of the mean, r = .2: 20,000 studies."""
    rng = np.random.default_rng(4)
    runs, n = 20_000, 16
    first = 1 + 0.35 * rng.standard_normal((runs, n))
    noise = 0.2 * (first - 1) + 0.35 * np.sqrt(1 - 0.04) * rng.standard_normal((runs, n))
    second = 1.2 + noise

    def rejected(scores):
        t = scores.mean(axis=1) / (scores.std(axis=1, ddof=1) / np.sqrt(n))
        return float(np.mean(t < stats.t.ppf(0.05, n - 1)))

    ours = rejected(second - 1.2 * first)
    estimated = rejected(second - first - 0.2 * first.mean(axis=1, keepdims=True))
    error = np.sqrt(0.05 * 0.95 / runs)
    assert ours == pytest.approx(0.05, abs=3 * error)
    assert estimated > 0.05 + 5 * error


def test_the_published_study_declares_its_margins_and_its_limit(tmp_path):
    import tomllib

    study = parse(tomllib.loads(shipped()["published"].read_text("utf-8")), "published.toml")
    config = study.resolved()
    assert config["analysis"]["margins"] == DECLARED
    folder = make_folder(tmp_path / "d", Made(participants=5, trials=2, config=config))
    plan = make_plan(load_study(folder))
    assert (
        plan.margins == {**DECLARED, "absolute_error": 0.05}
        and plan.exclude == ("too_fast",)
        and plan.too_fast == 0.2
    )
    text = as_markdown(make_report(folder, Options()))
    assert "Margins, declared before the data: relative error 0.05" in text


def test_data_without_margins_say_so(tmp_path):
    folder = make_folder(tmp_path / "d", Made(participants=5, trials=2))
    report = make_report(folder, Options())
    text = as_markdown(report)
    assert "The study declared no margin of accuracy." in text
    assert "TOST p" not in text
    tables = {b.key: b for s in report.sections for b in walk(s.blocks) if isinstance(b, Table)}
    assert str(tables["tests_time"].row("time_overall")["tost_p"]).startswith(
        "undefined: no margin"
    )


@pytest.mark.parametrize(
    ("analysis", "line"),
    [
        ({"margins": {"time": 0.9}}, "analysis.margins.time = 0.9: expected a number above 1"),
        ({"margins": {"distance": "3"}}, "analysis.margins.distance = '3': expected a number"),
        ({"margins": {"speed": 1}}, "analysis.margins.speed: expected among time, count_error"),
        ({"margins": 0.2}, "analysis.margins = 0.2: expected a table"),
        ({"too_fast": -1}, "analysis.too_fast = -1: expected a number above 0"),
        ({"too_fast": True}, "analysis.too_fast = True: expected a number above 0"),
    ],
)
def test_a_plan_that_makes_no_sense_is_one_line(tmp_path, analysis, line):
    config = {"analysis": analysis}
    folder = make_folder(tmp_path / "d", Made(participants=2, trials=1, config=config))
    with pytest.raises(DataError, match=line.replace("'", ".").replace("(", ".")):
        make_report(folder, Options())


@pytest.mark.parametrize(
    ("more", "margin"),
    [
        ({}, None),
        ({"margin": 2.0}, Margin(2.0)),
        ({"margin": 1.2, "ratio": True}, Margin(1.2, ratio=True)),
        ({"margin": 1.2, "log": True}, Margin(1.2, ratio=True)),
        ({"margin": 2.0, "direction": "more"}, Margin(2.0, more=True)),
    ],
)
def test_a_margin_is_a_ratio_where_the_study_says_so_or_logarithms_are_compared(more, margin):
    assert margin_of(Measured("time", "time", **more)) == margin
