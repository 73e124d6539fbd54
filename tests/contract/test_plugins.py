"""Every task, world and kind of question is what its suite demands; strangers' are found and pass
with no edit elsewhere; and the suite finds what is wrong."""

from __future__ import annotations

import csv
import inspect
import re
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from plugins import seethrough
from toy_study import toy_study

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.questions.kit import Question
from seethrough.experiment.questions.number.number_question import NumberQuestion
from seethrough.experiment.suites import suite
from seethrough.experiment.suites.suite import RULES, findings
from seethrough.renderer.techniques.base import Technique
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.count.count_task import Count
from seethrough.tasks.kit.base import Task
from seethrough.tasks.kit.hud import Button, Entry, Label, Rect
from seethrough.tasks.kit.measure import DISTANCE
from seethrough.tasks.kit.world import World
from seethrough.tasks.worlds.abstract.abstract_world import Abstract

LONGEST = 60  # lines of a toy, all its files together
OURS = [(kind, name) for kind in RULES for name in registry.known(kind)]


@pytest.mark.parametrize(("kind", "name"), OURS)
def test_every_plugin_is_what_its_suite_demands(kind: str, name: str) -> None:
    """No rule of a kind finds anything in any of it."""
    found = list(findings(kind, name))
    assert len(found) >= 6
    assert [str(finding) for finding in found if not finding.holds] == []


PROTOCOLS = {"Technique": Technique, "World": World, "Task": Task, "Question": Question}


def test_the_decision_says_what_each_kind_is_asked(root: Path) -> None:
    """The block at the end of decisions/0012 is the Protocols' methods, in their order."""
    text = (root / "decisions" / "0012-what-a-plug-in-is.md").read_text("utf-8")
    block = re.findall(r"```\n(.*?)```", text, re.DOTALL)[-1]
    said: dict[str, list[tuple[str, ...]]] = {}
    kind = ""
    for line in block.splitlines():
        kind = line.split()[0] if not line.startswith(" ") else kind
        calls = re.findall(r"(\w+)\(([^)]*)\)", line)
        said.setdefault(kind, []).extend((name, *args.split(", ")) for name, args in calls)
    for kind, protocol in PROTOCOLS.items():
        methods = {n: m for n, m in vars(protocol).items() if inspect.isfunction(m)}
        own = {n: m for n, m in methods.items() if not n.startswith("_")}
        assert said[kind] == [(n, *[*inspect.signature(m).parameters][1:]) for n, m in own.items()]
    assert said.keys() == PROTOCOLS.keys()


class Shifts(Count):
    """Remembers what it must not: the second trial begins elsewhere."""

    begun = 0

    def begin(self, made, setting, aspect):
        Shifts.begun += 1
        state = super().begin(made, setting, aspect)
        return replace(state, orbit=replace(state.orbit, yaw=0.1 * Shifts.begun))


class Late(Count):
    """Its picture depends on the clock."""

    def view(self, state):
        time.monotonic()
        return super().view(state)


class Fragile(Count):
    """One key too many."""

    def on_event(self, state, event):
        if getattr(event, "key", "") == "tab":
            raise RuntimeError("tab")
        return super().on_event(state, event)


class Mute(Count):
    """Says what no language knows, and measures what it does not."""

    measures = (*Count.measures, DISTANCE)

    def view(self, state):
        view = super().view(state)
        return replace(view, hud=(*view.hud, Label("count.nothing", (0.1, 0.1))))


class Random(Abstract):
    """Draws from a stream of its own."""

    def make(self, rng, parameters):
        return super().make(np.random.Generator(np.random.PCG64(time.time_ns())), parameters)


class Still(Abstract):
    """Says that one moves in it, and nobody can."""

    def viewer(self, made, parameters, aspect):
        return Stands(super().viewer(made, parameters, aspect))


class Stands:
    """A viewer whom nothing moves."""

    def __init__(self, viewer):
        self.camera = viewer.camera

    def on_event(self, event):
        return self


class Strays(Count):
    """Shows a button outside of the view, once the first key was pressed."""

    def view(self, state):
        view = super().view(state)
        moved = any(isinstance(e, Entry) and e.text for e in view.hud)
        away = Button("count.title", Rect(2.0, 0.5, 0.1, 0.1))
        return replace(view, hud=(*view.hud, away)) if moved else view


class Careless(NumberQuestion):
    """Forgets to say that it was answered, where it has to be."""

    def rows(self, p, asking, number, answers):
        return [] if p.required else super().rows(p, asking, number, answers)


