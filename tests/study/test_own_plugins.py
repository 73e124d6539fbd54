"""Plug-ins in files beside a study: the toys go from the file to the report with no edit elsewhere;
what is wrong with one is found by its suite, or ends the session in a line with the trials kept."""

from __future__ import annotations

import csv
import json
import pickle
import shutil
import sys
import time
import tomllib
from pathlib import Path

import pytest
from scripted_session import ANSWERS, MemoryRecorder, ScriptedInput, study
from scripted_session import FakeDisplay as Display
from toy_study import toy_study

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.files import trust
from seethrough.experiment.session import strangers
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.strangers import PluginFailed
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.beside import plugin_files
from seethrough.experiment.study.config import load, parse
from seethrough.experiment.suites.suite import findings
from seethrough.tasks.catalog import TASKS

ROOT = Path(__file__).parents[2]
STUDY = toy_study("near", "toy", brought=True)


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A folder with the toys; nothing is trusted, and nothing stays known."""
    monkeypatch.setenv(trust.HOME, str(tmp_path / "home"))
    monkeypatch.setenv(trust.TOLD, "")
    monkeypatch.setattr(registry, "_provided", {})
    for kind in plugin_files.KINDS:
        shutil.copy(ROOT / f"tests/plugins/toy_{kind}/toy_{kind}.py", tmp_path)
    (tmp_path / "toys.toml").write_text(STUDY, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_toys_go_from_a_study_file_to_its_report(own, capsys):
    """Checked by their suites, played, replayed, reported; their code is kept with the data."""
    for words in (
        ("check", "toys.toml", "--config-only", "--trust"),
        ("simulate", "toys.toml", "--participants", "2", "--out", "data", "--trust"),
        ("replay", "data", "--participant", "S01", "--trial", "1", "--verify", "--trust"),
        ("report", "data", "--out", "report"),
        ("export", "data", "--format", "wide", "--out", "wide"),
    ):
        registry._provided.clear()  # as a new process has it
        assert cli.main(words) == 0, capsys.readouterr()
    (table,) = (own / "data/data/simulated/S01").glob("*trials_data.csv")
    with open(table, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    where = {(r["view"], r["world"], r["task"]) for r in rows}
    places = (("abstract", "toy_task"), ("toy_world", "depth_order"))
    assert where == {(view, *place) for view in ("plain", "near") for place in places}
    assert all((r["confidence"] != "") == (r["task"] == "toy_task") for r in rows)
    sidecar = json.loads(table.with_suffix(".json").read_text("utf-8"))
    said = sidecar["provenance"]["study"]["plugins"]
    assert {(p["kind"], p["file"]) for p in said} == {
        (kind, f"toy_{kind}.py") for kind in plugin_files.KINDS
    }
    kept = sorted(p.name for p in (own / "data/plugins").iterdir())
    assert kept == sorted(f"{p['kind']}-{p['name']}-{p['sha256'][:12]}.py" for p in said)
    with open(own / "wide/wide.csv", encoding="utf-8", newline="") as file:
        wide = next(csv.DictReader(file))
    sure = {r["view"]: r["confidence"] for r in rows if r["task"] == "toy_task"}
    assert {view: wide[f"confidence_{view}_toy_task_1"] for view in sure} == sure
    assert "toy_task" in (own / "report/report.html").read_text("utf-8")
    assert capsys.readouterr().err.count("tried by the suite, once") == 4


def test_code_runs_only_once_somebody_trusts_it(own, capsys, monkeypatch):
    """Not without a word, not after a no; after a yes, until the file changes."""
    mark = own / "ran"
    (own / "toy_task.py").write_text(f"open({str(mark)!r}, 'w')\n", "utf-8")
    table = STUDY.replace('file = "toy_technique.py"\n', "").replace('"toy"', '"constant"')
    table = table.replace("[technique.toy]\ndistance = 9.0\n", "")
    table = table.replace('[question.toy_question]\nfile = "toy_question.py"\n', "")
    table = table.replace('liked = { use = "toy_question", when = "condition", ', "liked = { ")
    table = table.replace("{ text", '{ use = "text", text')
    table = table.replace('file = "toy_world.py"\nballs = 8\n', "").replace(
        "[world.toy_world]\n", ""
    )
    (own / "toys.toml").write_text(table.replace('"toy_world"', '"abstract"'), "utf-8")
    assert cli.main(["check", "toys.toml", "--config-only"]) == 2
    said = capsys.readouterr().err
    assert "task.toy_task.file" in said and "--trust" in said and said.count("\n") == 1
    assert not mark.exists()
    answers = iter(["no\n", "yes\n"])

    class Terminal:
        def isatty(self):
            return True

        def readline(self):
            return next(answers)

    monkeypatch.setattr("sys.stdin", Terminal())
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    sha = plugin_files.PluginFile("task", "toy_task", "toy_task.py", b"1").sha256
    for answer in ("no", "yes", "remembered"):
        if answer == "no":
            with pytest.raises(plugin_files.InputError, match="the answer was no"):
                trust.demand("here", "toy_task.py", sha)
        else:
            trust.demand("here", "toy_task.py", sha)
    monkeypatch.setenv(trust.TOLD, "")
    trust.demand("here", "toy_task.py", sha)  # another process remembers
    with pytest.raises(StopIteration):  # it would be asked about another content
        trust.demand("here", "toy_task.py", sha[::-1])


WRONG = [
    ("x = 1\n\nraise ValueError('no')", "cannot be loaded (ValueError: no) (toy_task.py, line 3)"),
    ("x = 1", "expected a TASK in it"),
    ("import math\nmath.none", "cannot be loaded (AttributeError: module 'math' has no attribute"),
    ("TASK = 1", "cannot be loaded (AttributeError: 'int' object has no attribute 'name')"),
    ("class T:\n    name = 'other'\nTASK = T()", "calls itself 'other', expected 'toy_task'"),
    ("def f():\n    raise OSError\nf()", "cannot be loaded (OSError: ) (toy_task.py, line 2)"),
    ("def f(:", "cannot be loaded (SyntaxError"),
    ("class T:\n    name = 'toy_task'\nTASK = T()",
     "expected what its suite demands: It says what it is"),
    ("import os\nos._exit(3)", "expected what its suite demands: it ended by itself"),
]  # fmt: skip


@pytest.mark.parametrize(("code", "words"), WRONG)
def test_a_file_that_is_no_plugin_is_refused_in_a_line(own, code, words, capsys):
    (own / "toy_task.py").write_text(code, "utf-8")
    plugin = plugin_files.PluginFile("task", "toy_task", "toy_task.py", code.encode())
    trust.trust_everything()
    where = 'toys.toml: task.toy_task.file = "toy_task.py"'
    with pytest.raises(plugin_files.InputError) as error:
        if "os._exit" not in code and "demands" not in words:
            plugin_files.provide(plugin, own / "toy_task.py", where)
        plugin_files._demand_suite(plugin, own / "toy_task.py", where)
    assert words in str(error.value) and "\n" not in str(error.value)


def test_what_a_suite_could_not_read_is_said_once(own, monkeypatch):
    """In the study's words, not in those of the command that tried it, and with the line."""
    code = "x = 1\nraise ValueError('no')\n"
    (own / "toy_task.py").write_text(code, "utf-8")
    trust.trust_everything()
    plugin = plugin_files.PluginFile("task", "toy_task", "toy_task.py", code.encode())
    with pytest.raises(plugin_files.InputError) as error:
        plugin_files._demand_suite(plugin, own / "toy_task.py", "toys.toml: task.toy_task.file")
    assert str(error.value) == (
        "toys.toml: task.toy_task.file: cannot be loaded (ValueError: no) (toy_task.py, line 2)"
    )


