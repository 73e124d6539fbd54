"""The mixed model of trials against lme4: where it fits, on the boundary, and where nothing can.

References: lme4 1.1-31 in R 4.2.2, bobyqa with rhoend 1e-10, on tests/data/statistics/
mixed_trials.csv (`tied`: times rounded to powers of two, so that most are tied).
"""

from __future__ import annotations

import numpy as np
import oracles
import pandas as pd
import pytest

from seethrough.analysis.before import design_before
from seethrough.analysis.mixed import LEVELS, SLOPES, TASK_LEVELS, TASK_SLOPES, mixed_model
from seethrough.analysis.stats import reml
from seethrough.analysis.stats.undefined import Undefined

DESIGN = design_before({})
FULL = f"{SLOPES} + {TASK_SLOPES}"
SCENARIO = {"count": "abstract", "pattern": "abstract", "unique": "walkthrough"}


def made(name: str) -> pd.DataFrame:
    table = pd.DataFrame([r for r in oracles.rows("mixed_trials") if r["set"] == name])
    return table.assign(time=table["time"].astype(float), scenario=table["task"].map(SCENARIO))


def first(table: pd.DataFrame) -> pd.DataFrame:
    return table.drop_duplicates(["participant", "task", "transparency"])


def lacking(table: pd.DataFrame) -> pd.DataFrame:
    return table[~((table["participant"] == "p0") & (table["task"] == "unique"))]


def people(*names: int):
    return lambda table: table[table["participant"].isin([f"p{i}" for i in names])]


def count_only(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["task"] == "count"]


def whole(table: pd.DataFrame) -> pd.DataFrame:
    return table


@pytest.mark.parametrize(
    ("name", "part", "model", "estimate", "error", "singular", "slope", "task_slope"),
    [
        ("plain", whole, FULL, -0.468131274087, 0.130826165791, False, 0.2987138579, 0.2521196783),
        ("tied", whole, FULL, -0.442844032024, 0.125837348989, False, 0.272099389, 0.266792481),
        ("plain", first, f"{SLOPES} + {TASK_LEVELS}", -0.494777891431, 0.126685719589, False,
         0.212010079, None),
        ("tied", first, f"{SLOPES} + {TASK_LEVELS}", -0.375454722803, 0.163011274939, False,
         0.2619850469, None),
        ("plain", count_only, SLOPES, -0.492896849848, 0.154754967156, False, 0.3505746072, None),
        ("tied", lambda t: first(count_only(t)), LEVELS, -0.34657359028, 0.292908141174, False,
         None, None),
        ("plain", lacking, FULL, -0.469660310022, 0.132686811409, False, 0.2945337429,
         0.2833268107),
        ("plain", people(4, 5, 6, 7), FULL, -0.589958380573, 0.143850617282, True, 0.2064208685,
         0.2449894202),
        ("tied", people(0, 1, 2, 3), FULL, -0.288811325233, 0.119173107627, True, 0.1086776292,
         0.2856757012),
        ("tied", people(1, 3, 5, 7), FULL, -0.654639003862, 0.192540898564, True, 0.2681820961,
         0.3688725982),
    ],
)  # fmt: skip
def test_it_agrees_with_lme4(name, part, model, estimate, error, singular, slope, task_slope):
    (fit,) = mixed_model(part(made(name)), DESIGN)
    # two optimisers of one smooth function: lme4's own differ by 1e-5 of the s.e.
    assert fit.model == model.replace("{}", "transparency")
    assert fit.estimate == pytest.approx(estimate, abs=1e-5 * error)
    assert fit.error == pytest.approx(error, rel=1e-4)
    assert fit.singular is singular
    for ours, theirs in ((fit.sd_slope, slope), (fit.sd_task_slope, task_slope)):
        if theirs is None:
            assert ours == Undefined("not in the model")
        else:
            assert ours == pytest.approx(theirs, rel=1e-3)


def test_the_restricted_deviance_is_lme4s():
    """REMLcrit of the first model: 176.061177648."""
    table = made("plain")
    technique = np.where(table["transparency"] == "dynamic", 0.5, -0.5)
    task = np.unique(table["task"], return_inverse=True)[1]
    a, b = ((task == i) * 1.0 - (task == 2) for i in (0, 1))
    x = np.column_stack([np.ones(len(table)), technique, a, b, technique * a, technique * b])
    both = x[:, :2]
    person = np.unique(table["participant"], return_inverse=True)[1]
    terms = [reml.Term(both, np.zeros(len(table), int), 1), reml.Term(both, task, 3)]
    y = np.log(table["time"].to_numpy())
    assert reml.fit(y, x, person, terms).deviance == pytest.approx(176.061177648, abs=1e-7)
    # the order of rows is no part of the data
    mixed = np.random.default_rng(1).permutation(len(y))
    shuffled = [reml.Term(t.columns[mixed], t.part[mixed], t.parts) for t in terms]
    again = reml.fit(y[mixed], x[mixed], person[mixed], shuffled)
    assert again.deviance == pytest.approx(176.061177648, abs=1e-7)


def test_the_gradient_is_the_slope_of_the_deviance():
    rng = np.random.default_rng(2)
    person = np.repeat(np.arange(6), 8)
    part = np.tile([0, 0, 1, 1, 0, 0, 1, 1], 6)
    one = np.column_stack([np.ones(48), np.tile([0.5, -0.5], 24)])
    y = rng.normal(size=48) + rng.normal(size=6)[person]
    terms = [reml.Term(one, np.zeros(48, int), 1), reml.Term(one, part, 2)]
    sums = reml._sums(y, one, person, terms)
    theta = np.array([0.8, 0.2, 0.5, 0.4, -0.3, 0.6])
    slope = reml._deviance(sums, terms, 2, theta)[1]
    step = 1e-6 * np.eye(6)
    numeric = [
        (
            reml._deviance(sums, terms, 2, theta + s)[0]
            - reml._deviance(sums, terms, 2, theta - s)[0]
        )
        / 2e-6
        for s in step
    ]
    np.testing.assert_allclose(slope, numeric, atol=1e-6)


def test_it_says_why_where_there_is_no_fit():
    table = made("plain")
    alike = table.assign(time=12.5)
    assert mixed_model(alike, DESIGN)[0].p == Undefined("all times are equal")


def test_where_a_cell_has_no_trials_nothing_is_crossed():
    """The number is held by tests/oracles/designs/tasks_by_group."""
    table = made("plain")
    (whole,) = mixed_model(table, DESIGN)
    only = table[(table["task"] != "unique") | (table["transparency"] == "standard")]
    (fit,) = mixed_model(only, DESIGN)
    assert whole.crossed and not fit.crossed
    assert fit.error > 0 and fit.trials == len(only)


def test_identical_conditions_have_no_effect():
    table = made("plain")
    standard = table[table["transparency"] == "standard"]
    (fit,) = mixed_model(pd.concat([standard, standard.assign(transparency="dynamic")]), DESIGN)
    assert fit.estimate == pytest.approx(0.0, abs=1e-12)
    assert fit.p == pytest.approx(1.0, abs=1e-9)
    assert fit.singular is True