@pytest.mark.parametrize(
    ("kind", "name", "plugin", "words"),
    [
        ("task", "count", Shifts, ("two ways",)),
        ("task", "count", Late, ("ReadsTheClock",)),
        ("task", "count", Fragile, ("raised RuntimeError: tab",)),
        ("task", "count", Mute, ("text count.nothing", "measure distance")),
        ("world", "abstract", Random, ("ReadsTheClock",)),
        ("world", "abstract", Still, ("of 200 events nothing moves the viewer",)),
        ("task", "count", Strays, ("lies outside of a view",)),
        ("question", "number", Careless, ("expected one of []",)),
    ],
)
def test_the_suite_finds(kind, name, plugin, words, monkeypatch):
    """Faults that a plug-in's author would not see."""
    faulty, real = plugin(), registry.get
    found = lambda k, n: faulty if (k, n) == (kind, name) else real(k, n)  # noqa: E731
    monkeypatch.setattr(suite.registry, "get", found)
    problems = [str(finding) for finding in findings(kind, name) if not finding.holds]
    for word in words:
        assert any(word in problem for problem in problems), problems


@pytest.fixture(scope="module")
def strangers(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    """Where the toys are installed, beside packages that `new` began."""
    site, work = tmp_path_factory.mktemp("site"), tmp_path_factory.mktemp("work")
    folders = []
    for kind in RULES:
        shutil.copytree(root / "tests" / "plugins" / f"toy_{kind}", work / f"toy_{kind}")
        assert cli.main(["new", kind, f"begun_{kind}", str(work / f"begun_{kind}")]) == 0
        folders += [work / f"toy_{kind}", work / f"begun_{kind}"]
    pip = (sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-build-isolation",
           "--no-index", "--upgrade", "--target", str(site))  # fmt: skip
    subprocess.run([*pip, *map(str, folders)], check=True, capture_output=True)
    return site


@pytest.mark.parametrize("whose", ["toy", "begun"])
@pytest.mark.parametrize("kind", RULES)
def test_a_strangers_package_is_listed_and_passes(kind, whose, strangers):
    """With no edit of ours: found by its entry point."""
    name = f"{whose}_{kind}"
    for words in (("list",), ("check", name)):
        run = seethrough(strangers, kind, *words)
        assert run.returncode == 0, run.stdout + run.stderr
        assert words[0] == "check" or name in run.stdout


STUDY = toy_study("xray", "dynamic")


def test_strangers_objects_go_through_a_whole_study(strangers, tmp_path):
    """Checked, played, replayed to the pixel: the task in our world, our task in the world."""
    study, data = tmp_path / "toys.toml", tmp_path / "data"
    study.write_text(STUDY, "utf-8")
    for words in (
        ("check", str(study), "--config-only"),
        ("simulate", str(study), "--participants", "1", "--out", str(data)),
        ("replay", str(data), "--participant", "S01", "--trial", "1", "--verify"),
    ):
        run = seethrough(strangers, *words)
        assert run.returncode == 0, run.stdout + run.stderr
    folder = data / "data" / "simulated" / "S01"
    found = {}
    for kind in ("trials", "questionnaire"):
        (table,) = folder.glob(f"*{kind}_data.csv")
        with open(table, encoding="utf-8", newline="") as file:
            found[kind] = list(csv.DictReader(file))
    cells = {(r["view"], r["place"], r["world"], r["task"]) for r in found["trials"]}
    where = (("cube", "abstract", "toy_task"), ("row", "toy_world", "depth_order"))
    assert cells == {(view, *rest) for view in ("plain", "xray") for rest in where}
    assert all(row["answer"] and row["correct"] for row in found["trials"])
    assert [row["item"] for row in found["questionnaire"]] == ["liked"] * 4
    assert {row["value"] for row in found["questionnaire"]} <= {"0", "1"}


@pytest.mark.parametrize("kind", RULES)
def test_toys_are_short(kind: str, root: Path) -> None:
    """So much is what a plug-in costs."""
    files = (root / "tests" / "plugins" / f"toy_{kind}").iterdir()
    lines = sum(len(f.read_text("utf-8").splitlines()) for f in files if f.is_file())
    assert lines <= LONGEST


def test_what_cannot_be_begun_or_checked_is_said_in_a_line(tmp_path, capsys):
    (tmp_path / "there").mkdir()
    for words, message in (
        (["new", "task", "Bad Name", str(tmp_path / "x")], "expected 1 to 40 small letters"),
        (["new", "task", "Mine", str(tmp_path / "x")], "expected 1 to 40 small letters"),
        (["new", "task", "limit", str(tmp_path / "x")], "expected another name, a study says"),
        (["new", "technique", "use", str(tmp_path / "x")], "expected another name, a study says"),
        (["new", "question", "sus", str(tmp_path / "x")], "expected another name, a study says"),
        (["new", "task", "count", str(tmp_path / "x")], "there is one of this name already"),
        (["new", "task", "mine", str(tmp_path / "there")], "expected a folder that can be made"),
        (["task", "check", "cuont"], "did you mean count?"),
    ):
        assert cli.main(words) == 2
        said = capsys.readouterr().err
        assert message in said and said.count("\n") == 1
    assert set(TASKS) >= {"count", "pattern", "unique", "count_in_building"}
