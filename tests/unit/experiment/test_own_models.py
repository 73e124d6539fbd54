"""Models that a study brings along: read, named, hashed, kept with the data, found there again."""

import re
import shutil

import numpy as np
import pytest

from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.beside.own_model_files import keep, kept
from seethrough.experiment.study.config import load, parse
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.tasks.catalog import TASKS

WEDGE = """
v 0 0 0
v 4 0 0
v 0 2 0
v 0 0 1
v 4 0 1
v 0 2 1
f 1 3 2
f 4 5 6
f 1 2 5
f 1 5 4
f 1 4 6
f 1 6 3
f 2 3 6
f 2 6 5
"""
STUDY = """
[study]
name = "own"
title = "Own models"
description = "A wedge among cats and dogs."
participants = 4
seed = 3
[design]
tasks = ["unique", "count_in_building"]
[factors.transparency]
levels.standard = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[world.building]
grid = 6
objects = 8
count = [1, 3]
types = ["wedge of wood", "cat", "dog"]
[[world.building.models]]
name = "wedge of wood"
file = "models/wedge.obj"
size = 2.0
[world]
use = "building"
[questions] # in this order
ratings = { when = "end", each = ["transparency"] }
comparison = { when = "end", of = "transparency" }
remarks = { when = "end" }
"""


def written(folder, model=WEDGE, study=STUDY):
    (folder / "models").mkdir(parents=True)
    (folder / "models" / "wedge.obj").write_text(model)
    (folder / "own.toml").write_text(study)
    return folder / "own.toml"


def buildings(study):
    """The scenes of the first session."""
    scenes = StudyScenes(study)
    for task_set in session_for(1, study.plan):
        for trial in task_set.trials:
            yield scenes.begin(TASKS[trial.task], trial, 4 / 3).building


def test_the_model_stands_in_the_buildings_and_is_asked_for(tmp_path):
    study = load(str(written(tmp_path)))
    asked, seen = set(), 0
    for building in buildings(study):
        asked.add(building.asked)
        things = [o for o in building.scene.objects if o.kind == "wedge of wood"]
        seen += len(things)
        for thing in things:
            np.testing.assert_allclose(np.ptp(thing.mesh.vertices, axis=0), [2, 1, 0.5])
    assert "wedge of wood" in asked and seen > 4


def test_the_digest_follows_the_files_bytes_and_not_its_place(tmp_path):
    one = load(str(written(tmp_path / "a")))
    two = load(str(written(tmp_path / "b")))
    other = load(str(written(tmp_path / "c", WEDGE + "# a comment\n")))
    assert one.digest() == two.digest() != other.digest()
    (model,) = one.resolved()["world"]["building"]["models"]
    assert len(model["sha256"]) == 64 and str(tmp_path) not in str(one.resolved())


def test_replay_needs_the_data_folder_alone(tmp_path):
    study = load(str(written(tmp_path / "lab")))
    keep(study, tmp_path / "data")
    keep(study, tmp_path / "data")  # the next participant
    shutil.rmtree(tmp_path / "lab")
    again = parse(study.resolved(), "sidecar")
    again = again.with_places(lambda place: kept(place, tmp_path / "data"))
    assert again.digest() == study.digest()
    for old, new in zip(buildings(study), buildings(again), strict=True):
        for a, b in zip(old.scene.objects, new.scene.objects, strict=True):
            np.testing.assert_array_equal(a.transform, b.transform)
            for name in ("vertices", "normals", "colors", "triangles"):
                np.testing.assert_array_equal(getattr(a.mesh, name), getattr(b.mesh, name))


def test_a_model_that_was_not_kept_or_is_damaged_is_one_line(tmp_path):
    study = load(str(written(tmp_path / "lab")))
    plain = parse(study.resolved(), "sidecar")
    with pytest.raises(InputError, match=r"\.npz: expected the model 'wedge of wood' as it was"):
        plain.with_places(lambda place: kept(place, tmp_path / "data"))
    keep(study, tmp_path / "data")
    (file,) = tmp_path.rglob("*.npz")
    file.write_bytes(file.read_bytes()[:100])
    with pytest.raises(InputError, match=r"^[^\n]*\.npz: not a kept model: [^\n]*$"):
        plain.with_places(lambda place: kept(place, tmp_path / "data"))


