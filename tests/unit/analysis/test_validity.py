"""Order effects, learning and the mixed model against other programs and planted effects."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf
from made_data import Made, make_folder
from scipy import stats

from seethrough.analysis.before import design_before
from seethrough.analysis.load.study import load_study
from seethrough.analysis.measures import cells_of, over_tasks
from seethrough.analysis.mixed import mixed_model
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.undefined import Undefined
from seethrough.analysis.stats.within import dummies, one_way, term_tests
from seethrough.analysis.validity import condition_means, learning_slopes, order_tests

DESIGN = design_before({})
TIME = DESIGN.measures()[0]


@pytest.fixture(scope="module")
def trials(tmp_path_factory) -> pd.DataFrame:
    folder = make_folder(tmp_path_factory.mktemp("v") / "data", Made())
    return load_study(folder).trials


def test_order_effects_agree_with_a_model_of_all_dummies(trials):
    """statsmodels' OLS with a dummy per participant, F for the terms left out (type III)."""
    rows = condition_means(trials, DESIGN)
    rows = rows.assign(carry=(rows["before"] == "dynamic").astype(float))
    full = smf.ols("y ~ C(participant) + C(block) + C(condition) + carry", rows).fit()
    tests = {t.name: t for t in order_tests(trials, DESIGN)}
    for name, formula in {
        "period": "y ~ C(participant) + C(condition) + carry",
        "carry-over": "y ~ C(participant) + C(block) + C(condition)",
    }.items():
        f, p, df1 = full.compare_f_test(smf.ols(formula, rows).fit())
        assert (tests[name].f, tests[name].p) == pytest.approx((f, p), rel=1e-8)
        assert tests[name].df1 == df1 and tests[name].df2 == full.df_resid


def test_sequence_agrees_with_scipy():
    rng = np.random.default_rng(2)
    group = np.repeat(["a", "b", "c"], [5, 6, 4])
    y = rng.normal(size=15)
    expected = stats.f_oneway(*(y[group == g] for g in "abc"))
    ours = one_way(y, group)
    assert (ours.f, ours.p) == pytest.approx((expected.statistic, expected.pvalue), rel=1e-10)


def test_a_planted_carry_over_is_found(trials):
    table = trials.copy()
    rows = condition_means(trials, DESIGN)
    after = rows[rows["before"] == "dynamic"][["participant", "block"]]
    marked = table.merge(after.assign(after=1.0), on=["participant", "block"], how="left")
    slower = np.where(marked["after"].notna(), 1.6, 1.0)
    planted = {t.name: t for t in order_tests(table.assign(time=table["time"] * slower), DESIGN)}
    assert planted["carry-over"].p < 0.001
    assert {t.name: t for t in order_tests(table, DESIGN)}["carry-over"].p > 0.05


def test_a_planted_learning_slope_comes_back(trials):
    before = learning_slopes(trials)
    faster = trials["time"] * np.exp(-0.1 * trials["trial_in_set"])
    after = learning_slopes(trials.assign(time=faster))
    np.testing.assert_allclose(after, before - 0.1, atol=1e-12)


def test_terms_that_the_design_cannot_separate_say_so():
    group = np.repeat(np.arange(6), 2)
    block = np.tile([1, 2], 6)
    terms = {"period": dummies(block), "condition": dummies(block)}
    tests = term_tests(np.random.default_rng(0).normal(size=12), group, terms)
    assert tests[0].f == Undefined("the design does not separate it from the other effects")


def test_no_residual_says_so():
    group = np.repeat(np.arange(4), 2)
    y = np.tile([1.0, 2.0], 4)
    (test,) = term_tests(y, group, {"c": dummies(np.tile([0, 1], 4))})
    assert test.f == Undefined("nothing is left to compare with")


def test_the_mixed_model_with_its_slope_is_the_anova_on_log_means():
    """With random slopes on balanced data, t² is F of the means (lmer: 175.44 = 175.439)."""
    rng = np.random.default_rng(4)
    n, per = 16, 6
    slopes, levels = rng.normal(-0.6, 0.25, n), rng.normal(3, 0.3, n)
    rows = [
        {
            "participant": f"p{i:02d}",
            "transparency": level,
            "task": "count",
            "scenario": "abstract",
            "time": float(
                np.exp(levels[i] + slopes[i] * (level == "dynamic") + rng.normal(0, 0.2))
            ),
        }
        for i in range(n)
        for level in ("standard", "dynamic")
        for _ in range(per)
    ]
    table = pd.DataFrame(rows)
    logs = table.assign(time=np.log(table["time"]))
    cells = over_tasks(cells_of(logs, DESIGN, TIME))
    f = repeated_measures(cells.values, ["transparency"])["transparency"].f
    (fit,) = mixed_model(table, DESIGN)
    assert fit.p == pytest.approx(2 * stats.t.sf(abs(fit.t), n - 1), rel=1e-9)
    assert fit.t**2 == pytest.approx(f, rel=1e-6)
    assert fit.ratio == pytest.approx(
        np.exp(-np.diff(cells.values.mean(axis=0)[::-1])[0]), rel=1e-6
    )


def test_the_mixed_model_says_when_it_is_not_fitted(trials):
    two = trials[trials["participant"].isin(["P01", "P02"])]
    assert mixed_model(two, DESIGN)[0].p == Undefined(
        "fewer than three participants with every level"
    )
    one = trials[trials["transparency"] == "standard"]
    assert mixed_model(one, DESIGN)[0].p == Undefined("not every level of transparency was met")
