"""design, migrate, prereg, new study, render and check --balance, as their user runs them."""

import csv
import io
import re

import pytest

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.session import balance_check
from seethrough.experiment.session.answering import played
from seethrough.experiment.session.balance_check import refilled, table_of, verdicts
from seethrough.experiment.study.config import load, shipped
from seethrough.experiment.study.design import design, items
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.new_study import new_study
from seethrough.experiment.study.shown.design_page import color

FACTORIAL = ["clutter", "expertise", "livingston2003", "opacity", "published", "training"]


@pytest.mark.parametrize("name", FACTORIAL)
def test_the_design_is_printed_written_and_drawn(tmp_path, capsys, name):
    assert cli.main(["design", name]) == 0
    said = capsys.readouterr().out
    study = load(name)
    assert all(f"factor     {f.name}: {f.kind}" in said for f in study.factors)
    assert f"cells      {len(study.plan.cells)}" in said and "minutes" in said
    out, page = tmp_path / "d.csv", tmp_path / "d.html"
    assert cli.main(["design", name, "--csv", str(out), "--html", str(page)]) == 0
    with open(out, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    expected = [
        (str(slot), str(t.number), t.scene, *t.levels.values())
        for slot in study.plan.slots(study.general.participants)
        for s in session_for(slot, study.plan)
        for t in s.trials
    ]
    names = ("slot", "trial", "scene", *study.plan.names)
    assert [tuple(r[n] for n in names) for r in rows] == expected
    text = page.read_text("utf-8")
    assert text.count("<th scope='row'>") == study.general.participants
    blocks = len(study.plan.conditions(0))
    assert text.count("<td ") == study.general.participants * blocks
    assert "http" not in text and "<script" not in text
    assert cli.main(["design", name, "--csv", str(out)]) == 2  # never overwritten


def test_what_the_colours_do_not_show_is_said(tmp_path, capsys):
    """Which cell is left out, and what changes from trial to trial."""
    page = tmp_path / "d.html"
    assert cli.main(["design", "clutter", "--html", str(page)]) == 0
    assert cli.main(["design", "clutter"]) == 0
    assert "cells      8, 1 left out: plain/380\n" in capsys.readouterr().out
    said = "Within a block its trials mix the levels of clutter: 80, 180, 380."
    assert said in page.read_text("utf-8")


def test_colours_of_neighbours_differ():
    for of in (2, 3, 12, 36):
        assert len({color(k, of) for k in range(of)}) == of


def test_slots_are_a_sensible_number(capsys):
    assert cli.main(["design", "demo", "--slots", "0"]) == 2
    assert "--slots = 0: expected a number from 1 to 100000" in capsys.readouterr().err


@pytest.mark.parametrize("name", sorted(shipped()))
def test_every_shipped_study_keeps_its_promises(name, capsys):
    study = load(name)
    assert cli.main(["check", name, "--balance"]) == 0
    said = capsys.readouterr().out
    assert said.count("as they come") == len(study.plan.groups)
    assert said.count("after drop-outs") == len(study.plan.groups)


def test_a_session_without_eyes_has_the_trials_of_the_plan():
    study = load("clutter")
    records = played(study, 5)
    plan = [t for s in session_for(5, study.plan) for t in s.trials]
    assert [r.trial for r in records] == plan


def test_a_promise_that_is_broken_fails(monkeypatch, capsys):
    monkeypatch.setattr(design, "rotation", lambda row, passes, sets: 0)
    assert cli.main(["check", "published", "--balance"]) == 1
    assert re.search(r"balance .*FAILS, item × cell", capsys.readouterr().out)
    assert items.rotation(0, 1, 2) == 1  # what was broken


def test_one_order_for_all_is_noticed_in_between_and_rows_stay_even_after_drop_outs():
    study = load("published")
    slots = [1, 5, 9, 13]  # all of one row
    (found,) = verdicts(study, table_of(study, slots), slots)
    assert "rows differ by 4" in found.broken
    again = refilled(study.plan, 16, 3)
    assert sorted(again) == list(range(1, 17))
    (found,) = verdicts(study, table_of(study, again), again)
    assert not found.broken and balance_check.DROPPED == 0.2


def test_a_preregistration_says_what_is_decided(tmp_path, capsys):
    out = tmp_path / "p.md"
    assert cli.main(["prereg", "published", "--out", str(out)]) == 0
    text = out.read_text("utf-8")
    assert load("published").digest() in text
    for said in (
        "**P1**: `time` is less than at the baseline (transparency: standard).",
        "| T3 unique | distance (`distance`) | units | less | mean",
        "- trials answered sooner than 0.2 s",
        "16 people",
        "| ratings | ratings | end | transparency × scenario | `efficiency` (0 to 4); ",
        "| comparison | comparison | end | session | `preference`; `depth_self_report` ",
    ):
        assert said in text
    assert cli.main(["prereg", "published", "--out", str(out)]) == 2
    asked = tmp_path / "asked.toml"
    more = '\n[analysis]\npairwise = ["view"]\naligned_ranks = true\n'
    asked.write_text(shipped()["opacity"].read_text("utf-8") + more, "utf-8")
    assert cli.main(["prereg", str(asked)]) == 0
    said = capsys.readouterr().out
    assert "Every pair of levels is compared of view, by Holm." in said
    assert "are tested by aligned ranks, too." in said
    assert cli.main(["prereg", "training"]) == 0
    assert "None is stated: every comparison is exploratory." in capsys.readouterr().out
    assert cli.main(["prereg", "liao2023"]) == 0
    said = "`sus`, turned: `sus_2`, `sus_4`, `sus_6`, `sus_8`, `sus_10`"
    assert f"| sus | sus | end | interface | {said} |" in capsys.readouterr().out


def test_an_old_file_is_rewritten_beside_itself(tmp_path, capsys):
    old = tmp_path / "old.toml"
    text = (
        '[study]\nname = "old"\ntitle = "t"\ndescription = "d"\nparticipants = 4\nseed = 1\n'
        "[design]\ntrials = 2 # two\n[session]\ndemographics = true\n"
    )
    old.write_text(text, "utf-8")
    assert cli.main(["check", str(old), "--config-only"]) == 2
    assert f"`seethrough migrate {old}` makes of it" in capsys.readouterr().err
    assert cli.main(["migrate", str(old)]) == 0
    new = tmp_path / "old-migrated.toml"
    assert load(str(new)).design.trials == 2 and "# two" in new.read_text("utf-8")
    assert old.read_text("utf-8") == text
    assert cli.main(["migrate", str(old)]) == 2  # never overwritten
    assert cli.main(["migrate", str(new)]) == 2
    assert "is in the present language" in capsys.readouterr().err


def test_a_new_study_is_one_that_can_be_checked(tmp_path, capsys):
    assert cli.main(["new", "study", "myViews2", str(tmp_path), "--yes"]) == 0
    study = load(str(tmp_path / "myViews2.toml"))
    assert study.general.name == "myViews2"  # as it was typed
    assert study.factor("view").names == ("standard", "dynamic")
    workflow = (tmp_path / ".github" / "workflows" / "study.yml").read_text("utf-8")
    assert "seethrough check myViews2.toml --balance" in workflow
    assert cli.main(["new", "study", "myViews2", str(tmp_path), "--yes"]) == 2
    assert "exists already" in capsys.readouterr().err
    assert cli.main(["new", "study", "my_views", str(tmp_path / "no"), "--yes"]) == 2
    said = "new study: NAME = my_views: expected 1 to 32 letters and digits (A–Z, a–z, 0–9)\n"
    assert capsys.readouterr().err.endswith(said) and not (tmp_path / "no").exists()


@pytest.mark.parametrize("task", registry.known("task"))
def test_a_new_study_of_any_task_can_be_checked(task, tmp_path, monkeypatch):
    """What cannot be taken is asked for again, and nothing is written before the last answer."""
    monkeypatch.setattr("sys.stdin.isatty", lambda: True)
    title = 'C:\\ "quoted" é'
    answers = iter(["x", task, "plain", "standard", "standard, lens", "0", "9" * 30, "12",
                    "a\x1b[2J", title])  # fmt: skip

    def answer(question, proposal):
        assert not list(tmp_path.iterdir())
        return next(answers)

    assert new_study("mine", tmp_path, False, answer) == 0
    study = load(str(tmp_path / "mine.toml"))
    assert next(answers, None) is None and study.general.title == title
    assert (study.general.participants, study.design.tasks) == (12, (task,))


def test_a_new_study_nobody_answers_for_is_not_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    assert cli.main(["new", "study", "mine", str(tmp_path / "mine")]) == 2
    assert "nothing was written" in capsys.readouterr().err and not list(tmp_path.iterdir())


def test_every_cell_of_a_study_has_a_plate(tmp_path, capsys):
    from PIL import Image

    out = tmp_path / "plates.png"
    assert cli.main(["render", "clutter", "--out", str(out), "--size", "120x90"]) == 0
    assert "8 plates of clutter" in capsys.readouterr().out
    with Image.open(out) as sheet:
        assert sheet.size == (360, 3 * (90 + 22))
        assert len(sheet.getcolors(2**20)) > 100
    assert cli.main(["render", "clutter", "--out", str(out), "--set", "alpha=1"]) == 2