ENTRIES = [
    ('file = "../toy_task.py"', "expected a Python file beside the study"),
    ('file = "missing.py"', "expected a Python file beside the study (No such file"),
    ('file = "toy_task.toml"', "task.toy_task"),
    ("file = 3", "task.toy_task"),
]


@pytest.mark.parametrize(("entry", "words"), ENTRIES)
def test_an_entry_that_names_no_code_is_refused(own, entry, words):
    trust.trust_everything()
    table = STUDY.replace('file = "toy_task.py"', entry)
    (own / "toys.toml").write_text(table, "utf-8")
    for line in ("toy_technique", "toy_world", "toy_question"):
        table = table.replace(f'file = "{line}.py"\n', "")
    (own / "few.toml").write_text(table.replace("[question.toy_question]\n", ""), "utf-8")
    with pytest.raises(plugin_files.InputError) as error:
        load(str(own / "few.toml"))
    assert any(words in line for line in error.value.faults)


def test_a_study_goes_to_another_process_with_its_code(own):
    """Which has to know the code before it can read the study."""
    trust.trust_everything()
    for kind in ("task", "world", "question", "technique"):
        path = own / f"toy_{kind}.py"
        plugin = plugin_files.PluginFile(kind, "", path.name, path.read_bytes())
        plugin_files.provide(plugin, path, "here")
    table = tomllib.loads(STUDY)
    for kind in ("task", "world", "technique"):
        for given in table[kind].values():
            given.pop("file", None)
    del table["question"]
    config = parse(table, "toys")
    sent = pickle.dumps(config)
    registry._provided.clear()
    for name in [name for name in sys.modules if name.startswith("seethrough_own_")]:
        del sys.modules[name]
    assert pickle.loads(sent).digest() == config.digest()


