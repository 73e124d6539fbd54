"""One participant's files, held against each other: what the sidecars, tables and end files say
must be there is demanded, and nothing else of theirs may be.

A session's sidecar begins its chain, the end file closes it and holds the hashes of what is not in
the rows. The sidecar of a session that goes on holds the last value of the one before and, if that
one was never closed, the hashes of its other files. Data may be handed on without their traces: a
session whose traces folder is gone is verified without them and says so; a single trace that is
missing was removed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeGuard

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.chain import (
    ChainState,
    Table,
    cells_have,
    check_table,
    is_chained,
    seal_of,
)
from seethrough.analysis.load.files import (
    AGAIN,
    Source,
    is_empty,
    is_there,
    named,
    names_in,
    read_bytes,
    read_json,
    sha256_of,
    table_in,
)

TRIALS_TABLE, SIDECAR, END = "_trials_data.csv", "_trials_data.json", "_end.json"
ANSWERS_TABLE, NOTES_TABLE = "_questionnaire_data.csv", "_notes_data.csv"
REPAIR = "_repair.json"  # put there by `seethrough repair`, beside the session that was kept whole
KINDS = (TRIALS_TABLE, SIDECAR, END, ANSWERS_TABLE, NOTES_TABLE)
TRACES = "traces"
COMPLETE = "complete"
CHUNK = re.compile(r"S\d{5,}-S\d{5,}")  # data mode's folder of sixteen: whole, or not there
_PAIRS = (("events_file", "events_sha256"), ("camera_file", "camera_sha256"))
_HEX = re.compile(r"[0-9a-f]{64}")


@dataclass(slots=True)
class Session:
    """One session's files; `status` as its end file says, "" where there is none."""

    stem: str
    number: int
    files: Mapping[str, str]
    table: Source | None = None
    answers: Source | None = None
    notes: Source | None = None
    sidecar: Mapping[str, object] | None = None
    status: str = ""
    chain: ChainState | None = None
    traces: tuple[str, ...] = ()

    @property
    def chained(self) -> bool:
        """Whether its sidecar or its table says that there is a chain."""
        declared = self.sidecar is not None and "chain" in self.sidecar
        return declared or (self.table is not None and is_chained(self.table.data))


@dataclass(slots=True)
class Person:
    """What was found in a participant's folder; `problems` are lines for whoever owns the data.

    `half`: lines for rows that a crash cut short, which the next session takes away.
    """

    name: str
    sessions: list[Session] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    half: list[str] = field(default_factory=list)

    @property
    def complete(self) -> bool:
        """Whether an end file says that the participant's session was completed."""
        return any(session.status == COMPLETE for session in self.sessions)


