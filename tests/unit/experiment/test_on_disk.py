"""What was completed is on the disk, its name too, before anything says so."""

import os

import pytest

from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.record.columns import QUESTIONNAIRE
from seethrough.experiment.record.record_files import Table, Traces
from seethrough.renderer.events import KeyPress


@pytest.fixture
def synced(monkeypatch):
    """The paths of what was synced, in order."""
    paths, real = [], os.fsync

    def fsync(file):
        paths.append(os.readlink(f"/proc/self/fd/{file}"))
        real(file)

    monkeypatch.setattr(os, "fsync", fsync)
    return paths


def test_a_new_file_and_then_its_name(synced, tmp_path):
    write_new(tmp_path / "a.json", "{}")
    file, folder = synced
    assert file.startswith(str(tmp_path) + "/.") and folder == str(tmp_path)


def test_each_folder_that_is_made(synced, tmp_path):
    make_folder(tmp_path / "a" / "b")
    assert synced == [str(tmp_path), str(tmp_path / "a")]
    make_folder(tmp_path / "a" / "b")
    assert len(synced) == 2


def test_each_row(synced, tmp_path):
    table = Table(tmp_path / "a.csv", QUESTIONNAIRE)
    for number in range(3):
        del synced[:]
        table.append({"item": "ease", "value": str(number)})
        assert synced == [str(tmp_path / "a.csv")]
    table.close()


def test_a_trials_traces_and_then_their_names(synced, tmp_path):
    traces = Traces(tmp_path, "session-1_trial-001")
    traces.event(KeyPress(1.0, "a"))
    traces.close()
    names = [str(tmp_path / f"session-1_trial-001_{kind}.csv") for kind in ("events", "camera")]
    assert synced == [*names, str(tmp_path)]
