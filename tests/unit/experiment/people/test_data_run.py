"""A run of data mode before anybody plays: what it needs, what it refuses, in a line each."""

from dataclasses import replace

import pytest

from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.runs import data_run
from seethrough.experiment.people.runs.batch import Batch
from seethrough.experiment.people.runs.batch_files import Results, render
from seethrough.experiment.people.runs.data_mode import Played
from seethrough.experiment.study.config import load

OWN = """
[study]
name = "own"
title = "Own models"
description = "A thing of one's own."
participants = 2
seed = 3
[design]
tasks = ["unique"]
[factors.transparency]
levels.standard = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[[world.building.models]]
name = "wedge"
file = "wedge.obj"
[world]
use = "building"
[questions] # in this order
ratings = { when = "end", each = ["transparency"] }
comparison = { when = "end", of = "transparency" }
remarks = { when = "end" }
"""
WEDGE = "v 0 0 0\nv 4 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def simulate(*words):
    return cli.main(["simulate", "demo", "--mode", "data", "--participants", "1", *map(str, words)])


def test_a_finished_run_makes_no_tables(tmp_path, monkeypatch):
    job, study = Batch("demo", 1, 2, tmp_path / "t.db"), load("demo")
    about = job.about(study)
    with Results(tmp_path / "out", study, about) as results:
        people = [Played("demo", "S01", 1, status="complete")]
        results.add(render(about, study, (1,), people))
    monkeypatch.setattr(data_run, "make_tables", lambda *_: pytest.fail("made tables"))
    data_run.run(job, tmp_path / "out", 1)
    assert not job.tables.exists()
    with pytest.raises(InputError, match=r"with another code: [0-9a-f]{12}, expected 0123456789ab"):
        data_run.run(replace(job, code="0123456789ab"), tmp_path / "out", 1)


@pytest.mark.parametrize("workers", ["1", "2"])
@pytest.mark.parametrize("content", [b"# Read me\n", b"SQLite format 3\0half", b"PK\x03\x04" * 999])
def test_a_file_that_is_no_tables_is_refused_in_a_line(tmp_path, capsys, content, workers):
    path = tmp_path / "README.md"
    path.write_bytes(content)
    before = path.read_bytes()
    words = ["--tables", path, "--out", tmp_path / "out", "--workers", workers]
    assert simulate(*words) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if "simulating: " not in line]
    assert told == [
        f"seethrough: {path}: expected a file of visibility tables: it is none, or not whole"
    ]
    assert path.read_bytes() == before


def test_the_folder_one_is_in_has_a_name_for_its_tables(tmp_path, monkeypatch):
    runs = []
    monkeypatch.setattr(data_run, "run", lambda job, *_: runs.append(job))
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert simulate("--out", ".") == simulate("--out", tmp_path / "there") == 0
    assert [job.tables.name for job in runs] == ["here-tables.db", "there-tables.db"]
    assert {job.tables.parent for job in runs} == {tmp_path}


def test_own_models_and_a_cluster_are_refused_in_a_line(tmp_path, capsys):
    (tmp_path / "own.toml").write_text(OWN)
    (tmp_path / "wedge.obj").write_text(WEDGE)
    words = ["simulate", str(tmp_path / "own.toml"), "--mode", "data", "--out", str(tmp_path / "o")]
    assert cli.main([*words, "--scheduler", "tcp://127.0.0.1:1"]) == 2
    told = capsys.readouterr().err
    line = f"seethrough: {tmp_path / 'own.toml'}: world.building.models = ['wedge']: expected none"
    assert told.startswith(line) and told.count("\n") == 1
    assert not (tmp_path / "o").exists()


def test_tables_are_made_once_and_again_where_that_was_interrupted(tmp_path, monkeypatch):
    job = Batch("demo", 1, 2, tmp_path / "t.db")
    made = []

    def fill(job, progress):
        made.append(job.pool)
        if len(made) == 1:
            raise KeyboardInterrupt

    monkeypatch.setattr(data_run.b, "fill", fill)
    monkeypatch.setattr(data_run.b, "play_chunk", made.append)
    monkeypatch.setattr(data_run.b, "keep_tables", lambda: None)
    with pytest.raises(KeyboardInterrupt):
        data_run.make_tables(job, 1)
    assert data_run.make_tables(job, 2) and made == [2, 2, [1], [2]]
    assert not data_run.make_tables(job, 2) and not data_run.make_tables(job, 1)
    assert data_run.make_tables(replace(job, pool=3), 1) and made[4:] == [3, [1]]