def test_a_task_cannot_take_the_name_of_ours(own):
    trust.trust_everything()
    code = (own / "toy_task.py").read_text("utf-8").replace('"toy_task"', '"count"')
    plugin = plugin_files.PluginFile("task", "count", "count.py", code.encode())
    with pytest.raises(plugin_files.InputError, match="there is a task count already"):
        plugin_files.provide(plugin, own / "count.py", "here")


COUNT = """
import time
from datetime import datetime
from time import monotonic
from dataclasses import replace
from seethrough.tasks.count.count_task import Count
class Mine(Count):
    name = "mine"
    met = 0
    {body}
TASK = Mine()
"""
BAD = {
    "raises": ("def on_event(self, state, event):\n        raise KeyError('x')",
               "raised KeyError: 'x' (mine.py, line 11)"),
    "blocks": ("def on_event(self, state, event):\n        time.sleep(99)",
               "did not come back within 0 s (mine.py, line 11)"),
    "loops": ("def view(self, state):\n        while True: pass", "did not come back"),
    "nonsense": ("def view(self, state):\n        return 7", "expected a View"),
    "answers nonsense": ("def outcome(self, state):\n        return 'yes'", "an Outcome"),
    "remembers": ("def begin(self, made, setting, aspect):\n        Mine.met += 1\n        "
                  "s = super().begin(made, setting, aspect)\n        "
                  "return replace(s, orbit=replace(s.orbit, yaw=0.1 * Mine.met))", "two ways"),
    "clock": ("def view(self, state):\n        time.time()\n        return super().view(state)",
              "ReadsTheClock"),
    "clock by name": ("def view(self, state):\n        monotonic()\n        "
                      "return super().view(state)", "ReadsTheClock"),
    "date": ("def view(self, state):\n        datetime.now()\n        return super().view(state)",
             "ReadsTheClock"),
}  # fmt: skip


def brought(own: Path, body: str) -> None:
    code = COUNT.format(body=body)
    plugin = plugin_files.PluginFile("task", "mine", "mine.py", code.encode())
    (own / "mine.py").write_text(code, "utf-8")
    plugin_files.provide(plugin, own / "mine.py", "here")


@pytest.mark.parametrize("fault", BAD)
def test_the_suite_finds_what_is_wrong_with_a_task(own, fault, monkeypatch):
    monkeypatch.setattr("seethrough.experiment.suites.suite.RULE_LIMIT", 0.3)
    body, words = BAD[fault]
    brought(own, body)
    if "come back" not in words:
        monkeypatch.setattr("seethrough.experiment.suites.suite.RULE_LIMIT", 60.0)
    problems = [str(f) for f in findings("task", "mine") if not f.holds]
    assert any(words in problem for problem in problems), problems


AT_RUN = {
    "raises": ("raise KeyError('x')", "on_event: raised KeyError: 'x' (mine.py, line 15)"),
    "blocks": ("time.sleep(99)", "on_event: did not come back within 0 s (mine.py, line 15)"),
    "nonsense": ("return 7", "gave"),
}


@pytest.mark.parametrize("fault", AT_RUN)
def test_what_the_suite_did_not_meet_ends_the_session_with_the_trials_kept(own, fault, monkeypatch):
    """The third trial's first event does it."""
    act, words = AT_RUN[fault]
    body = (
        "begun = 0\n    def begin(self, made, setting, aspect):\n        Mine.begun += 1\n"
        "        return super().begin(made, setting, aspect)\n"
        f"    def on_event(self, state, event):\n        if Mine.begun == 3: {act}\n"
        "        return super().on_event(state, event)"
    )
    if fault == "nonsense":
        body = body.replace(
            "on_event(self, state, event):\n        if", "view(self, state):\n        if"
        )
        body = body.replace("on_event(state, event)", "view(state)")
    brought(own, body)
    monkeypatch.setattr(strangers, "PATIENCE", 0.4)
    monkeypatch.setitem(ANSWERS, "mine", ["1", "enter"])
    config = study(design={"trials": 4, "tasks": ["mine"]}, practice={"trials": 0})
    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    person = ScriptedInput(clock, ANSWERS)
    began = time.monotonic()
    with pytest.raises(PluginFailed) as error:
        run_session(config, 1, Surroundings(Display(clock), person, clock, recorder, TASKS))
    assert time.monotonic() - began < 60  # as it would be without a limit
    (line,) = error.value.lines
    assert line.startswith("task mine: ") and words in line
    assert [r.trial.number for r in recorder.ended] == [1, 2]
    assert recorder.status == "plug-in failed"


