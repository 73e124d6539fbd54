"""Scenes, tags and items that cannot be: one line each, with file, key, value and what was
expected, and exit status 2."""

import json
import struct

import numpy as np
import pytest
from scene_files import file_of

from seethrough.experiment import cli
from seethrough.experiment.study.config import load

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
[technique]
use = "standard"
[world]
use = "scene"
[world.scene]
files = ["engine.glb"]
{scene}
[task.locate]
{task}
[design]
tasks = [{tasks}]
trials = 1
[practice]
trials = 0
"""


def engine(nodes=NODES, **more):
    return file_of(nodes, range(len(nodes)), cameras=CAMERAS, **more)


def said(tmp_path, capsys, scene="", data=None, task="", tasks='"locate"', old=None, new=None):
    """What `check` says of the study, every line."""
    if data is not None:
        (tmp_path / "engine.glb").write_bytes(data)
    text = STUDY.format(scene=scene, task=task, tasks=tasks)
    (tmp_path / "own.toml").write_text(text.replace(old, new) if old else text, "utf-8")
    capsys.readouterr()
    status = cli.main(["check", str(tmp_path / "own.toml"), "--config-only"])
    lines = capsys.readouterr().err.splitlines()
    assert (status, bool(lines)) in ((0, False), (2, True))
    assert not any("Traceback" in line for line in lines)
    return [line.partition("own.toml: ")[2] for line in lines]


def test_a_study_in_a_scene_is_fine(tmp_path, capsys):
    assert said(tmp_path, capsys, data=engine()) == []


@pytest.mark.parametrize(
    ("scene", "line"),
    [
        ("up = 'x'", 'world.scene.up = "x": expected one of "y", "z"'),
        ("unit = 0", "world.scene.unit = 0.0: expected a number from 1e-06 to 1000000"),
        ("move = 'fly'", 'world.scene.move = "fly": expected one of "orbit", "walk", "fixed"'),
        ("scenes = 'own'", 'world.scene.scenes = "own": expected one of "files"'),
        ("start = 'door'", 'world.scene.start = "door": expected a camera of engine.glb'),
        ("about = 'door'", 'world.scene.about = "door": expected a name in engine.glb'),
        ("detail = -1", "world.scene.detail = -1: expected a whole number from 0 to 250000"),
        ("speed = nan", "world.scene.speed = nan: expected a number from 0.01 to 1000"),
        ("tags = 3", "world.scene.tags = 3: expected an array of tables"),
        ("tags = [3]", "world.scene.tags[0] = 3: expected a table"),
        ("tags = [{ target = true }]", "world.scene.tags[0].name: missing, expected text"),
        ("tags = [{ name = 'pmup', target = true }]",
         'world.scene.tags[0].name = "pmup": expected a thing, did you mean pump?'),
        ("tags = [{ name = 'pump', target = 'yes' }]",
         'world.scene.tags[0].target = "yes": expected true or false'),
        ("tags = [{ name = 'pump', importance = 2 }]",
         "world.scene.tags[0].importance = 2.0: expected a number from 0 to 1"),
        ("tags = [{ name = 'pump', target = true, occluder = true }]",
         "world.scene.tags[0].occluder = true: expected no occluder that is a target"),
        ("tags = [{ name = 'pump', colour = 'red' }]",
         'world.scene.tags[0].colour = "red": unknown key; known: name, target, occluder, wall'),
        ("items = [{ ask = 'pmup' }]",
         'world.scene.items[0].ask = "pmup": expected a thing of engine.glb, did you mean pump?'),
        ("items = [{ ask = 'hull' }]",
         'world.scene.items[0].ask = "hull": expected a target: tag it with target = true'),
        ("items = [{ ask = 'pump', start = 'here' }]",
         'world.scene.items[0].start = "here": expected a camera of engine.glb'),
        ("items = [{ ask = 'pump', file = 'other.glb' }]",
         'world.scene.items[0].file = "other.glb": expected one of engine.glb'),
        ("sha256 = ['00']", 'world.scene.sha256 = ["00"]: expected an array of 64'),
    ],
)  # fmt: skip
def test_every_key_of_a_scene_has_its_line(tmp_path, capsys, scene, line):
    (found,) = said(tmp_path, capsys, scene, engine())
    assert found.startswith(line)


@pytest.mark.parametrize(
    ("files", "line"),
    [
        ("[]", "world.scene.files = []: expected an array of files beside the study"),
        ('["engine"]', 'world.scene.files = ["engine"]: expected an array of files'),
        ('["jeep", "jeep"]', 'world.scene.files = ["jeep", "jeep"]: expected an array of files'),
        ('["none.glb"]', 'world.scene.files[0] = "none.glb": expected a model file, there is none'),
        (
            '["../engine.glb"]',
            'world.scene.files[0] = "../engine.glb": expected a file: not a file',
        ),
        ('["/etc/passwd.glb"]', 'world.scene.files[0] = "/etc/passwd.glb": expected a file: not'),
        ('"jeep"', 'world.scene.files = "jeep": expected an array of files beside the study'),
    ],
)
def test_files_that_cannot_be(tmp_path, capsys, files, line):
    (found,) = said(tmp_path, capsys, data=engine(), old='["engine.glb"]', new=files)
    assert found.startswith(line)


def changed(**changes):
    """The file with other nodes, or other rows of its tables."""
    nodes = json.loads(json.dumps(NODES))
    for place, value in changes.items():
        index, key = place.split("_", 1)
        nodes[int(index[1:])][key] = value
    return engine(nodes)


def with_position(value):
    """One coordinate is no number."""
    data = bytearray(engine())
    at = data.index(struct.pack("<f", 2.0))
    data[at : at + 4] = struct.pack("<f", value)
    return bytes(data)


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"", "0 bytes: expected a model, the file is empty"),
        (b"glTF", "expected a GLB file, it cannot be read"),
        (engine()[:-30], "the file is cut off"),
        (b"\0" * 5000, "expected a GLB file, it cannot be read"),
        (with_position(np.nan), "meshes[0]: vertex 2 = (0, nan, 0): expected finite"),
        (with_position(np.inf), "meshes[0]: vertex 2 = (0, inf, 0): expected finite"),
        (with_position(1e35), "expected smaller than 1e+30 coordinates"),
        (changed(n1_scale=[0, 1, 1]), "nodes[1]: scaled flat: expected a thing with an extent"),
        (changed(n1_translation=[1, 2]), "nodes[1].translation = [1, 2]: expected 3 numbers"),
        (changed(n1_mesh=7), "meshes[7] of 1: expected one the file has"),
        (changed(n1_children=[1]), "is part of the scene twice: expected a tree"),
        (changed(n1_name=3), "nodes[1].name = '3': expected a printable text"),
        (changed(n1_extras={"target": "yes"}), "pump: extras.target = 'yes': expected true or"),
        (changed(n1_extras={"importance": 7}), "pump: extras.importance = '7': expected a number"),
        (changed(n1_extras={"group": 3}), "pump: extras.group = '3': expected text"),
        (changed(n3_scale=[-1, 1, 1]), "nodes[3]: a mirrored or flat camera"),
        (file_of([{"name": "empty"}]), "0 triangles: expected a mesh"),
        (file_of(NODES, range(4), cameras=[{"type": "perspective", "perspective": {"yfov": 9}}]),
         "cameras[0].perspective.yfov = 9: expected an angle"),
    ],
)  # fmt: skip
def test_files_that_hold_what_cannot_be(tmp_path, capsys, data, line):
    """Empty, cut off, not finite, and whatever tags an editor wrote."""
    (found,) = said(tmp_path, capsys, data=data)
    assert found.startswith('world.scene.files[0] = "engine.glb": ')
    assert line in found


def test_every_byte_that_is_missing_is_noticed(tmp_path, capsys):
    """A file cut anywhere is refused in a line, never shown in part."""
    whole = engine()
    for length in np.random.default_rng(1).integers(1, len(whole) - 1, 12):
        (found,) = said(tmp_path, capsys, data=whole[: int(length)])
        assert found.startswith('world.scene.files[0] = "engine.glb": ')


def test_all_that_is_wrong_is_said_at_once(tmp_path, capsys):
    scene = "start = 'door'\ntags = [{ name = 'a' }, { name = 'b' }]\nitems = [{ ask = 'c' }]"
    found = said(tmp_path, capsys, scene, engine())
    keys = [line.split(" = ")[0].removeprefix("world.scene.") for line in found]
    assert keys == ["tags[0].name", "tags[1].name", "start", "items[0].ask"]


def test_tasks_are_refused_by_name_where_the_world_does_not_suit_them(tmp_path, capsys):
    (found,) = said(tmp_path, capsys, data=engine(), tasks='"count"')
    assert found.startswith('design.tasks[0] = "count": expected a task of the world scene: ')
    assert "locate" in found and "unique" not in found
    (found,) = said(tmp_path, capsys, data=engine(), old='use = "scene"', new='use = "abstract"')
    assert found.startswith('design.tasks[0] = "locate": expected a task of the world abstract: ')


def test_too_few_targets_or_items_are_refused_with_the_number(tmp_path, capsys):
    none = engine([{**node, "extras": {}} for node in NODES])
    (found,) = said(tmp_path, capsys, data=none)
    assert found == (
        "world.scene.files[0]: expected 1 or more targets for locate, there are 0: tag things with "
        "target = true"
    )
    (found,) = said(tmp_path, capsys, data=engine(), old="trials = 1", new="trials = 3")
    assert found.startswith("design.trials: locate takes 3 items, 3 (trials and practice) in each")
    assert found.endswith("there are 2")


def test_a_file_that_was_changed_since_is_refused(tmp_path, capsys):
    """A sidecar's hash holds for the file, too."""
    (tmp_path / "engine.glb").write_bytes(engine())
    (tmp_path / "own.toml").write_text(STUDY.format(scene="", task="", tasks='"locate"'), "utf-8")
    (place,) = load(str(tmp_path / "own.toml")).places()
    assert len(place.sha256) == 1
    before = load(str(tmp_path / "own.toml")).digest()
    (tmp_path / "engine.glb").write_bytes(engine([*NODES, {"name": "x", "mesh": 0}]))
    assert load(str(tmp_path / "own.toml")).digest() != before
