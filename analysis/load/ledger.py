"""The ledger of slots, held against the folders: who is complete there has to be complete here.

Only the SQLite file in the data folder is read, as a copy, so that no station that uses it is
disturbed and the folder stays as it is. A ledger in a database is not asked: a report is made on
machines that have no password of it (`seethrough status` compares it).
"""

from __future__ import annotations

import csv
import os
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.files import is_there, read_bytes, read_text
from seethrough.analysis.load.person import Person

FILE, POINTER, WITHDRAWN = "ledger.sqlite", "ledger.url", "withdrawn.csv"
TABLE = "seethrough_entries"
COMPLETE = ("complete", "surplus")  # who has a slot's whole session, be the slot theirs or not
TRIES = 5  # a copy taken while a station writes may be torn


@dataclass(frozen=True, slots=True)
class Ledger:
    """`entries`: participant → status, None where the ledger is not in this folder; `where`."""

    where: str
    entries: Mapping[str, str] | None

    def said(self) -> str:
        """What the ledger lets be known, as a sentence."""
        if self.entries is None:
            known = f"The ledger is kept at {self.where} and was not asked" if self.where else (
                "There is no ledger in this folder"
            )  # fmt: skip
            return (
                f"{known}: it cannot be known from here whether whole participants were removed, "
                "or whether a session without an end file had one."
            )
        done = sum(status in COMPLETE for status in self.entries.values())
        return f"The ledger agrees: {done} complete there, all of them complete here."


NO_LEDGER = Ledger("", None)


def read_ledger(data: Path) -> Ledger:
    """The data folder's ledger. Raises DataError for one that is there but cannot be read."""
    if is_there(data / POINTER):
        text = read_bytes(data / POINTER, data).decode("utf-8", "replace").strip()
        if not text.startswith("postgresql://"):
            raise DataError(f"{POINTER}: {text[:60]!r}: expected postgresql://USER@HOST/DATABASE")
        return Ledger(text, None)
    if not is_there(data / FILE):
        return NO_LEDGER
    for left in reversed(range(TRIES)):
        try:
            return Ledger(FILE, _entries(data))
        except sqlite3.Error as error:
            if not left:
                raise DataError(f"{FILE}: cannot be read as a ledger: {error}") from None
    raise AssertionError  # the last try returned or raised


def _entries(data: Path) -> dict[str, str]:
    """Participant → status. Raises sqlite3.Error."""
    with tempfile.TemporaryDirectory() as place:
        copy = Path(place) / FILE
        for end in ("", "-wal"):
            path = data / f"{FILE}{end}"
            if end == "" or is_there(path):
                read_bytes(path, data)[:0]  # a file, and one that may be read
                shutil.copyfile(path, f"{copy}{end}")
        os.chmod(copy, 0o600)
        with closing(sqlite3.connect(copy)) as file:
            for (said,) in file.execute("PRAGMA integrity_check"):
                if said != "ok":
                    raise sqlite3.DatabaseError(said)
            return {str(p): str(s) for p, s in
                    file.execute(f"SELECT participant, status FROM {TABLE}")}  # fmt: skip


def withdrawn_rows(data: Path) -> list[list[str]]:
    """Rows of participant, slot and date, of who was withdrawn. Raises DataError."""
    if not is_there(data / WITHDRAWN):
        return []
    rows = list(csv.reader(read_text(data / WITHDRAWN, data).splitlines()))[1:]
    if any(len(row) != 3 for row in rows):
        raise DataError(f"{WITHDRAWN}: expected participant, slot and date in each row")
    return rows


def come_back(data: Path, people: Sequence[Person]) -> Iterator[str]:
    """Whose data are there though they were withdrawn: put back from a copy, or never removed."""
    there = {person.name for person in people if person.sessions}
    for name, _, when in withdrawn_rows(data):
        if name in there:
            yield (
                f"{name}: withdrawn ({when[:10]}), but with files: expected none "
                f"(`seethrough withdraw DATA --participant {name}` removes them)"
            )


def differences(entries: Mapping[str, str], people: Sequence[Person]) -> Iterator[str]:
    """What ledger and folders say of one another, both ways."""
    there = {person.name: person for person in people}
    for name, status in sorted(entries.items()):
        if status not in COMPLETE:
            continue
        person = there.get(name)
        if person is None or not person.sessions:
            yield f"{name}: {status} in the ledger, but without files: the folder was removed"
        elif not person.complete and not person.problems:
            yield (
                f"{name}: {status} in the ledger, but no end file says so: "
                f"expected one ({person.sessions[-1].stem}_end.json), or the last session's files"
            )
    for name, person in sorted(there.items()):
        if name not in entries and person.sessions:
            yield (
                f"{name}: not in the ledger: the folder was added, or the ledger lost "
                "(`seethrough status` enters who is missing there)"
            )
