"""The paragraph of methods and the flow of trials, against the files' own rows."""

from __future__ import annotations

import csv
from dataclasses import replace

import pytest
from made_data import Made, make_folder
from made_designs import DESIGNS, make_design

from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report


def rows_of(folder):
    found = []
    for path in sorted(folder.glob("data/*/*/*_trials_data.csv")):
        with open(path, newline="") as file:
            found += list(csv.DictReader(file))
    return found


def flow(report):
    return next(b for s in report.sections for b in walk(s.blocks)
                if isinstance(b, Table) and b.key == "flow")  # fmt: skip


def test_the_flow_counts_rows_people_and_values(tmp_path):
    config = {"analysis": {"exclude": ["too_fast"], "too_fast": 12.0}}
    folder = make_folder(tmp_path / "d", Made(participants=4, config=config))
    table, rows = flow(make_report(folder, Options())), rows_of(folder)
    for name, column, tasks in (
        ("time", "time", None),
        ("distance", "distance", {"unique"}),
        ("count_error", "count_error", {"count", "count_in_building"}),
    ):
        own = [r for r in rows if tasks is None or r["task"] in tasks]
        counted = [r for r in own if float(r["time"]) >= 12]
        row = table.row(name)
        assert row["recorded"] == len(own)
        assert row["counted"] == len(counted)
        assert row["used"] == sum(r[column] != "" for r in counted)
        assert row["people"] == len({r["participant"] for r in counted})
        cells = {(r["task"], r["transparency"]) for r in counted}
        by = {p: {(r["task"], r["transparency"]) for r in counted if r["participant"] == p}
              for p in {r["participant"] for r in rows}}  # fmt: skip
        assert row["complete"] == sum(own == cells for own in by.values())
    assert table.row("time")["counted"] < table.row("time")["recorded"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("mixed", "Participants: 14 participants (training, assigned: none 9, criterion 5)"),
        ("mixed", "training (none, criterion; between participants)"),
        ("between", "training, brought along: none 4, short 7, long 9"),
        ("left_out", "Left out for everybody: plain × 380."),
        ("four", "2 predictions"),
        ("left_out", "16 trials a participant"),
    ],
)
def test_the_paragraph_says_what_the_design_says(tmp_path, name, words):
    text = as_markdown(make_report(make_design(tmp_path / "d", DESIGNS[name]), Options()))
    assert words in text.replace("\\", "")


def test_what_was_brought_along_causes_nothing(tmp_path):
    text = as_markdown(make_report(make_design(tmp_path / "d", DESIGNS["between"]), Options()))
    assert "Training was brought along, not assigned" in text


def test_simulated_people_are_none(tmp_path):
    text = as_markdown(make_report(make_folder(tmp_path / "d", Made(2, source="simulated")),
                                   Options()))  # fmt: skip
    assert "Participants: 2 simulated participants, who are no people." in text


def test_selected_scenes_are_said_first_and_only_where_a_rule_was_declared(tmp_path):
    plain = DESIGNS["four"]
    rule = "only scenes of {kind} A; 3 scenes were drawn again"
    chosen = replace(plain, more={"selected": rule})
    texts = [as_markdown(make_report(make_design(tmp_path / str(k), d), Options()))
             for k, d in enumerate((plain, chosen))]  # fmt: skip
    assert "Scenes selected" not in texts[0]
    first, method = texts[1].replace("\\", "").split("## Method")[:2]
    assert f"Scenes selected, by a rule that the study declared: {rule}." in first
    assert f"Scenes selected: {rule}." in method
