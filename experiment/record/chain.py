"""The hash chain over a trial table's rows, as the recorder writes it.

Whether files are as they were written is said by one reader, `analysis/load/`, for everything that
reads a data folder; it shares no code with this one.

Each row's last cell is SHA-256(the cell before it in the chain + the row's text without its own
cell and the comma before that), in hexadecimal. The chain starts with a hash of the sidecar and the
table's header, ends in the session's end file, and goes on from one session of a participant to
the next. A row holds the hashes of its traces; the end file those of the session's other tables,
or, for a session that was killed, the sidecar of the one that goes on.
"""

from __future__ import annotations

import csv
import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

from seethrough.analysis.load.files import read_json, table_in
from seethrough.analysis.load.person import Folder

TRIALS_TABLE, SIDECAR, END = "_trials_data.csv", "_trials_data.json", "_end.json"
ANSWERS_TABLE = "_questionnaire_data.csv"


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode("utf-8", "replace")).hexdigest()


def start_of(sidecar: Mapping[str, object], header: str) -> str:
    """Where a session's chain starts: its sidecar (but for `chain.start` itself) and header."""
    chain = {
        key: value
        for key, value in table_in({"chain": {}, **sidecar}, "chain").items()
        if key != "start"
    }
    plain = json.dumps({**sidecar, "chain": chain}, sort_keys=True, ensure_ascii=False)
    return link(plain, header)


def seal_of(end: Mapping[str, object]) -> str:
    """The end file's hash of itself, but for `seal`: nothing else holds how a session ended."""
    plain = {key: value for key, value in end.items() if key != "seal"}
    return link("", json.dumps(plain, sort_keys=True, ensure_ascii=False))


def file_hash(path: Path) -> str:
    """SHA-256 of a file's bytes."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def end_of(table: Path) -> str:
    """Where a table's chain ends: its last whole row, or its start if it has none."""
    lines = table.read_text(encoding="utf-8", errors="replace").split("\n")[1:-1]
    if lines:
        return lines[-1].rpartition(",")[2]
    sidecar = read_json(table.with_suffix(".json"), table.parent)
    return str(table_in(sidecar, "chain")["start"])


def loose_files(table: Path, killed: bool = False) -> dict[str, str]:
    """{name: SHA-256} of a session's files that its rows do not hold.

    Of one that was `killed` without traces in which nothing is: if it was but stopped, it takes
    them away when it goes on.
    """
    stem = table.name.removesuffix(TRIALS_TABLE)
    traces = (table.parent / "traces").glob(f"session-{_session(table)[0]}_*")
    chained = {table.name, stem + SIDECAR, *_traces_of(table)}
    names = {
        path.relative_to(table.parent).as_posix(): path
        for path in sorted([*table.parent.glob(f"{stem}_*"), *traces])
    }
    left = {name: path for name, path in names.items() if name not in chained}
    if killed:
        empty = {n for n, p in left.items() if p.parent.name == "traces" and not p.stat().st_size}
        left = {name: path for name, path in left.items() if name not in empty}
    return {name: file_hash(path) for name, path in left.items()}


def latest_table(folder: Path) -> Path | None:
    """The trial table of a participant's latest session."""
    return max(folder.glob(f"*{TRIALS_TABLE}"), key=_session, default=None)


def verify(folder: Path) -> list[str]:
    """What is not as it was written in a participant's folder: `file: row N: …`, [] if all is.

    A table that a crash left without an end file is verified as far as it goes.
    """
    person = Folder(folder, folder).read()
    return [*person.problems, *person.half]


def _traces_of(table: Path) -> set[str]:
    """The traces that a table's rows hold."""
    rows = csv.DictReader(table.read_text("utf-8", "replace").split("\n"))
    return {row.get(f"{trace}_file") or "" for row in rows for trace in ("events", "camera")}


def _session(table: Path) -> tuple[int, str]:
    """Sessions in their order: session-10 comes after session-9."""
    number = table.name.partition("_session-")[2].partition("_")[0]
    return (int(number) if number.isdigit() else 0, table.name)
