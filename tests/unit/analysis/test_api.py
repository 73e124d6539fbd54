"""Data and results in a notebook: `seethrough.api`."""

from __future__ import annotations

import numpy as np
import pytest
from made_data import Made, make_folder
from made_designs import DESIGNS, make_design

from seethrough import api
from seethrough.analysis.errors import DataError
from seethrough.analysis.report import Options, make_report, tables_of


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return make_design(tmp_path_factory.mktemp("api") / "d", DESIGNS["mixed"])


def test_factors_are_categories_in_the_studys_order(folder):
    study = api.load(folder)
    assert study.factors == ["training", "clutter"]
    assert list(study.trials["clutter"].cat.categories) == ["80", "180", "380"]
    assert study.trials["clutter"].cat.ordered
    # groupby keeps that order, where texts would put 180 before 80
    order = list(study.trials.groupby("clutter", observed=True)["time"].mean().index)
    assert order == ["80", "180", "380"]
    assert len(study.trials) == len(study.counted) == 14 * 3 * 2
    assert list(study.answers["clutter"].cat.categories) == ["80", "180", "380"]
    assert study.design.factor("training").kind == "between"
    assert not [name for name in study.trials if name.startswith("_")]


def test_the_tables_are_the_reports(folder):
    found = api.results(folder)
    theirs = tables_of(make_report(folder, Options()))
    assert set(found) == {t.key for t in theirs}
    table = next(t for t in theirs if t.key == "anova_time_log")
    frame = found["anova_time_log"]
    assert list(frame.index) == [r["effect"] for r in table.rows]
    assert frame.loc["training", "F"] == table.row("training")["F"]
    assert frame.attrs["title"] == table.title
    why = frame.attrs["undefined"]["training", "bf10"]
    assert why == "only without groups" and np.isnan(frame.loc["training", "bf10"])


def test_what_does_not_count_says_why(tmp_path):
    config = {"analysis": {"exclude": ["too_fast"], "too_fast": 20.0}}
    study = api.load(make_folder(tmp_path / "d", Made(participants=3, config=config)))
    fast = study.trials["time"] < 20
    assert fast.any() and (study.trials.loc[fast, "left_out"] == "too_fast").all()
    assert (study.counted["time"] >= 20).all()


def test_what_a_report_refuses_is_refused(tmp_path):
    with pytest.raises(DataError, match="no such folder"):
        api.load(tmp_path / "none")
    with pytest.raises(DataError, match="no such folder"):
        api.results(tmp_path / "none")


def test_undefined_keeps_its_reason(tmp_path):
    found = api.results(make_folder(tmp_path / "d", Made(participants=1, trials=1)))
    frame = found["tests_time"]
    assert np.isnan(frame.loc["time_overall", "p"])
    assert frame.attrs["undefined"]["time_overall", "p"] == "fewer than two participants"
