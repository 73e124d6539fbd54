"""The hash chain over a trial table's rows: a changed byte is found and named.

A table with a chain ends in the column `chain`: in each row the SHA-256, in hexadecimal, of the
value in the row before followed by the row's own text up to (without) the comma before `chain`.
The sidecar's `chain.start` stands before the first row; it is itself made from the sidecar and the
table's header. Each row holds the hashes of its trial's traces. The session's end file, if the
session was closed, holds the last value and the hashes of the session's other files: a table or
trace of the session that neither holds was added later. The end file's `seal` is the hash of the
rest of it; the sidecar of a session that goes on holds the last value of the one before, and, if
that one was never closed, the hashes of its other files (CONVENTIONS.md).

Data may be handed on without their traces: a session whose traces folder is gone is verified
without them and says so. A single trace that is missing was removed.
"""

from __future__ import annotations

import csv
import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.errors import DataError
from analysis.load.table import Source

COLUMN = "chain"
TRIALS_TABLE, ANSWERS_TABLE = "_trials_data.csv", "_questionnaire_data.csv"
END = "_end.json"
TRACES = "traces"
_PAIRS = (("events_file", "events_sha256"), ("camera_file", "camera_sha256"))


@dataclass(frozen=True, slots=True)
class ChainState:
    """`state`: verified, open (verified, but the session was never closed), or none.

    `traces`: how many trace files were verified, None where their folder is gone; `last`: the
    chain's end; `chained`: the traces that the rows hold, None where their folder is gone.
    """

    file: str
    state: str
    traces: int | None = 0
    last: str = ""
    chained: tuple[str, ...] | None = ()


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode("utf-8", "replace")).hexdigest()


def start_of(sidecar: Mapping[str, Any], header: str) -> str:
    """Where a chain starts: the sidecar, but for `chain.start` itself, and the header."""
    chain = {key: value for key, value in sidecar["chain"].items() if key != "start"}
    plain = json.dumps({**sidecar, "chain": chain}, sort_keys=True, ensure_ascii=False)
    return link(plain, header)


def seal_of(end: Mapping[str, Any]) -> str:
    """The end file's hash of itself, but for `seal`."""
    plain = {key: value for key, value in end.items() if key != "seal"}
    return link("", json.dumps(plain, sort_keys=True, ensure_ascii=False))


def verify_all(
    sources: Sequence[Source], sidecars: Mapping[str, Mapping[str, Any]], folder: Path
) -> list[ChainState]:
    """Every table, and that each participant's sessions follow one another.

    Raises DataError naming the first place that is not as it was written.
    """
    ends: dict[str, ChainState] = {}
    states = {}
    for source in sorted(sources, key=lambda s: _session(s.name)):
        sidecar = sidecars.get(source.name, {})
        state = verify(source, sidecar, folder)
        person = source.name.rpartition("/")[0]
        if state.state != "none":
            before = ends.get(person)
            if sidecar["chain"].get("follows", "") != (before.last if before else ""):
                raise DataError(f"{source.name}: does not follow the session before it")
            if before and isinstance(holds := sidecar["chain"].get("holds"), Mapping):
                _verify_files(before.file, holds, folder, before.chained)
            ends[person] = state
        states[source.name] = state
    for person in ends:
        _no_answers_alone(folder / person, folder)
    return [states[source.name] for source in sources]


def _session(name: str) -> tuple[str, int]:
    """Participants, and their sessions in order: session-10 comes after session-9."""
    number = name.partition("_session-")[2].partition("_")[0]
    return name.rpartition("/")[0], int(number) if number.isdigit() else 0


def verify(source: Source, sidecar: Mapping[str, Any], folder: Path) -> ChainState:
    """Check header, sidecar, every row, the traces and the session's end.

    Raises DataError naming the first place that is not as it was written.
    """
    lines = source.data.decode("utf-8").split("\n")
    if lines[0].rpartition(",")[2] != COLUMN:
        return ChainState(source.name, "none")
    chain = sidecar.get("chain")
    if not isinstance(chain, Mapping) or "start" not in chain:
        raise DataError(f"{source.name}: column = chain: expected chain.start in its sidecar")
    before = str(chain["start"])
    if start_of(sidecar, lines[0]) != before:
        raise DataError(f"{source.name}: row 1: this header, or its sidecar, was changed")
    for number, row in enumerate((line for line in lines[1:] if line), start=2):
        text, _, value = row.rpartition(",")
        if value != link(before, text):
            raise DataError(f"{source.name}: row {number}: changed, or a row before it removed")
        before = value
    traces = _verify_traces(source.name, lines, folder)
    state, more = _verify_end(source.name, before, folder, traces)
    if traces is None:
        return ChainState(source.name, state, None, before, None)
    return ChainState(source.name, state, len(traces) + more, before, tuple(traces))


