"""Missed frames, lost focus and time-outs: of people, and of simulated participants."""

from __future__ import annotations

import csv

import pytest
from made_data import TRIAL_COLUMNS, Made, make_folder, write_rows

from seethrough.analysis.exclude import apply_rules
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Prose, Table
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.sections.validity import NO_DISPLAY


def folder_of(tmp_path, source):
    """A folder whose frames were missed nearly all, with dynamic transparency most."""
    folder = make_folder(tmp_path / source, Made(participants=6, trials=2, source=source))
    for table in folder.rglob("*_trials_data.csv"):
        with open(table, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        for number, row in enumerate(rows):
            share = 0.98 if row["transparency"] == "dynamic" else 0.9 - 0.01 * (number % 2)
            row["frames_missed"] = int(share * int(row["frames"]))
        write_rows(table, TRIAL_COLUMNS, rows)
    return folder


def fair(report):
    """The blocks of the section on fairness, its sentences as text."""
    section = next(s for s in report.sections if s.key == "validity")
    said = " ".join(
        "".join(run if isinstance(run, str) else run.text for run in block.runs)
        for block in section.blocks
        if isinstance(block, Prose)
    )
    return said, next(b for b in section.blocks if isinstance(b, Table) and b.key == "faults")


def test_frames_that_people_missed_could_explain_a_difference(tmp_path):
    said, table = fair(make_report(folder_of(tmp_path, "human"), Options()))
    assert "Share of frames missed: M = " in said
    assert "This could explain part of a difference in time." in said
    assert table.title.startswith("Missed frames, lost focus")
    assert NO_DISPLAY not in said


def test_a_simulated_participants_frames_explain_nothing(tmp_path):
    said, table = fair(make_report(folder_of(tmp_path, "simulated"), Options()))
    assert NO_DISPLAY in said
    assert "frames missed" not in said and "could explain" not in said
    assert table.title.startswith("Lost focus")
    assert "frames_missed" not in [row["measure"] for row in table.rows]


@pytest.mark.parametrize(("source", "left"), [("human", 0), ("pilot", 0), ("simulated", 96)])
def test_the_rule_against_missed_frames_is_for_people(tmp_path, source, left):
    trials, excluded = apply_rules(
        load_study(folder_of(tmp_path, source)).trials, ("frames_missed",)
    )
    assert len(trials) == left == 96 - len(excluded)
