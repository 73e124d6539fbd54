"""A run of data mode before anybody plays: what it needs, what it refuses, in a line each."""

import os
from dataclasses import replace

import numpy as np
import pytest

from experiment import cli
from experiment.config import load
from experiment.errors import InputError
from experiment.participants import data_run, tables
from experiment.participants.batch import Batch
from experiment.participants.batch_files import Results, render
from experiment.participants.data_mode import Played

OWN = """
[study]
name = "own"
title = "Own models"
description = "A thing of one's own."
participants = 2
seed = 3
[design]
tasks = ["unique"]
[[walkthrough.models]]
name = "wedge"
file = "wedge.obj"
"""
WEDGE = "v 0 0 0\nv 4 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def simulate(*words):
    return cli.main(["simulate", "demo", "--mode", "data", "--participants", "1", *map(str, words)])


def test_a_finished_run_makes_no_tables(tmp_path, monkeypatch):
    job, study = Batch("demo", 1, 2, tmp_path / "t.npz"), load("demo")
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
@pytest.mark.parametrize("content", [b"# Read me\n", b"PK\x03\x04half", b"", "npy", "npz", "rows"])
def test_a_file_that_is_no_tables_is_refused_in_a_line(tmp_path, capsys, content, workers):
    path = tmp_path / "README.md"
    if isinstance(content, bytes):
        path.write_bytes(content)
    with open(path, "ab") as file:
        if content == "npy":
            np.save(file, np.zeros(3))
        if content == "npz":
            np.savez(file, mine=np.zeros(3))
        if content == "rows":
            np.savez(file, **{"a/keys": np.zeros((1, 3), int), "a/widths": np.array([3, 2]),
                              "a/rows": np.zeros((5, 2))})  # fmt: skip
    before = path.read_bytes()
    words = ["--tables", path, "--out", tmp_path / "out", "--workers", workers]
    assert simulate(*words) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if "simulating: " not in line]
    assert told == [
        f"seethrough: {path}: expected a file of visibility tables: it is none, or not whole"
    ]
    assert path.read_bytes() == before


def test_tables_are_saved_under_a_name_of_the_process_and_whole(tmp_path, monkeypatch):
    drafts = []
    real = np.savez

    def savez(file, **arrays):
        drafts.append(os.path.basename(file.name))
        real(file, **arrays)
        if len(drafts) == 2:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", savez)
    tables.save(tmp_path / "t.npz", {"a": tables.Table(3)})
    before = (tmp_path / "t.npz").read_bytes()
    with pytest.raises(OSError, match="No space"):
        tables.save(tmp_path / "t.npz", {"b": tables.Table(3)})
    assert all(str(os.getpid()) in draft for draft in drafts)
    assert [p.name for p in tmp_path.iterdir()] == ["t.npz"]
    assert (tmp_path / "t.npz").read_bytes() == before and set(tables.load(tmp_path / "t.npz"))


def test_the_folder_one_is_in_has_a_name_for_its_tables(tmp_path, monkeypatch):
    runs = []
    monkeypatch.setattr(data_run, "run", lambda job, *_: runs.append(job))
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert simulate("--out", ".") == simulate("--out", tmp_path / "there") == 0
    assert [job.tables.name for job in runs] == ["here-tables.npz", "there-tables.npz"]
    assert {job.tables.parent for job in runs} == {tmp_path}


def test_own_models_and_a_cluster_are_refused_in_a_line(tmp_path, capsys):
    (tmp_path / "own.toml").write_text(OWN)
    (tmp_path / "wedge.obj").write_text(WEDGE)
    words = ["simulate", str(tmp_path / "own.toml"), "--mode", "data", "--out", str(tmp_path / "o")]
    assert cli.main([*words, "--scheduler", "tcp://127.0.0.1:1"]) == 2
    told = capsys.readouterr().err
    line = f"seethrough: {tmp_path / 'own.toml'}: walkthrough.models = ['wedge']: expected none"
    assert told.startswith(line) and told.count("\n") == 1
    assert not (tmp_path / "o").exists()
