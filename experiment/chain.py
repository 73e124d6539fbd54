"""The hash chain over a trial table's rows: a changed byte is found and named.

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
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

TRIALS_TABLE, SIDECAR, END = "_trials_data.csv", "_trials_data.json", "_end.json"
ANSWERS_TABLE = "_questionnaire_data.csv"


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode("utf-8", "replace")).hexdigest()


def start_of(sidecar: Mapping[str, Any], header: str) -> str:
    """Where a session's chain starts: its sidecar (but for `chain.start` itself) and header."""
    chain = {key: value for key, value in sidecar.get("chain", {}).items() if key != "start"}
    plain = json.dumps({**sidecar, "chain": chain}, sort_keys=True, ensure_ascii=False)
    return link(plain, header)


def seal_of(end: Mapping[str, Any]) -> str:
    """The end file's hash of itself, but for `seal`: nothing else holds how a session ended."""
    plain = {key: value for key, value in end.items() if key != "seal"}
    return link("", json.dumps(plain, sort_keys=True, ensure_ascii=False))


def file_hash(path: Path) -> str:
    """SHA-256 of a file's bytes."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def end_of(table: Path) -> str:
    """Where a table's chain ends: its last whole row, or its start if it has none."""
    lines = table.read_text(encoding="utf-8", errors="replace").split("\n")[1:-1]
    start = str(_json(table.with_suffix(".json")).get("chain", {}).get("start", ""))
    return lines[-1].rpartition(",")[2] if lines else start


def loose_files(table: Path) -> dict[str, str]:
    """{name: SHA-256} of a session's files that its rows do not hold."""
    stem = table.name.removesuffix(TRIALS_TABLE)
    traces = (table.parent / "traces").glob(f"session-{_session(table)[0]}_*")
    chained = {table.name, stem + SIDECAR, *_traces_of(table)}
    names = {
        path.relative_to(table.parent).as_posix(): path
        for path in sorted([*table.parent.glob(f"{stem}_*"), *traces])
    }
    return {name: file_hash(path) for name, path in names.items() if name not in chained}


def latest_table(folder: Path) -> Path | None:
    """The trial table of a participant's latest session."""
    return max(folder.glob(f"*{TRIALS_TABLE}"), key=_session, default=None)


def verify(folder: Path) -> list[str]:
    """What is not as it was written in a participant's folder: `file: row N: …`, [] if all is.

    A table that a crash left without an end file is verified as far as it goes.
    """
    problems: list[str] = []
    before, last = "", None
    tables = sorted(folder.glob(f"*{TRIALS_TABLE}"), key=_session)
    for table in tables:
        sidecar = _json(table.with_suffix(".json"))
        found = sidecar.get("chain", {})
        if not found:
            problems.append(f"{table.name}: no chain: the sidecar names none")
            continue
        if found.get("follows", "") != before:
            name = table.with_suffix(".json").name
            problems.append(f"{name}: does not follow the session before")
        if last is not None and "holds" in found:
            problems += _verify_files(last, found["holds"])
        problems += _verify_table(table, sidecar)
        before, last = end_of(table), table
        problems += _verify_end(folder, table, before)
    if tables:
        problems += _answers_alone(folder)
    return problems


def _verify_table(table: Path, sidecar: Mapping[str, Any]) -> Iterator[str]:
    header, *lines = table.read_bytes().decode("utf-8", "replace").split("\n")
    before = sidecar["chain"].get("start", "")
    if start_of(sidecar, header) != before:
        yield f"{table.with_suffix('.json').name}: changed, or the header of {table.name}"
    names = header.split(",")
    columns = [(f"{trace}_file", f"{trace}_sha256") for trace in ("events", "camera")]
    traces = [(names.index(f), names.index(h)) for f, h in columns if {f, h} <= {*names}]
    for number, line in enumerate(lines[:-1], start=2):
        text, _, value = line.rpartition(",")
        if value != link(before, text):
            yield f"{table.name}: row {number}: changed, or a row before it removed"
        else:
            yield from _verify_traces(table, number, next(csv.reader([line])), traces)
        before = value
    if lines and lines[-1]:
        yield f"{table.name}: row {len(lines) + 1}: half-written"


def _verify_traces(
    table: Path, number: int, cells: list[str], traces: list[tuple[int, int]]
) -> Iterator[str]:
    for name, digest in traces:
        if not cells[name]:  # data mode has no traces
            continue
        path = table.parent / cells[name]
        if not path.is_file() or file_hash(path) != cells[digest]:
            what = "changed" if path.is_file() else "missing"
            yield f"{cells[name]}: {what} (the trial in row {number} of {table.name})"


def _verify_end(folder: Path, table: Path, last: str) -> Iterator[str]:
    path = folder / table.name.replace(TRIALS_TABLE, END)
    if not path.is_file():
        return
    end = _json(path)
    if end.get("seal") != seal_of(end):
        yield f"{path.name}: changed"
    if end.get("chain") != last:
        yield f"{table.name}: rows at the end removed or added, or {path.name} changed"
    yield from _verify_files(table, end.get("files", {}))


def _verify_files(table: Path, files: Mapping[str, str]) -> Iterator[str]:
    """The files of a session that its rows do not hold: as they were, and no others."""
    for name, digest in files.items():
        other = table.parent / name
        if not other.is_file() or file_hash(other) != digest:
            yield f"{name}: {'changed' if other.is_file() else 'missing'}"
    yield from _added(table, {*files, table.name, *_traces_of(table)})


def _traces_of(table: Path) -> set[str]:
    """The traces that a table's rows hold."""
    rows = csv.DictReader(table.read_text("utf-8", "replace").split("\n"))
    return {row.get(f"{trace}_file") or "" for row in rows for trace in ("events", "camera")}


def _added(table: Path, held: set[str]) -> Iterator[str]:
    """Tables and traces of a closed session that neither its chain nor its end file holds."""
    stem = table.name.removesuffix(TRIALS_TABLE)
    tables = (p for p in table.parent.glob("*_data.csv") if p.name.startswith(f"{stem}_"))
    traces = (table.parent / "traces").glob(f"session-{_session(table)[0]}_*")
    for path in (*sorted(tables), *sorted(traces)):
        name = path.relative_to(table.parent).as_posix()
        if name not in held:
            yield f"{name}: added after the session"


def _answers_alone(folder: Path) -> Iterator[str]:
    """Answers of a session that never was, which a report would read as well."""
    for path in sorted(folder.glob(f"*{ANSWERS_TABLE}")):
        if not path.with_name(path.name.replace(ANSWERS_TABLE, TRIALS_TABLE)).is_file():
            yield f"{path.name}: expected its session's trial table"


def _session(table: Path) -> tuple[int, str]:
    """Sessions in their order: session-10 comes after session-9."""
    number = table.name.partition("_session-")[2].partition("_")[0]
    return (int(number) if number.isdigit() else 0, table.name)


def _json(path: Path) -> dict[str, Any]:
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    return value if isinstance(value, dict) else {}
