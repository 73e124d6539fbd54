"""Tasks that tables and reports could not tell apart are refused by name before anybody plays."""

import pytest

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.files import trust

TASK = """
from dataclasses import replace
from seethrough.api import measure
from seethrough.tasks.count.count_task import Count

class Nearer(Count):
    name, code = "nearer", "{code}"
    measures = ({measures})

TASK = Nearer()
"""
STUDY = """
[study]
name = "own"
title = "Own"
description = "Two tasks."
participants = 2
seed = 1
[factors.view]
levels.plain = {{ technique.use = "standard" }}
levels.through = {{ technique.use = "dynamic" }}
[world]
use = "abstract"
[design]
tasks = ["count", "nearer"]
trials = 1
[task]
confidence = {sure}
[task.nearer]
file = "nearer.py"
"""
WHERE = 'own.toml: design.tasks = "nearer": expected '


@pytest.fixture
def said(tmp_path, monkeypatch, capsys):
    """The lines that `check` refuses a study with, whose own task has these."""
    monkeypatch.setattr(registry, "_provided", {})
    monkeypatch.setenv(trust.HOME, str(tmp_path / "home"))
    # Whether the toy keeps to its suite is another test's matter.
    where = "seethrough.experiment.study.beside.plugin_files._demand_suite"
    monkeypatch.setattr(where, lambda *_: None)

    def checked(code="N1", measures="measure.CORRECT,", sure="false", change=None):
        (tmp_path / "nearer.py").write_text(TASK.format(code=code, measures=measures), "utf-8")
        text = STUDY.format(sure=sure)
        (tmp_path / "own.toml").write_text(text.replace(*change) if change else text, "utf-8")
        status = cli.main(["check", str(tmp_path / "own.toml"), "--config-only", "--trust"])
        lines = capsys.readouterr().err.splitlines()
        assert (status, bool(lines)) in ((0, False), (2, True))
        return [line.partition(f"{tmp_path}/")[2] for line in lines]

    return checked


def test_tasks_that_can_be_told_apart_are_taken(said):
    assert said() == []


def test_a_code_is_one_task_s(said):
    assert said(code="T1") == [f"{WHERE}a code of its own, T1 is that of count"]


@pytest.mark.parametrize(
    ("name", "is_"),
    [("frames", "a column of every study"), ("time", "a column of every study"),
     ("slot", "a column of every study"), ("view", "a factor")],
)  # fmt: skip
def test_a_measure_has_a_column_of_its_own(said, name, is_):
    own = f'measure.Measure("{name}", "", "less", "count"),'
    expected = f"{WHERE}another name for its measure {name}, it is {is_}"
    assert said(measures=own) == [expected]


def test_confidence_is_a_task_s_own_measure_or_the_study_s(said):
    assert said(measures="measure.CONFIDENCE,") == []
    (line,) = said(measures="measure.CONFIDENCE,", sure="true")
    expected = "another name for its measure confidence, it is what [task] confidence asks for"
    assert line == f"{WHERE}{expected}"


def test_one_measure_is_the_same_of_every_task(said):
    own = 'replace(measure.COUNT_ERROR, unit="m"),'
    expected = f"{WHERE}the measure count_error to be what it is of count"
    assert said(measures=own) == [expected]
    assert said(measures='replace(measure.COUNT_ERROR, label="another"),') == []


@pytest.mark.parametrize(
    ("kind", "name"), [("task", "limit"), ("technique", "use"), ("question", "ratings")]
)
def test_no_plug_in_has_the_name_of_a_key(said, kind, name):
    """Its table could not be told from the key."""
    lines = said(change=("[task.nearer]", f'[{kind}.{name}]\nfile = "nearer.py"\n[task.nearer]'))
    assert lines[0] == (
        f'own.toml: {kind}.{name}.file = "nearer.py": expected another name than {name}, a study '
        "says other things by it"
    )
