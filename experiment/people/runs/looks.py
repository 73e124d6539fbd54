"""Where looks are kept: a file that many processes read and add to, or memory alone.

A building has more viewpoints than thousands of people leave memory for: looks lie in an SQLite
file, a row for each scene and viewpoint, and only those wanted lately are held. What one process
draws the others find there. A run that is killed loses nothing that was written before.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.errors import InputError
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.kit.skills.sight import Kept, shown

OURS = 0x53656521  # "See!" as SQLite's application id: what tells our files from others
CONTENT = 2  # SQLite's user version: raised when a look of the same view holds something else
MOST_KEPT = 32_768  # looks held, with what people make of them: some 5 KB each
PATIENCE = 60.0  # seconds until another process has written its looks, which takes milliseconds
NUMBERS = 7  # of each visible object: see `sight.shown`

_OLD = "another version of Seethrough made it, whose people saw something else in the same view"

Key = tuple[int, ...]
Rows = Mapping[tuple[str, str], bytes]  # (table, viewpoint) → a look's numbers as the file has them

_BEGIN = (
    "BEGIN IMMEDIATE",
    f"PRAGMA application_id = {OURS}",
    f"PRAGMA user_version = {CONTENT}",
    "CREATE TABLE IF NOT EXISTS looks"
    " (scene TEXT, viewpoint TEXT, shown BLOB NOT NULL, PRIMARY KEY (scene, viewpoint))",
    "CREATE TABLE IF NOT EXISTS filled (what TEXT PRIMARY KEY, walkers INTEGER NOT NULL)",
    "COMMIT",
)


class _OtherVersion(ValueError):
    """The file is ours; what it holds is what another version's eyes saw."""


class KeptLooks:
    """KeptLooks by table and viewpoint, in the file `path` or, without one, in this process alone.

    Fresh ones are written by `flush`. `content` is that of another machine's file (`whole`), in
    the place of a file. Raises InputError for a file that holds something else.
    """

    def __init__(self, path: Path | None = None, content: bytes = b"") -> None:
        self.path = path
        self._fresh: dict[tuple[str, str], bytes] = {}
        with self._speaking():
            self._file = _opened(path, content)
        self.get: Callable[[str, int, Key], Kept] = lru_cache(MOST_KEPT)(self._get)

    def put(self, table: str, key: Key, seen: Visibility) -> None:
        """Keep a look: what `shown` gives of it."""
        self._fresh[table, _name(key)] = shown(seen).tobytes()

    def flush(self) -> Rows:
        """Write what was put since the last call, and tell it. What is there already stays."""
        fresh, self._fresh = self._fresh, {}
        self.add(fresh)
        return fresh

    def add(self, rows: Rows) -> None:
        """Take over what another process has drawn."""
        if rows:
            with self._speaking(), self._file:
                self._file.executemany(
                    "INSERT OR IGNORE INTO looks VALUES (?, ?, ?)",
                    ((*name, row) for name, row in rows.items()),
                )

    def is_filled(self, what: str, walkers: int) -> bool:
        """Whether `mark_filled` was told this, of so many walkers or more."""
        question = "SELECT 1 FROM filled WHERE what = ? AND walkers >= ?"
        return bool(self._all(question, what, walkers))

    def mark_filled(self, what: str, walkers: int) -> None:
        """Remember that all was drawn that so many people look at."""
        with self._speaking(), self._file:
            self._file.execute("INSERT OR REPLACE INTO filled VALUES (?, ?)", (what, walkers))

    def keys(self) -> list[tuple[str, Key]]:
        """Every table and viewpoint, sorted."""
        found = {*self._all("SELECT scene, viewpoint FROM looks"), *self._fresh}
        return sorted((table, tuple(map(int, key.split()))) for table, key in found)

    def whole(self) -> bytes:
        """The file as it is now, for a machine that does not share this one's disk."""
        with self._speaking():
            return self._file.serialize()

    def close(self) -> None:
        """Let the file go."""
        self._file.close()

    def _get(self, table: str, objects: int, key: Key) -> Kept:
        """The look as it was kept, the same to the last bit. Raises KeyError."""
        name = table, _name(key)
        if name in self._fresh:
            return Kept(objects, self._numbers(self._fresh[name]))
        rows = self._all("SELECT shown FROM looks WHERE scene = ? AND viewpoint = ?", *name)
        if not rows:
            raise KeyError(f"viewpoint {key} is in no table")
        return Kept(objects, self._numbers(rows[0][0]))

    def _numbers(self, row: bytes) -> NDArray[np.float64]:
        with self._speaking():
            return np.frombuffer(row).reshape(NUMBERS, -1)

    def _all(self, question: str, *values: object) -> list[tuple[Any, ...]]:
        with self._speaking():
            return self._file.execute(question, values).fetchall()

    @contextmanager
    def _speaking(self) -> Iterator[None]:
        """What SQLite and NumPy say of a file that holds something else, in one line."""
        try:
            yield
        except (sqlite3.Error, OSError, ValueError, TypeError) as error:
            where = self.path or "tables from another machine"
            raise InputError(
                f"{where}: expected a file of visibility tables: {_reason(error)}"
            ) from None


def _opened(path: Path | None, content: bytes) -> sqlite3.Connection:
    if path is not None:
        path.parent.mkdir(parents=True, exist_ok=True)
    file = sqlite3.connect(path or ":memory:", PATIENCE, isolation_level="IMMEDIATE")
    if content:
        file.deserialize(content)
    file.execute("BEGIN")  # all as it is at one moment: another process may just begin the file
    (tables,) = file.execute("SELECT count(*) FROM sqlite_master").fetchone()
    (whose,) = file.execute("PRAGMA application_id").fetchone()
    (version,) = file.execute("PRAGMA user_version").fetchone()
    file.execute("COMMIT")
    if whose == OURS and version != CONTENT:
        raise _OtherVersion(f"{_OLD}; remove it, or name another file with --tables")
    if whose == OURS:  # it may be read-only, and nobody waits for its lock
        return file
    if whose or tables:
        raise ValueError("another program's database")
    for command in _BEGIN:
        file.execute(command)
    return file


def _reason(error: Exception) -> str:
    """An operating system's reason as it is; SQLite's where the file is ours but can't be used."""
    if isinstance(error, sqlite3.OperationalError | _OtherVersion):
        return str(error)  # locked, read-only, disk full
    return getattr(error, "strerror", None) or "it is none, or not whole"


def _name(key: Key) -> str:
    return " ".join(map(str, key))