class Folder:
    """Reads and checks one participant's folder `own`; files are named from `data` on."""

    def __init__(self, own: Path, data: Path) -> None:
        self.own, self.data = own, data
        self.found = Person(own.name)
        self._held: set[str] = set()
        self._traces: list[str] | None = None

    def read(self) -> Person:
        """Everything that is there, and every problem."""
        try:
            names = names_in(self.own, self._path(""))
            self._traces = self._trace_names(names)
        except DataError as error:
            self.found.problems += error.lines
            return self.found
        self.found.sessions = [self._session(stem, files) for stem, files in _sessions(names)]
        before: Session | None = None
        for session in self.found.sessions:
            whole = not self.found.problems  # else what follows from a broken file is no news
            self.found.problems += self._check(session)
            if session.chain is None or session.chain.state == "none" or self.found.problems:
                continue
            if whole:
                self.found.problems += self._follows(session, before)
            before = session
        if any(session.chained for session in self.found.sessions) and not self.found.problems:
            self.found.problems += self._added(names)
        return self.found

    def _path(self, name: str) -> Path:
        return Path(named(self.own / name, self.data))

    def _trace_names(self, names: list[str]) -> list[str] | None:
        if TRACES not in names:
            return None
        return [f"{TRACES}/{n}" for n in names_in(self.own / TRACES, self._path(TRACES))]

    def _session(self, stem: str, files: Mapping[str, str]) -> Session:
        """A session's tables and sidecar as they lie there; what cannot be read is a problem."""
        session = Session(stem, _number(stem), files)
        tables = {}
        for kind, name in files.items():
            try:
                if kind == SIDECAR:
                    session.sidecar = read_json(self.own / name, self.data)
                elif kind != END:
                    path = self.own / name
                    tables[kind] = Source(named(path, self.data), read_bytes(path, self.data))
            except DataError as error:
                self.found.problems += error.lines
        session.table = tables.get(TRIALS_TABLE)
        session.answers, session.notes = tables.get(ANSWERS_TABLE), tables.get(NOTES_TABLE)
        return session

    def _check(self, session: Session) -> Iterator[str]:
        """A session by itself."""
        if TRIALS_TABLE not in session.files:
            yield from self._without_table(session)
            return
        if session.table is None or (SIDECAR in session.files and session.sidecar is None):
            return  # not readable: said already
        session.chain = ChainState(session.table.name, "none")
        if not session.chained:
            return
        if session.sidecar is None:
            yield f"{session.table.name}: expected its sidecar {session.stem}{SIDECAR} beside it"
            return
        yield from self._identity(session)
        table = check_table(session.table.name, session.table.data, session.sidecar)
        yield from table.problems
        if table.half and END in session.files:
            yield table.half
        elif table.half:
            self.found.half.append(table.half)
        if not table.problems:
            yield from self._files(session, table)

    def _without_table(self, session: Session) -> Iterator[str]:
        """Killed between sidecar and table nothing was recorded; anything more was removed."""
        wanted = f"{session.stem}{TRIALS_TABLE}"
        if ANSWERS_TABLE in session.files:
            yield f"{self._path(session.files[ANSWERS_TABLE])}: expected its session's trial table"
        elif set(session.files) != {SIDECAR} or self._traces_of(session):
            yield f"{self._path(wanted)}: missing, though other files of its session are there"

    def _identity(self, session: Session) -> Iterator[str]:
        """The sidecar names whose session it is: a folder given another name shows."""
        assert session.sidecar is not None
        expected = {
            "participant": self.own.name,
            "source": self.own.parent.name,
            "session": session.number,
        }
        for key, value in expected.items():
            said = session.sidecar.get(key, value)
            if said != value and not (key == "source" and self.own == self.data):
                name = self._path(session.files[SIDECAR])
                yield f"{name}: {key} = {said!r}: expected {value!r}, as folder and file are named"

    def _files(self, session: Session, table: Table) -> Iterator[str]:
        """The traces that the rows hold, and the end."""
        assert session.table is not None
        self._held |= {session.files[TRIALS_TABLE], session.files[SIDECAR]}
        there = None if self._traces is None else 0
        for number, row in enumerate(table.rows, start=2):
            for file, digest in _PAIRS:
                if self._traces is not None and row.get(file):
                    where = f" (the trial in row {number} of {session.table.name})"
                    yield from self._same(row[file], row.get(digest, ""), where)
                    there = (there or 0) + 1
        session.traces = tuple(r[f] for r in table.rows for f, _ in _PAIRS if r.get(f))
        self._held |= set(session.traces)
        state = "open"
        if END in session.files:
            state = "verified"
            more: list[str] = []
            yield from self._end(session, table, more)
            there = None if there is None else there + len(more)
        elif CHUNK.fullmatch(self.own.name):
            yield f"{self._path(session.stem + END)}: missing: expected in a folder of data mode"
        session.chain = ChainState(session.table.name, state, there, table.last)

    def _end(self, session: Session, table: Table, traces: list[str]) -> Iterator[str]:
        """The end file against the table and the session's other files."""
        name = session.files[END]
        shown = self._path(name)
        self._held.add(name)
        try:
            end = read_json(self.own / name, self.data)
        except DataError as error:
            yield from error.lines
            return
        files, status = end.get("files"), end.get("status")
        if not (isinstance(status, str) and _is_hashes(files)):
            yield f"{shown}: expected a session's end, with status and files"
        elif "seal" not in end:
            yield f"{shown}: seal = missing: expected the file's own hash"
        elif end["seal"] != seal_of(end):
            yield f"{shown}: changed after the session"
        elif end.get("chain") != table.last:
            yield f"{table_name(session)}: rows at its end were removed or added, or {name} changed"
        else:
            session.status = status
            yield from self._listed(files, traces)

    def _listed(self, files: Mapping[str, str], traces: list[str]) -> Iterator[str]:
        """Files that no row holds, each as it was."""
        for other, digest in files.items():
            self._held.add(other)
            if not other.startswith(f"{TRACES}/"):
                yield from self._same(other, digest)
            elif self._traces is not None:
                traces.append(other)
                yield from self._same(other, digest)

    def _same(self, name: str, digest: str, where: str = "") -> Iterator[str]:
        path, shown = self.own / name, self._path(name)
        parts = Path(name).parts
        if ".." in parts or Path(name).is_absolute() or len(parts) > 2:
            yield f"{self._path('')}: {name!r}: expected a file in this folder"
            return
        try:
            if not is_there(path):
                yield f"{shown}: removed after the session{where}"
            elif sha256_of(path, self.data) != digest:
                again = name.endswith(".csv") and cells_have(read_bytes(path, self.data), digest)
                yield f"{shown}: {AGAIN if again else 'changed after the session'}{where}"
        except DataError as error:
            yield from error.lines

    def _follows(self, session: Session, before: Session | None) -> Iterator[str]:
        """That a session goes on where the one before it ended, and holds what that one left."""
        assert session.sidecar is not None
        chain = table_in(session.sidecar, "chain")
        last = before.chain.last if before is not None and before.chain is not None else ""
        if chain.get("follows", "") != last:
            yield f"{table_name(session)}: does not follow the session before it"
            return
        if before is None or END in before.files:
            return
        holds = chain.get("holds")
        if not _is_hashes(holds):
            # What goes on after a session that was killed holds its files: this one was closed.
            yield f"{self._path(before.stem + END)}: removed after the session"
            return
        yield from self._listed(holds, [])
        known = {before.files.get(kind) for kind in (ANSWERS_TABLE, NOTES_TABLE)} - {None}
        added = sorted(str(n) for n in known - set(holds))
        loose = set(self._traces_of(before)) - set(holds) - set(before.traces)
        loose = {name for name in loose if not is_empty(self.own / name)}  # begun as it was killed
        for name in [*added, *sorted(loose)]:
            self._held.add(name)
            yield f"{self._path(name)}: added after the session"

    def _traces_of(self, session: Session) -> list[str]:
        start = f"{TRACES}/session-{session.number}_"
        return [name for name in self._traces or () if name.startswith(start)]

    def _added(self, names: list[str]) -> Iterator[str]:
        """Tables and traces of closed sessions that nothing holds; files of no session at all."""
        for session in self.found.sessions:
            if END in session.files:
                for kind in (ANSWERS_TABLE, NOTES_TABLE):
                    name = session.files.get(kind)
                    if name is not None and name not in self._held:
                        yield f"{self._path(name)}: added after the session"
                for name in self._traces_of(session):
                    if name not in self._held:
                        yield f"{self._path(name)}: added after the session"
        yield from self._strays(names)
        ours = {name for session in self.found.sessions for name in session.files.values()}
        ours |= {f"{session.stem}{REPAIR}" for session in self.found.sessions}
        for name in names:
            if name.endswith((".csv", ".json")) and name not in ours | self._held:
                yield f"{self._path(name)}: added after the session"

    def _strays(self, names: list[str]) -> Iterator[str]:
        """Folders but the traces' (somebody else's, dragged in here), traces of no session, unless
        it was killed as it began and they are empty."""
        for name in names:
            if name != TRACES and (self.own / name).is_dir():
                yield f"{self._path(name)}: a folder: expected files and {TRACES} alone"
        known = {f"session-{session.number}" for session in self.found.sessions}
        for name in self._traces or ():
            whose = name.removeprefix(f"{TRACES}/").partition("_")[0]
            if whose not in known and not is_empty(self.own / name):
                yield f"{self._path(name)}: expected a trace of a session that is here"


def table_name(session: Session) -> str:
    """The trial table's name in messages."""
    assert session.table is not None
    return session.table.name


def _sessions(names: list[str]) -> list[tuple[str, dict[str, str]]]:
    """(stem, {kind: file name}) of each session, in their order: 10 comes after 9."""
    found: dict[str, dict[str, str]] = {}
    for name in names:
        for kind in KINDS:
            if name.endswith(kind):
                found.setdefault(name.removesuffix(kind), {})[kind] = name
    return sorted(found.items(), key=lambda item: (_number(item[0]), item[0]))


def _number(stem: str) -> int:
    number = stem.partition("_session-")[2].partition("_")[0]
    return int(number) if number.isascii() and number.isdigit() else 0


def _is_hashes(value: object) -> TypeGuard[Mapping[str, str]]:
    """Whether it is {file name: SHA-256}."""
    return isinstance(value, Mapping) and all(
        isinstance(digest, str) and _HEX.fullmatch(digest) for digest in value.values()
    )