BAD = [
    ("", r"0 bytes: expected a model, the file is empty"),
    ("only words", r"0 triangles: expected a mesh"),
    ("v 0 0 0\nv nan 1 0\nv 0 1 0\nf 1 2 3\n", r"vertex \d+ = \(nan, 1, 0\): expected finite coo"),
    ("v 0 0 0\nf 1 1 1\n", r"0 triangles"),
]


@pytest.mark.parametrize(("model", "reason"), BAD)
def test_a_file_that_is_no_model_is_named_with_its_key(tmp_path, model, reason, capsys):
    path = written(tmp_path, model)
    assert cli.main(["check", str(path), "--config-only"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    with pytest.raises(InputError, match=r"models\[0\]\.file = 'models/wedge\.obj': " + reason):
        load(str(path))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("wedge.obj", "wedge.txt", r"file = 'models/wedge\.txt': expected a model file, one of"),
        ("wedge.obj", "no.obj", r"file = 'models/no\.obj': expected a model file, there is none"),
        ('"wedge of wood"\nfile', '"cat"\nfile', r"name = \"cat\": expected a name that no other"),
        ('"wedge of wood"\nfile', '""\nfile', r"name = \"\": expected 1 to 32 printable"),
        (
            'file = "models/wedge.obj"',
            "",
            r"models\[0\]\.file: missing, expected the name of a file",
        ),
        ("size = 2.0", "size = 0.0", r"models\[0\]\.size = 0\.0: expected a number from 0\.01"),
        ("size = 2.0", 'up = "x"', r"models\[0\]\.up = \"x\": expected one of \"y\", \"z\""),
        ("size = 2.0", 'sha256 = "00"', r"is another file now than the study began with"),
        ("size = 2.0", "colour = 3", r"models\[0\]\.colour = 3: unknown key; known: name, file"),
        ('["wedge of wood", "cat"', '["wedge", "cat"', r"types = \[\"wedge\"\]: expected three or"),
    ],
)
def test_what_is_wrong_with_the_entry_is_named(tmp_path, old, new, message):
    assert old in STUDY
    path = written(tmp_path, study=STUDY.replace(old, new))
    with pytest.raises(InputError) as caught:
        load(str(path))
    assert re.search(rf"^\S*own\.toml: world\.building\..*{message}", caught.value.lines[0])


def test_check_lists_the_models(tmp_path, capsys):
    assert cli.main(["check", str(written(tmp_path)), "--config-only"]) == 0
    assert "model       wedge of wood: models/wedge.obj, 8 triangles, " in capsys.readouterr().out


def test_check_puts_a_picture_of_each_model_into_a_sheet(tmp_path):
    from PIL import Image

    from seethrough.experiment.display.driver import open_context
    from seethrough.experiment.study.checked.contact_sheet import write

    study, sheet = load(str(written(tmp_path))), tmp_path / "own-models.png"
    context = open_context()
    write(study, context, sheet)
    write(study, context, sheet)  # its own is made anew
    with Image.open(sheet) as picture:
        seen = np.asarray(picture.convert("RGB"))
    for column in range(5):  # the wedge, in each view
        tile = seen[30:270, 10 + 250 * column : 250 + 250 * column]
        assert 0.1 < (tile < 230).all(axis=2).mean() < 0.8
    assert (seen[:, 1260:] < 100).any()  # what there is to know
    sheet.write_bytes(b"somebody's")
    with pytest.raises(InputError, match=r"exists already and is no contact sheet"):
        write(study, context, sheet)
    assert sheet.read_bytes() == b"somebody's"
    sheet.unlink()
    sheet.symlink_to(tmp_path / "elsewhere.png")
    with pytest.raises(InputError, match=r"exists already and is no contact sheet"):
        write(study, context, sheet)
    assert not (tmp_path / "elsewhere.png").exists()