def _verify_traces(name: str, lines: Sequence[str], folder: Path) -> list[str] | None:
    """The traces named in the rows, each verified; None if their folder is gone."""
    own = (folder / name).parent
    header, *rows = csv.reader(lines)
    places = [(header.index(f), header.index(h)) for f, h in _PAIRS if f in header and h in header]
    if not (own / TRACES).is_dir():
        return None
    traces = []
    for number, cells in enumerate((row for row in rows if row), start=2):
        for file, digest in places:
            if cells[file]:
                where = f" (the trial in row {number} of {name})"
                _same(own, cells[file], cells[digest], folder, where)
                traces.append(cells[file])
    return traces


def _same(own: Path, name: str, digest: str, folder: Path, where: str = "") -> None:
    """Raises DataError unless the file beside the table is as it was written."""
    path = own / name
    if not path.resolve().is_relative_to(own.resolve()):
        raise DataError(f"{own.relative_to(folder)}: {name!r}: expected a file in this folder")
    if not path.is_file():
        raise DataError(f"{path.relative_to(folder)}: removed after the session{where}")
    if hashlib.sha256(path.read_bytes()).hexdigest() != digest:
        raise DataError(f"{path.relative_to(folder)}: changed after the session{where}")


def _verify_end(
    name: str, last: str, folder: Path, chained: Sequence[str] | None
) -> tuple[str, int]:
    """The end file against the table and the session's other files; how many were traces.

    `chained`: the traces that the rows hold, None where no traces are there.
    """
    path = folder / name.replace(TRIALS_TABLE, END)
    if not path.is_file():
        return "open", 0
    try:
        end = json.loads(path.read_bytes())
        files = {str(name): str(digest) for name, digest in dict(end["files"]).items()}
    except (ValueError, KeyError, TypeError, RecursionError):
        raise DataError(f"{path.relative_to(folder)}: expected a session's end, as JSON") from None
    if "seal" not in end:
        raise DataError(f"{path.relative_to(folder)}: seal = missing: expected the file's own hash")
    if end["seal"] != seal_of(end):
        raise DataError(f"{path.relative_to(folder)}: changed after the session")
    if end.get("chain") != last:
        raise DataError(f"{name}: rows at its end were removed or added, or {path.name} changed")
    return "verified", _verify_files(name, files, folder, chained)


def _verify_files(
    name: str, files: Mapping[str, str], folder: Path, chained: Sequence[str] | None
) -> int:
    """A session's files that its rows do not hold, and that there are no others; the traces.

    Raises DataError naming the first that is not as it was written.
    """
    traces = 0
    for other, digest in files.items():
        trace = other.startswith(f"{TRACES}/")
        if trace and chained is None:
            continue
        _same((folder / name).parent, other, digest, folder)
        traces += trace
    _nothing_added(folder / name, {*files, *(chained or ()), Path(name).name}, folder)
    return traces


def _nothing_added(table: Path, held: set[str], folder: Path) -> None:
    """Raises DataError if a closed session has a table or a trace that nothing holds."""
    stem, number = table.name.removesuffix(TRIALS_TABLE), _session(table.name)[1]
    tables = (p for p in table.parent.glob("*_data.csv") if p.name.startswith(f"{stem}_"))
    for path in (*sorted(tables), *sorted((table.parent / TRACES).glob(f"session-{number}_*"))):
        if path.relative_to(table.parent).as_posix() not in held:
            raise DataError(f"{path.relative_to(folder)}: added after the session")


def _no_answers_alone(own: Path, folder: Path) -> None:
    """Raises DataError if a participant with a chain has answers of a session that never was."""
    for path in sorted(own.glob(f"*{ANSWERS_TABLE}")):
        if not path.with_name(path.name.replace(ANSWERS_TABLE, TRIALS_TABLE)).is_file():
            raise DataError(f"{path.relative_to(folder)}: expected its session's trial table")
