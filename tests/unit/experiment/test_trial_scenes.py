"""What `check` says of the scenes that trials are made in, before it looks at any: things of a file
that cannot be told apart, too few targets, and trials that are all the same one."""

import pytest
from scene_files import file_of

from seethrough import registry
from seethrough.experiment import cli
from seethrough.experiment.files import trust

NODES = [
    {"name": "hull", "mesh": 0, "translation": [-5, 0, 0]},
    {"name": "pump", "mesh": 0, "extras": {"target": True}},
    {"name": "valve", "mesh": 0, "translation": [0, 0, 6], "extras": {"target": True}},
    {"name": "stand", "camera": 0, "translation": [0, 3, 20]},
]  # fmt: skip
CAMERAS = [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}]
STUDY = """
[study]
name = "own"
title = "Own scene"
description = "Finding a pump."
participants = 2
seed = 1
[world]
use = "scene"
[world.scene]
files = ["engine.glb"]
{scene}
{more}
[technique]
use = "standard"
[design]
tasks = ["{task}"]
trials = 2
[practice]
trials = 0
"""
OWN = """
from dataclasses import dataclass
from seethrough.api import Basics, Outcome, Strategy, View, measure

@dataclass(frozen=True, eq=False)
class State:
    place: object
    viewer: object

class Look(Basics):
    name, code, source, least = "look", "LK", "mine", 1
    worlds, measures = ("scene", "abstract"), (measure.CORRECT,)
    simulate = Strategy(print)

    def begin(self, made, setting, aspect):
        return State(made, setting.world.viewer(made, setting.place, aspect))

    def on_event(self, state, event):
        return state

    def view(self, state):
        return View(state.place.scene, state.viewer.camera())

    def outcome(self, state):
        return None

TASK = Look()
"""
LOOK = '[task.look]\nfile = "look.py"\n'


def glb(nodes=NODES):
    return file_of(nodes, range(len(nodes)), cameras=CAMERAS)


@pytest.fixture
def check(tmp_path, monkeypatch, capsys):
    """The lines of `check` about scenes, its errors, and its exit status."""
    monkeypatch.setattr(registry, "_provided", {})
    monkeypatch.setenv(trust.HOME, str(tmp_path / "home"))
    # Whether the toy keeps to its suite is another test's matter.
    where = "seethrough.experiment.study.beside.plugin_files._demand_suite"
    monkeypatch.setattr(where, lambda *_: None)

    def checked(scene="", nodes=NODES, task="locate", more="", own=OWN, change=None):
        (tmp_path / "engine.glb").write_bytes(glb(nodes))
        (tmp_path / "look.py").write_text(own, "utf-8")
        text = STUDY.format(scene=scene, more=more, task=task)
        (tmp_path / "own.toml").write_text(text.replace(*change) if change else text, "utf-8")
        words = ["check", str(tmp_path / "own.toml"), "--config-only", "--trust"]
        status = cli.main(words)
        said = capsys.readouterr()
        lines = [line.split(None, 1)[1] for line in said.out.splitlines() if line[:6] == "scenes"]
        return status, lines, said.err

    checked.folder = tmp_path
    return checked


def test_nothing_is_said_of_scenes_that_are_as_they_should_be(check):
    assert check() == (0, [], "")


def test_targets_of_one_name_are_named(check):
    nodes = [{**NODES[1], "translation": [3, 0, 0]}, *NODES]
    status, lines, _ = check(nodes=nodes)
    assert status == 0
    assert lines[0].startswith("engine.glb: targets of one name: pump (2): WARNING, expected a na")
    # What only hides is never asked for: walls may all be called wall.
    assert check(nodes=[{**NODES[0], "translation": [3, 0, 0]}, *NODES]) == (0, [], "")


def test_an_orbit_about_one_of_two_things_of_a_name_is_refused(check):
    nodes = [{**NODES[0], "translation": [3, 0, 0]}, *NODES]
    status, _, said = check("about = 'hull'", nodes)
    assert status == 2
    assert said.endswith(
        'own.toml: world.scene.about = "hull": expected a name in engine.glb: 2 things have that '
        "name\n"
    )


def test_a_copy_of_a_file_is_refused(check):
    (check.folder / "copy.glb").write_bytes(glb())
    status, _, said = check(change=('["engine.glb"]', '["engine.glb", "copy.glb"]'))
    assert status == 2
    assert said.endswith(
        'own.toml: world.scene.files[1] = "copy.glb": expected a file that differs from engine.glb'
        "\n"
    )


def test_fixed_views_of_a_file_without_cameras_are_warned_of(check):
    status, lines, _ = check("move = 'fixed'", NODES[:3])
    assert status == 0
    (line,) = lines
    assert line.startswith('engine.glb: move = "fixed" without a camera in the file: WARNING, ')
    assert check("move = 'fixed'") == (0, [], "")


def test_a_task_that_draws_nothing_has_one_trial_again_and_again(check):
    status, lines, _ = check(task="look", more=LOOK)
    assert status == 0
    (line,) = lines
    assert line.startswith(
        "look in the world scene: 2 trials of a person, each the same scene and question: WARNING"
    )
    (check.folder / "two.glb").write_bytes(glb(NODES[1:]))
    two = ('["engine.glb"]', '["engine.glb", "two.glb"]')
    assert check(task="look", more=LOOK, change=two) == (0, [], "")


def test_more_targets_than_any_scene_has_are_refused(check):
    """Of files by name and number; of scenes that are made, too, once one is made."""
    many = OWN.replace('least = "look", "LK", "mine", 1', 'least = "look", "LK", "mine", 999')
    status, _, said = check(task="look", more=LOOK, own=many)
    assert status == 2 and "expected 999 or more targets for look, there are 2" in said
    abstract = ('use = "scene"\n[world.scene]\nfiles = ["engine.glb"]', 'use = "abstract"')
    status, lines, _ = check(task="look", more=LOOK, own=many, change=abstract)
    assert status == 1
    (line,) = lines
    assert line.startswith("look in the world abstract: its scenes have ")
    assert ": FAILS, expected 999 or more" in line
    assert check(task="look", more=LOOK, change=abstract) == (0, [], "")