TABLES = {
    "technique": {"factors": {"view": {"levels": {
        "near": {"technique": {"use": "toy"}}, "far": {"technique": {"use": "standard"}},
    }}}},
    "world": {"world": {"use": "toy_world"}, "design": {"trials": 2, "tasks": ["depth_order"]}},
    "question": {"questions": {"liked": {"use": "toy_question", "text": "?", "when": "start"}}},
}  # fmt: skip


def test_a_stranger_s_fault_is_a_line_of_any_command(own, capsys, monkeypatch):
    """Not only of a session: pictures are drawn and studies looked at by many."""
    path = own / "toy_world.py"
    code = path.read_text("utf-8").replace("return [first]", "raise KeyError('x')")
    path.write_text(code, "utf-8")
    monkeypatch.setattr(plugin_files, "_demand_suite", lambda *_: None)
    assert cli.main(["check", "toys.toml", "--trust"]) == 2
    *progress, line = capsys.readouterr().err.splitlines()
    assert all(said.startswith("measuring difficulty: ") for said in progress)
    number = code.splitlines().index("        raise KeyError('x')") + 1
    assert (
        line == f"seethrough: world toy_world: raised KeyError: 'x' (toy_world.py, line {number})"
    )


ELSEWHERE = [
    ("technique", "begin", "def begin(self, p):", "raise KeyError('x')"),
    ("technique", "begin", "def begin(self, p):", "time.sleep(99)"),
    ("world", "make_scene", "def camera(self):", "raise KeyError('x')"),
    ("world", "make_scene", "def make(self, rng, p):", "raise KeyError('x')"),
    ("question", "count", "def count(self, p):", "raise KeyError('x')"),
    ("question", "count", "def count(self, p):", "return 'many'"),
    ("question", "last", "def last(self, p, asking, number):", "time.sleep(99)"),
    ("question", "last", "def last(self, p, asking, number):", "return 7"),
    ("question", "pages", "def pages(self, p, asking):", "return ()"),
    ("question", "rows", "def rows(self, p, asking, number, answers):", "return [7]"),
]


@pytest.mark.parametrize(("kind", "what", "head", "act"), ELSEWHERE)
def test_a_stranger_of_any_kind_may_only_end_the_session(own, kind, what, head, act, monkeypatch):
    """Also where it has a task of ours in it, or a trial of ours has it."""
    path = own / f"toy_{kind}.py"
    code = path.read_text("utf-8")
    if "camera" in head:
        code = code.replace("return controls.orbit(p, aspect)", "return Lost()")
        code += f"\n\nclass Lost:\n    {head}\n        {act}\n"
    else:
        code = code.replace(f"    {head}", f"    def unused_{head[4:]}")
        made = f"    {head}\n        {act}\n"
        code = code.replace("\n\n\nTECHNIQUE", f"\n\n{made}\n\nTECHNIQUE")
        code = code.replace("\n\n\nWORLD", f"\n\n{made}\n\nWORLD")
        code = code.replace("\n\n\nQUESTION", f"\n\n{made}\n\nQUESTION")
    code = "import time\n" + code
    plugin = plugin_files.PluginFile(kind, "", path.name, code.encode())
    name = plugin_files.provide(plugin, path, "here")
    monkeypatch.setattr(strangers, "PATIENCE", 0.4)
    answers = {**ANSWERS, "depth_order": ["a"]}
    config = study(**TABLES[kind], practice={"trials": 0})
    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    person = ScriptedInput(clock, answers)
    with pytest.raises(PluginFailed) as error:
        run_session(config, 1, Surroundings(Display(clock), person, clock, recorder, TASKS))
    (line,) = error.value.lines
    assert line.startswith(f"{kind} {name}: {what}: ")
    assert recorder.status == "plug-in failed"
