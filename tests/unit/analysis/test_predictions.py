"""Predictions of any design: answered by name, by every expectation, over one and many tests."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import pytest
from made_designs import DESIGNS, OFF, TIME, Design, factor, make_design

from seethrough.analysis.design import Design as Varied
from seethrough.analysis.design import Factor, Measured, Prediction, Task
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.sections.summary import _words

VIEW = factor("view", "plain", "cut", "lens")


def fast(cell):
    """A cut halves times, a lens does nothing."""
    return {"cut": -0.7}.get(cell.get("view", ""), 0.0)


BASE = Design((VIEW,), (12,), 3, measures=(TIME, OFF), effect=fast, asked=False, seed=12)


def answered(tmp_path, design, *predictions):
    folder = make_design(tmp_path / "d", replace(design, predictions=predictions))
    report = make_report(folder, Options())
    tables = {b.key: b for s in report.sections for b in walk(s.blocks) if isinstance(b, Table)}
    return tables, as_markdown(report).split("\n## ")[1]


@pytest.mark.parametrize(
    ("prediction", "verdict"),
    [
        ({"level": "cut", "expect": "less"}, "supported"),
        ({"level": "cut", "expect": "more"}, "contradicted: it is faster"),
        ({"level": "cut", "expect": "different"}, "supported"),
        ({"level": "lens", "expect": "less"}, "not shown"),
        ({"level": "cut", "expect": "equivalent", "ratio": 1.2}, "not shown"),
        ({"level": "lens", "expect": "equivalent", "ratio": 2.5}, "supported"),
        ({"expect": "less"}, "not shown"),
        ({"expect": "less", "combine": "any"}, "supported"),
        ({"level": "lens", "expect": "not worse", "ratio": 2.5}, "supported"),
        ({"level": "lens", "expect": "not worse"},
         "not answered, for want of a margin declared before the data"),
    ],
)  # fmt: skip
def test_a_prediction_of_times(tmp_path, prediction, verdict):
    tables, first = answered(
        tmp_path, BASE, {"name": "H1", "measure": "time", "contrast": "view", **prediction}
    )
    row = tables["predictions"].row("H1")
    assert row["verdict"] == verdict
    assert f": {verdict}" in first.replace("\\", "") and "> H1, " in first
    assert not re.search(r"\bp (= [<>\\]|[.\d])", first)  # "p = .03" and "p < .001" alone


def test_all_is_decided_by_the_largest_p_and_any_by_holm(tmp_path):
    asked = {"measure": "time", "contrast": "view", "expect": "different"}
    tables, _ = answered(
        tmp_path, BASE, {"name": "A", **asked}, {"name": "B", "combine": "any", **asked}
    )
    p = [r["p"] for r in tables["tests_log_time"].rows]
    rows = tables["predictions"]
    assert rows.row("A")["tests"] == rows.row("B")["tests"] == 2
    assert rows.row("A")["p"] == max(p)
    assert rows.row("B")["p"] == pytest.approx(min(1.0, 2 * min(p)))


def test_the_margin_of_a_prediction_is_the_measures(tmp_path):
    tables, _ = answered(
        tmp_path, BASE, {"name": "H", "measure": "off", "contrast": "view", "level": "lens",
                         "expect": "not worse", "margin": 9.0},
    )  # fmt: skip
    assert tables["tests_off"].row("off_find/view=lens")["tost_margin"] == 9.0
    assert tables["predictions"].row("H")["verdict"] == "supported"


def test_what_was_asked_once_is_held_to_its_value(tmp_path):
    design = replace(BASE, asked=True)
    low = {"name": "H", "measure": "age", "expect": "at least", "value": 15}
    high = {"name": "I", "measure": "age", "expect": "at least", "value": 60}
    none = {"name": "J", "measure": "fun", "expect": "at least", "value": 3}
    tables, _ = answered(tmp_path, design, low, high, none)
    verdicts = [r["verdict"] for r in tables["predictions"].rows]
    assert verdicts == ["supported", "not shown", "not asked"]


def test_groups_are_judged_by_welch(tmp_path):
    tables, _ = answered(
        tmp_path, DESIGNS["mixed"], {"name": "H1", "measure": "time", "contrast": "training",
                                     "expect": "less", "reason": "fourteen came"},
    )  # fmt: skip
    row = tables["contrasts_log_time"].row("find/training=criterion")
    assert tables["predictions"].row("H1")["p"] == row["p"]
    assert "H1: fourteen came" in tables["predictions"].note


TRANSPARENCY = Factor("transparency", "within", ("standard", "dynamic", "half"), "standard")
COUNT = Task("count", "T1", (Measured("time", "time"), Measured("off", "error", label="error")))


@pytest.mark.parametrize(
    ("expect", "more", "said"),
    [
        ("less", {}, "time less with dynamic or half than standard (transparency)"),
        ("more", {"level": "half"}, "time more with half than standard (transparency)"),
        ("not worse", {"level": "half"}, "time not worse with half than standard (transparency)"),
        ("different", {"level": "half"}, "time different with half and standard (transparency)"),
        ("at least", {"contrast": "", "value": 0.9}, "time at least 0.9"),
        ("less", {"measures": ("error", "gone_by"), "level": "half"},
         "error, gone by less with half than standard (transparency)"),
    ],
)  # fmt: skip
def test_a_prediction_without_a_text_says_what_it_expects_of_which_levels(expect, more, said):
    values = {"measures": ("time",), "contrast": "transparency", **more}
    prediction = Prediction("P1", "", expect=expect, **values)
    assert _words(SimpleNamespace(design=Varied((TRANSPARENCY,), (COUNT,))), prediction) == said
