"""Looks in a file: the same to the last bit, shared by processes, none lost, nothing else read."""

import sqlite3
import subprocess
import sys
from contextlib import closing, suppress

import pytest
from made_looks import random_look, same_look

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.runs import looks as module
from seethrough.experiment.people.runs.looks import KeptLooks

ADDS = """
import sys
from contextlib import closing, suppress
from pathlib import Path
from made_looks import random_look
from seethrough.experiment.people.runs.looks import KeptLooks
looks = KeptLooks(Path(sys.argv[1]))
for k in range(40):
    looks.put("mine" + sys.argv[2], (k, 0), random_look(k))
    looks.put("both", (k, 0), random_look(k))
    looks.flush()
    print(k, flush=True)
"""


def adder(path, name):
    """A process that adds forty looks of its own, and forty that others add as well."""
    return subprocess.Popen(
        [sys.executable, "-c", ADDS, str(path), name],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        env={"PYTHONPATH": ":".join(p for p in sys.path if p)},
    )  # fmt: skip


def test_a_look_comes_back_to_the_last_bit_before_and_after_it_is_written(tmp_path):
    looks = KeptLooks(tmp_path / "t.db")
    for k in range(5):
        looks.put("a-1/standard", (k, -2), random_look(k))
    other = KeptLooks(tmp_path / "t.db")
    with pytest.raises(KeyError, match=r"viewpoint \(0, -2\) is in no table"):
        other.get("a-1/standard", 12, (0, -2))
    assert len(looks.flush()) == 5 and not looks.flush()
    for k in range(5):
        ours, theirs = (store.get("a-1/standard", 12, (k, -2)) for store in (looks, other))
        assert same_look(ours, random_look(k)) and same_look(theirs, random_look(k))
    assert not same_look(ours, random_look(0))
    assert other.keys() == [("a-1/standard", (k, -2)) for k in range(5)]


def test_what_is_there_stays():
    looks = KeptLooks()
    for seed in (1, 2):
        looks.put("a", (0,), random_look(seed))
        looks.flush()
    assert same_look(looks.get("a", 12, (0,)), random_look(1))


def test_only_so_many_looks_are_held(monkeypatch):
    monkeypatch.setattr(module, "MOST_KEPT", 4)
    looks = KeptLooks()
    for k in range(9):
        looks.put("a", (k,), random_look(k))
    looks.flush()
    first = looks.get("a", 12, (0,))
    assert looks.get("a", 12, (0,)) is first
    for k in range(1, 5):
        looks.get("a", 12, (k,))
    again = looks.get("a", 12, (0,))
    assert again is not first and same_look(again, first)


def test_a_file_travels_by_value(tmp_path):
    looks = KeptLooks(tmp_path / "t.db")
    looks.put("a", (3,), random_look(3))
    looks.flush()
    there = KeptLooks(content=looks.whole())
    assert same_look(there.get("a", 12, (3,)), random_look(3))
    there.put("a", (4,), random_look(4))
    looks.add(there.flush())
    assert KeptLooks(tmp_path / "t.db").keys() == [("a", (3,)), ("a", (4,))]


def test_processes_share_a_file_and_one_that_is_killed_loses_only_what_it_had_not_written(tmp_path):
    path = tmp_path / "t.db"
    processes = [adder(path, name) for name in "xyz"]
    try:
        for line in processes[0].stdout:
            if line == "10\n":
                processes[0].kill()
                break
        for process in processes[1:]:
            process.communicate("", timeout=60)
            assert process.returncode == 0
        processes[0].wait()
    finally:
        for process in processes:
            process.kill()
            process.communicate()
    found = KeptLooks(path)
    counts = [
        sum(table == name for table, _ in found.keys()) for name in ("minex", "miney", "both")
    ]
    assert 11 <= counts[0] <= 40 and counts[1:] == [40, 40]
    for table, key in found.keys():
        assert same_look(found.get(table, 12, key), random_look(key[0]))


