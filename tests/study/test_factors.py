"""A study of several factors from its file to its exports: groups, mixed trials, pages."""

import csv
import json
from collections import Counter
from pathlib import Path

import pytest

from seethrough.experiment import cli
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for

STUDY = """
[study]
name = "small"
title = "Small"
description = "Two views, two clutters mixed, practice between people."
participants = 4
seed = 3
[factors.view]
levels.plain = { technique.use = "standard", questions.tlx.off = true }
levels.faint = { technique.use = "dynamic", technique.dynamic.alpha_target = 0.1 }
labels = { plain = "plainly", faint = "faintly" }
[factors.clutter]
set = "world.abstract.distractors"
values = [10, 30]
order = "mixed"
[factors.training]
vary = "between"
levels.none = { practice.trials = 0 }
levels.some = { practice.until = [1, 1], practice.most = 2 }
[world]
use = "abstract"
[world.abstract]
side = 50.0
targets = [4, 6]
[design]
tasks = ["count"]
trials = 1
[questions]
tlx = { when = "condition" }
ratings = {}
comparison = { of = "view" }
"""


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    """The study's file and its data folder: two simulated people, one in each group."""
    folder = tmp_path_factory.mktemp("factors")
    (folder / "small.toml").write_text(STUDY, "utf-8")
    words = ["simulate", str(folder / "small.toml"), "--participants", "2"]
    assert cli.main([*words, "--out", str(folder / "data")]) == 0
    return folder


def rows(folder, table):
    found = []
    for path in sorted(Path(folder).glob(f"data/data/simulated/*/*_{table}_data.csv")):
        with open(path, encoding="utf-8", newline="") as file:
            found += list(csv.DictReader(file))
    return found


def test_rows_are_the_plans_with_a_column_for_each_factor(played):
    study, found = load(str(played / "small.toml")), rows(played, "trials")
    plan = [t for slot in (1, 2) for s in session_for(slot, study.plan) for t in s.trials]
    for row, trial in zip(found, plan, strict=True):
        assert {name: row[name] for name in study.plan.names} == dict(trial.levels)
        assert (row["scene"], row["world"], row["task"]) == (trial.scene, "abstract", "count")
    header = list(found[0])
    at = header.index("attempt")
    assert header[at + 1 : at + 5] == ["view", "clutter", "training", "world"]
    assert Counter(r["training"] for r in found) == {"none": 4, "some": 4}


def test_what_is_asked_follows_levels(played):
    asked = rows(played, "questionnaire")
    tlx = [r for r in asked if r["item"].startswith("tlx_")]
    assert {r["view"] for r in tlx} == {"faint"} and len(tlx) == 2 * 6
    assert Counter((r["item"], r["view"]) for r in asked)["ease", "plain"] == 2
    assert {r["text"] for r in asked if r["item"] == "preference"} <= {"plain", "faint", "neutral"}
    assert "training" not in asked[0]


def test_practice_is_the_groups(played):
    traces = [p.name for p in played.glob("data/data/simulated/S01/traces/*training*")]
    assert traces == []
    assert list(played.glob("data/data/simulated/S02/traces/*training*"))


def test_the_sidecar_says_the_design_and_a_replay_makes_the_trial_again(played, capsys):
    (sidecar,) = played.glob("data/data/simulated/S01/*_trials_data.json")
    entry = json.loads(sidecar.read_text("utf-8"))["design"]
    assert [(f["name"], f["kind"], f["scenes"]) for f in entry["factors"]] == [
        ("view", "within", "alone"), ("clutter", "within", "changed"),
        ("training", "between", "alone"),
    ]  # fmt: skip
    assert entry["factors"][1]["numbers"] == [10.0, 30.0]
    words = ["replay", str(played / "data"), "--participant", "S02", "--trial", "3", "--verify"]
    assert cli.main(words) == 0
    assert "0 different" in capsys.readouterr().out


@pytest.mark.parametrize("form", ["wide", "bids", "psychds"])
def test_exports_name_levels(played, form):
    out = played / form
    words = ["export", str(played / "data"), "--format", form, "--out", str(out)]
    assert cli.main(words) == 0
    if form == "wide":
        with open(out / "wide.csv", encoding="utf-8", newline="") as file:
            header = next(csv.reader(file))
        assert any(name.startswith("time_plain_10_count_") for name in header)
        assert not [name for name in header if "none" in name or "some" in name]
        assert header[:3] == ["participant", "slot", "training"]
    if form == "bids":
        (table,) = out.glob("sub-S01/ses-1/beh/*.tsv")
        first = table.read_text("utf-8").splitlines()[1].split("\t")
        assert first[2].endswith("_none_count")
