"""Whoever misspells a key or a name is told the nearest one that there is, whatever it is the name
of: one routine (renderer/meant.py) says it everywhere."""

import pytest

from seethrough.experiment import cli
from seethrough.renderer.meant import meant, nearest

STUDY = """
[study]
name = "own"
title = "Own"
description = "Misspelt."
participants = 4
seed = 1
language = "en"
[factors.view]
levels.plain = { technique.use = "standard" }
levels.through = { technique.use = "dynamic" }
baseline = "plain"
vary = "within"
[world]
use = "abstract"
[world.abstract]
scenes = "own"
[world.building]
types = ["table", "lamp", "plant"]
[look]
antialiasing = "auto"
[technique.dynamic]
order = "planes"
[task.depth_order]
ratio = 1.5
[design]
tasks = ["count"]
trials = 1
order = "williams"
exclude = []
[session]
resume = "block"
[questions]
hard = { use = "likert", text = "Hard?", when = "condition", each = ["view"], only = { view = "plain" } }
[analysis]
tests = ["time"]
exclude = ["timed_out"]
pairwise = ["view"]
[[analysis.predictions]]
name = "P1"
measure = "time"
contrast = "view"
level = "through"
expect = "less"
"""  # noqa: E501

MISSPELT = [
    ("[session]", "[sesion]", "session"),
    ("seed =", "sede =", "seed"),
    ('language = "en"', 'language = "EN"', "en"),
    ("baseline =", "baselin =", "baseline"),
    ('baseline = "plain"', 'baseline = "plian"', "plain"),
    ('vary = "within"', 'vary = "wihtin"', "within"),
    ('{ technique.use = "dynamic" }', '{ technique.use = "dynamik" }', "dynamic"),
    ('use = "abstract"', 'use = "abstrakt"', "abstract"),
    ("[world.abstract]", "[world.abstrct]", "abstract"),
    ('scenes = "own"', 'scenes = "onw"', "own"),
    ("[technique.dynamic]", "[technique.dynamics]", "dynamic"),
    ("[task.depth_order]", "[task.depth_orders]", "depth_order"),
    ("ratio =", "ration =", "ratio"),
    ('tasks = ["count"]', 'tasks = ["cuont"]', "count"),
    ('order = "williams"', 'order = "wiliams"', "williams"),
    ("exclude = []", 'exclude = [{ veiw = "plain" }]', "view"),
    ("exclude = []", 'exclude = [{ view = "plian" }]', "plain"),
    ('resume = "block"', 'resume = "blok"', "block"),
    ('use = "likert"', 'use = "likret"', "likert"),
    ('when = "condition"', 'when = "conditoin"', "condition"),
    ('each = ["view"]', 'each = ["veiw"]', "view"),
    ('only = { view = "plain" }', 'only = { veiw = "plain" }', "view"),
    ('only = { view = "plain" }', 'only = { view = "plian" }', "plain"),
    ('tests = ["time"]', 'tests = ["tiem"]', "time"),
    ('exclude = ["timed_out"]', 'exclude = ["timedout"]', "timed_out"),
    ('pairwise = ["view"]', 'pairwise = ["veiw"]', "view"),
    ('measure = "time"', 'measure = "tiem"', "time"),
    ('contrast = "view"', 'contrast = "veiw"', "view"),
    ('level = "through"', 'level = "trough"', "through"),
    ('expect = "less"', 'expect = "lses"', "less"),
    ('expect = "less"', 'expect = "equivalent"\nmargin = { tiem = 1.2 }', "time"),
    ('antialiasing = "auto"', 'antialiasing = "atuo"', "auto"),
    ('types = ["table", "lamp", "plant"]', 'types = ["table", "lamp", "palnt"]', "plant"),
]  # fmt: skip


def test_without_a_misspelling_nothing_is_said(tmp_path):
    (tmp_path / "own.toml").write_text(STUDY, "utf-8")
    assert cli.main(["check", str(tmp_path / "own.toml"), "--config-only"]) == 0


@pytest.mark.parametrize(("old", "new", "wanted"), MISSPELT, ids=[m[1] for m in MISSPELT])
def test_the_nearest_of_what_there_is_is_named(tmp_path, capsys, old, new, wanted):
    text = STUDY.replace(old, new, 1)
    assert text != STUDY
    (tmp_path / "own.toml").write_text(text, "utf-8")
    assert cli.main(["check", str(tmp_path / "own.toml"), "--config-only"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert any(f", did you mean {wanted}?" in line for line in lines), lines


COMMANDS = [
    (["chekc", "x"], "check"),
    (["check", "publishd"], "published"),
    (["keys", "desing"], "design"),
    (["task", "check", "cuont"], "count"),
    (["technique", "check", "dynamik"], "dynamic"),
    (["simulate", "demo", "--profile", "carefull", "--out", "data"], "careful"),
    (["new", "tsak", "mine", "x"], "task"),
    (["export", "x", "--format", "wdie"], "wide"),
]


@pytest.mark.parametrize(("words", "wanted"), COMMANDS, ids=[" ".join(c[0]) for c in COMMANDS])
def test_commands_name_it_too(tmp_path, monkeypatch, capsys, words, wanted):
    monkeypatch.chdir(tmp_path)
    try:
        assert cli.main(words) == 2
    except SystemExit as error:  # argparse's own
        assert error.code == 2
    assert f", did you mean {wanted}?" in capsys.readouterr().err


def test_what_is_like_nothing_is_not_guessed():
    assert nearest("xyzzy", ("count", "locate")) == ""
    assert meant(3, ("count",)) == meant("count", ("count",)) == ""
    assert meant(["count", "lokate"], ("count", "locate")) == ", did you mean locate?"
    assert nearest("COUNT", ("count",)) == "count" and nearest("x" * 10**6, ("count",)) == ""