def test_a_file_that_another_process_begins_meanwhile_is_ours(tmp_path, monkeypatch):
    """It begins it between what is read of it: an empty file's mark, another one's tables."""
    path, begun = tmp_path / "t.db", []

    class Interrupted(sqlite3.Connection):
        def execute(self, command, *values):
            found = super().execute(command, *values).fetchall()
            if command.startswith(("PRAGMA", "SELECT count")) and "=" not in command and not begun:
                begun.append(command)
                with closing(plain(path, timeout=0)) as other, suppress(sqlite3.OperationalError):
                    for step in module._BEGIN:
                        other.execute(step)
            return Found(found)

    class Found(list):
        def fetchone(self):
            return self[0]

        def fetchall(self):
            return self

    plain = sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda *a, **k: plain(*a, **k, factory=Interrupted))
    looks = KeptLooks(path)
    assert begun
    looks.put("a", (1,), random_look(1))
    looks.flush()
    assert looks.keys() == [("a", (1,))]


def test_what_was_filled_is_remembered_with_the_most_walkers(tmp_path):
    looks = KeptLooks(tmp_path / "t.db")
    assert not looks.is_filled("a study", 1)
    for walkers in (16, 128):
        looks.mark_filled("a study", walkers)
    other = KeptLooks(tmp_path / "t.db")
    assert other.is_filled("a study", 16) and other.is_filled("a study", 128)
    assert not other.is_filled("a study", 129) and not other.is_filled("another", 1)


def database(path, *commands):
    """Somebody's SQLite file."""
    with sqlite3.connect(path) as file:
        for command in commands:
            file.execute(command)
    file.close()


def test_another_programs_database_is_refused_and_left_alone(tmp_path):
    path = tmp_path / "t.db"
    database(path, "CREATE TABLE looks (mine)")
    before = path.read_bytes()
    message = f"{path}: expected a file of visibility tables: it is none, or not whole"
    with pytest.raises(InputError) as raised:
        KeptLooks(path)
    assert str(raised.value) == message and path.read_bytes() == before
    path.unlink()
    database(path, "PRAGMA application_id = 7")
    with pytest.raises(InputError, match="it is none"):
        KeptLooks(path)


def test_looks_of_another_version_are_refused_in_a_line_and_left_alone(tmp_path):
    """As version 0.1.0 made them: ours, without a version, and with masks four times too wide."""
    path = tmp_path / "t.db"
    KeptLooks(path).close()
    database(path, "PRAGMA user_version = 0")
    before = path.read_bytes()
    with pytest.raises(InputError) as raised:
        KeptLooks(path)
    assert str(raised.value) == (
        f"{path}: expected a file of visibility tables: another version of Seethrough made it, "
        "whose people saw something else in the same view; remove it, or name another file with "
        "--tables"
    )
    assert path.read_bytes() == before


@pytest.mark.parametrize("row", ["x'00112233'", "'a text'"])
def test_a_row_that_is_no_look_is_one_line(tmp_path, row):
    KeptLooks(tmp_path / "t.db").close()
    database(tmp_path / "t.db", f"INSERT INTO looks VALUES ('a', '0', {row})")
    with pytest.raises(
        InputError, match=r"t\.db: expected a file of visibility tables: it is none"
    ):
        KeptLooks(tmp_path / "t.db").get("a", 12, (0,))


def test_a_file_that_cannot_be_used_says_why(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.1)
    path = tmp_path / "t.db"
    looks = KeptLooks(path)
    held = sqlite3.connect(path, isolation_level=None)
    held.execute("BEGIN EXCLUSIVE")
    with pytest.raises(InputError, match=r"t\.db: expected .* tables: database is locked"):
        looks.is_filled("a", 1)
    held.close()
    with pytest.raises(
        InputError, match=r"t\.db/x: expected .* tables: File exists|Not a directory"
    ):
        KeptLooks(path / "x")


def test_a_file_that_is_there_opens_while_another_process_is_about_to_write(tmp_path, monkeypatch):
    """What a read-only file needs as well: opening asks for no lock to write."""
    monkeypatch.setattr(module, "PATIENCE", 0.1)
    path = tmp_path / "t.db"
    looks = KeptLooks(path)
    looks.put("a", (0,), random_look(0))
    looks.flush()
    held = sqlite3.connect(path, isolation_level=None)
    held.execute("BEGIN IMMEDIATE")
    assert same_look(KeptLooks(path).get("a", 12, (0,)), random_look(0))
    held.close()


def test_tables_that_arrive_broken_are_one_line():
    with pytest.raises(InputError) as raised:
        KeptLooks(content=b"half of a file")
    told = "tables from another machine: expected a file of visibility tables: it is none"
    assert str(raised.value).startswith(told)
