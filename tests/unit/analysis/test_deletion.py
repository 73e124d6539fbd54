"""Who lacks something is left out of what needs it; what is too fast; who prefers neither."""

from __future__ import annotations

import csv

import numpy as np
import pandas as pd
import pytest
from made_data import ANSWER_COLUMNS, TRIAL_COLUMNS, Made, make_folder, write_rows

from seethrough.analysis.exclude import apply_rules
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.sections.asked_once import preferences
from seethrough.analysis.validity import learning_slopes


def edit(folder, change, kind="trials", columns=TRIAL_COLUMNS):
    """Rewrite each participant's rows with those that `change` returns."""
    for path in sorted(folder.rglob(f"*_{kind}_data.csv")):
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        write_rows(path, columns, [r for r in map(change, rows) if r is not None])
    return folder


def tables(report):
    return {b.key: b for s in report.sections for b in walk(s.blocks) if isinstance(b, Table)}


@pytest.fixture
def lacking(tmp_path):
    """P03 never met T3 with the technique."""
    folder = make_folder(tmp_path / "d", Made(participants=8))
    gone = ("P03", "unique", "dynamic")
    return edit(folder, lambda r: None if (r["participant"], r["task"], r["transparency"]) == gone
                else r)  # fmt: skip


def test_a_missing_task_costs_that_task_and_the_mean_over_tasks(lacking):
    found = tables(make_report(lacking, Options()))
    for table in ("tests_time", "tests_log_time"):
        sizes = {r["measure"]: r["n"] for r in found[table].rows}
        assert sizes == {"time_overall": 7, "time_count": 8, "time_pattern": 8, "time_unique": 7,
                         "time_count_in_building": 8}  # fmt: skip
    assert {r["measure"]: r["n"] for r in found["tests_distance"].rows}["distance_unique"] == 7
    assert [r["n"] for r in found["anova_time_task_log"].rows] == [7, 7, 7]
    assert {r["label"]: r["n"] for r in found["friedman_correct"].rows}["T3 unique"] == 7
    assert {r["task"]: r["n"] for r in found["tradeoff"].rows}["count"] == 8
    cells = {r["cell"]: r["n"] for r in found["time_cells"].rows}
    assert (cells["unique/standard"], cells["unique/dynamic"]) == (8, 7)


def test_the_other_tasks_have_the_values_of_everybody(lacking, tmp_path):
    whole = tables(make_report(make_folder(tmp_path / "w", Made(participants=8)), Options()))
    part = tables(make_report(lacking, Options()))
    for key in ("time_count", "time_pattern", "time_count_in_building"):
        before, after = whole["tests_log_time"].row(key), part["tests_log_time"].row(key)
        assert (before["F"], before["ratio"]) == (after["F"], after["ratio"])


def test_the_report_says_how_many(lacking):
    text = as_markdown(make_report(lacking, Options()))
    assert "In T3 unique (n = 7 of 8)" in text
    assert "Over all tasks (n = 7 of 8)" in text
    assert "1 participant lacks a cell: P03 (unique × dynamic)" in text
    assert "In T1 count, " in text


def test_mean_and_standardised_difference_are_of_the_same_people(lacking):
    found = tables(make_report(lacking, Options()))
    row = found["difficulty"].row("targets_unique")
    assert row["n"] == 7
    trials = load_study(lacking).trials
    own = trials[(trials["task"] == "unique") & (trials["participant"] != "P03")]
    assert (own.groupby("participant", observed=True).size() == 6).all()


def test_logarithms_are_of_trials(tmp_path):
    """One trial of 10⁶ s of three moves the participant's log time by a third of its logarithm."""
    folder = make_folder(tmp_path / "d", Made(participants=6))
    before = tables(make_report(folder, Options()))["tests_log_time"].row("time_count")
    slow = ("P02", "count", "dynamic", "2")
    moved = {}

    def change(row):
        if tuple(row[k] for k in ("participant", "task", "transparency", "trial_in_set")) == slow:
            moved["by"] = np.log(1e6 / float(row["time"]))
            return {**row, "time": "1000000.0", "time_clean": "1000000.0"}
        return row

    found = tables(make_report(edit(folder, change), Options()))
    after = found["tests_log_time"].row("time_count")
    assert np.log(after["ratio"] / before["ratio"]) == pytest.approx(moved["by"] / 3 / 6, rel=1e-9)
    assert found["time_cells"].row("count/dynamic")["geometric"] == pytest.approx(
        after["geometric_level"], rel=1e-12
    )
    assert found["time_cells"].row("count/dynamic")["mean"] > 50_000


def test_answers_faster_than_anybody_are_left_out_by_rule(tmp_path):
    folder = make_folder(tmp_path / "d", Made(participants=3, trials=2))
    stray = {"P01": "0.0021", "P02": "0.2", "P03": "0.1999"}

    def change(row):
        if row["trial"] == "3":
            return {**row, "time": stray[row["participant"]], "time_clean": "0.002"}
        return row

    trials = load_study(edit(folder, change)).trials
    kept, gone = apply_rules(trials, ("too_fast",))
    assert [(e.participant, e.rule) for e in gone] == [("P01", "too_fast"), ("P03", "too_fast")]
    assert len(kept) == len(trials) - 2
    assert len(apply_rules(trials, ("too_fast",), 0.001)[1]) == 0
    text = as_markdown(make_report(folder, Options(exclude=("too_fast",))))
    assert "the answer came sooner than anybody can look and answer (within 0.2 s)" in text


def asked(*answers):
    rows = [{"item": "preference", "value": v, "text": t} for v, t in answers]
    return pd.DataFrame([*rows, {"item": "depth_test", "value": 1.0, "text": ""}])


def test_who_prefers_neither_is_a_tie():
    known = asked((1.0, "dynamic"), (1.0, "dynamic"), (0.0, "standard"), (0.0, "neutral"))
    assert preferences(known, "preference") == (2, 1, 1)
    assert preferences(asked((1.0, ""), (0.5, ""), (0.0, ""), (np.nan, "")), "preference") == (
        1,
        1,
        1,
    )


def test_a_tie_is_in_neither_share_nor_test(tmp_path):
    """15 for it and one neutral is 15 of 15: p = 2 / 2¹⁵, not the 34 / 2¹⁶ of 15 of 16."""
    folder = make_folder(tmp_path / "d", Made(participants=16, trials=1))

    def change(row):
        if row["item"] != "preference":
            return row
        neutral = row["participant"] == "P16"
        return {**row, "value": "0" if neutral else "1", "text": "neutral" if neutral else ""}

    edit(folder, change, "questionnaire", ANSWER_COLUMNS)
    row = tables(make_report(folder, Options()))["single_items"].row("preference")
    assert (row["n"], row["neutral"], row["mean"], row["p"]) == (16, 1, 1.0, 2 / 2**15)


def test_a_participants_learning_is_the_mean_of_their_sets():
    """Slopes of −.1, −.1 and .5 a trial: the mean is .1, the median −.1."""
    rows = [
        {"participant": "a", "session": 1, "task_set": s, "trial_in_set": k,
         "time": float(np.exp(2 + slope * k))}
        for s, slope in enumerate((-0.1, -0.1, 0.5))
        for k in (1, 2, 3)
    ]  # fmt: skip
    assert learning_slopes(pd.DataFrame(rows)) == pytest.approx([0.1], rel=1e-9)
