"""Disks that fill up, folders that cannot be written, clocks that run back: each is tried.

Every completed trial stays whole, what the experimenter sees is one line, and nothing half-written
is left.
"""

import csv
import errno
import json
import os
import re
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from disks import nobody, small_disk

from seethrough.experiment.errors import InputError
from seethrough.experiment.record.chain import verify
from seethrough.experiment.record.columns import TRIALS, Column
from seethrough.experiment.record.record_files import Table
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.design.design import Trial
from seethrough.tasks.kit.base import Outcome

STEM = "study-test_subject-P01_session-1"

# Records trials until something goes wrong, as a session does; prints the number completed.
SESSION = """
import os, resource, signal, sys
from pathlib import Path
import numpy as np
from seethrough.experiment import cli
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Outcome, View
from seethrough.renderer.events import PointerMove

data, largest, user = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
if user:  # root, whom no permission stops, becomes somebody else
    os.setegid(user)
    os.seteuid(user)
if largest:  # no file may grow past this: what a full disk does, for users who may not mount one
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
view = View(Scene(()), look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3)))

def play(recorder, number):
    trial = Trial(number, 1, 1, number, {}, "count", "stream-1", (1, 1))
    recorder.trial_begins(trial)
    for frame in range(100):
        recorder.event(PointerMove(frame / 60, 0.5, 0.25, 0.125, 0.0, True))
        recorder.frame(frame / 60, view)
    outcome = Outcome("12", "14", False, count_error=-2)
    record = TrialRecord(trial, outcome, 14, 0.0, 2.0, 0.0, False, 60, 0, 0.02, 1.5, 0.25)
    recorder.trial_ends(record)

def session(arguments):
    recorder = FileRecorder(data, Who("test", "P01", "human", 1, {"seed": 3}))
    status = "left"
    try:
        for number in range(1, 400):
            play(recorder, number)
            print(number, flush=True)
        status = "complete"
    finally:
        recorder.close(status)

class Parser:
    def parse_args(self, words):
        import argparse
        return argparse.Namespace(run=session)

cli._parser = lambda words: Parser()  # the command line's own way with errors
sys.exit(cli.main([]))
"""


def record(data, largest=0, user=0):
    command = [sys.executable, "-c", SESSION, data, str(largest), str(user)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def rows(folder):
    path = folder / f"{STEM}_trials_data.csv"
    text = path.read_text("utf-8")
    assert text.endswith("\n")
    with open(path, encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert all(list(row) == [c.name for c in TRIALS] and None not in row.values() for row in table)
    return table


def is_one_line(run, pattern):
    assert run.returncode == 2, run.stderr
    assert re.fullmatch(rf"seethrough: [^\n]*{pattern}[^\n]*\n", run.stderr), run.stderr


# Sizes at which the disk is full in different files: traces, a row, the sidecar, the first folder.
@pytest.mark.parametrize("kilobytes", [2000, 900, 300, 100, 48, 12, 4])
def test_a_full_disk_keeps_every_completed_trial(tmp_path, kilobytes):
    disk = tmp_path / "disk"
    with small_disk(disk, kilobytes) as largest:
        run = record(disk / "study", largest)
        is_one_line(run, r"cannot be written: (No space left on device|File too large)")
        folder = disk / "study" / "data" / "human" / "P01"
        completed = [int(n) for n in run.stdout.split()]
        if (folder / f"{STEM}_trials_data.csv").exists():
            assert [int(r["trial"]) for r in rows(folder)] == completed
            assert verify(folder) == []
        else:
            assert completed == []
        files = [p for p in disk.rglob("*") if p.is_file()]
        assert not [p for p in files if p.name.startswith(".")]  # nothing half-written
        for path in disk.rglob("*.json"):
            json.loads(path.read_text("utf-8"))


def test_a_row_that_does_not_fit_is_taken_back_wherever_the_disk_ends(tmp_path, monkeypatch):
    columns = (Column("text", "text", "text"), Column("chain", "text", "chain"))
    row = {"text": 'a "quoted" text, with\na line'}
    disk, real = {"room": 0}, os.write

    def write(file, data):
        if disk["room"] == 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written = real(file, bytes(data)[: disk["room"]])
        disk["room"] -= written
        return written

    table = Table(tmp_path / "t_data.csv", columns, "start")
    table.append(row)
    before, chain = table.path.read_bytes(), table.chain
    length = len(before) - len("text,chain\n")
    monkeypatch.setattr("seethrough.experiment.files.private.os.write", write)
    for room in range(length):
        disk["room"] = room
        with pytest.raises(InputError, match=r"t_data\.csv: cannot be written: No space left"):
            table.append(row)
        assert (table.path.read_bytes(), table.chain) == (before, chain)
    disk["room"] = length
    table.append(row)  # there is room again
    table.close()
    assert len(table.path.read_bytes()) == len(before) + length


def test_a_folder_in_which_nothing_may_be_made_is_one_line():
    with tempfile.TemporaryDirectory() as made:
        closed = Path(made) / "closed"
        closed.mkdir()
        for folder, mode in ((closed, 0o555), (closed.parent, 0o755)):
            folder.chmod(mode)
        is_one_line(record(closed / "study", user=nobody()), "cannot be written: Permission denied")
        assert list(closed.iterdir()) == []


def test_a_file_in_the_way_is_one_line(tmp_path):
    (tmp_path / "file").write_text("in the way")
    run = record(tmp_path / "file" / "study")
    is_one_line(run, "cannot be written: Not a directory")


def test_everything_a_session_writes_is_the_users_alone(tmp_path):
    old = os.umask(0)
    try:
        record(tmp_path / "study", 60_000)
    finally:
        os.umask(old)
    made = [tmp_path / "study", *(tmp_path / "study").rglob("*")]
    files = {stat.S_IMODE(p.stat().st_mode) for p in made if p.is_file()}
    folders = {stat.S_IMODE(p.stat().st_mode) for p in made if p.is_dir()}
    assert len(made) > 8
    assert (files, folders) == ({0o600}, {0o700})


def test_a_clock_set_back_changes_no_duration_and_breaks_no_chain(tmp_path):
    times = iter(["2026-03-29T03:00:00.000Z", "2026-03-29T02:00:00.000Z", *["1970-01-01"] * 9])
    who = Who("test", "P01", "human", 1, {})
    recorder = FileRecorder(tmp_path, who, now=lambda: next(times))
    trial = Trial(1, 1, 1, 1, {}, "count", "stream-1", (1, 1))
    for _ in range(2):
        recorder.trial_begins(trial)
        outcome = Outcome("12", "14", False, count_error=-2)
        record = TrialRecord(trial, outcome, 14, 5.0, 7.5, 0.0, False, 60, 0, 0.02, 1.5, 0.25)
        recorder.trial_ends(record)
    recorder.close("complete")
    folder = tmp_path / "data" / "human" / "P01"
    assert [(r["time"], r["started"][:4]) for r in rows(folder)] == [
        ("2.5", "2026"),
        ("2.5", "1970"),
    ]
    assert verify(folder) == []
