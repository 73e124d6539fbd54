"""Flipped bits in a ledger: one line, or the same answers as before. Never silently others.

By hand: `python tests/hard/test_damaged_ledger.py COUNT SEED FOLDER`; CI runs some of it.
"""

import collections
import os
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan

NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
LATER = NOW + timedelta(hours=3)
PLAN = Plan("t", "d" * 64, 4, 24, 7200.0, {"study": {"name": "t"}})
SOME = 60


def made(folder):
    """A ledger with something of everything, and its bytes."""
    with Ledger.open(folder, "", PLAN, NOW) as ledger:
        for number in range(14):
            ledger.reserve(None, NOW + timedelta(minutes=number))
        for name in ("P01", "P02", "P05"):
            ledger.complete(name, NOW)
        ledger.void("P03", "withdrawn: by mail", NOW)
    assert [p.name for p in folder.iterdir()] == ["ledger.sqlite"]
    return (folder / "ledger.sqlite").read_bytes()


def answers(folder):
    """What the ledger says, opened in both ways, and what it does next."""
    with Ledger.existing(folder) as ledger:
        said = [ledger.plan, ledger.entries(), ledger.upcoming(LATER), ledger.stale(LATER)]
    with Ledger.open(folder, "", PLAN, LATER) as ledger:
        said += [ledger.reserve(None, LATER), ledger.reserve("P04", LATER)]
        said += [ledger.complete("P06", LATER), ledger.entries()]
    return said


def flipped(data, count, seed, folder):
    """Flip one bit each time: how often it was refused, and how often nothing came of it."""
    place = folder / "ledger.sqlite"
    write(place, data)
    right = answers(folder)
    rng, seen = np.random.default_rng(seed), collections.Counter()
    for _ in range(count):
        at, bit = int(rng.integers(len(data))), int(rng.integers(8))
        damaged = bytearray(data)
        damaged[at] ^= 1 << bit
        write(place, bytes(damaged))
        try:
            found = answers(folder)
        except InputError as error:
            assert "\n" not in str(error) and "ledger" in str(error), (at, bit, error)
            seen["refused"] += 1
        else:
            assert found == right, (at, bit)
            seen["no difference"] += 1
    return seen


def write(place, data):
    for path in place.parent.iterdir():
        os.unlink(path)
    place.write_bytes(data)


def test_a_flipped_bit_is_refused_in_one_line_or_changes_nothing(tmp_path):
    seen = flipped(made(tmp_path), SOME, 11, tmp_path)
    assert seen["refused"] >= SOME // 10 and sum(seen.values()) == SOME


def test_a_row_that_was_changed_is_named_where_no_page_is_broken(tmp_path):
    data = made(tmp_path)
    place = tmp_path / "ledger.sqlite"
    for old, new, named in [
        (b"withdrawn: by mail", b"withdrawn: by nail", "participant = 'P03'"),
        (b"2026-01-02T03:05:05.000Z2026", b"2026-01-02T03:05:05.000Z2016", "participant = 'P02'"),
    ]:
        assert data.count(old) == 1
        write(place, data.replace(old, new))
        try:
            answers(tmp_path)
        except InputError as error:
            assert named in str(error)
        else:
            raise AssertionError(f"{new} was believed")


if __name__ == "__main__":
    where = Path(sys.argv[3])
    where.mkdir(parents=True)
    found = flipped(made(where), int(sys.argv[1]), int(sys.argv[2]), where)
    print(f"{sys.argv[1]} bits flipped: {dict(found)}")
