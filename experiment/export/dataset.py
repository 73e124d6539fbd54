"""What every format of export reads and writes: a study's tables, checked; new private files.

The data folder is only read. Sources (human, simulated, pilot) are never mixed.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiment.columns import TABLES, Column
from experiment.dataset import FILE
from experiment.errors import InputError
from experiment.folders import PARTICIPANT
from experiment.private import make_folder, write_new
from experiment.record_files import csv_line

SOURCES = ("human", "simulated", "pilot")
Row = Mapping[str, str]


@dataclass(frozen=True)
class Dataset:
    """A study's tables of one source: {table: rows as texts}, and the files they are from."""

    folder: Path
    name: str
    source: str
    tables: Mapping[str, Sequence[Row]]
    files: Mapping[str, Sequence[Path]]

    @property
    def participants(self) -> tuple[str, ...]:
        """Ids, in order."""
        return tuple(sorted({row["participant"] for row in self.tables["trials"]}))


def read(data: Path, source: str | None = None) -> Dataset:
    """The data folder's tables. Raises InputError with file, row, column and value."""
    try:
        name = str(json.loads((data / FILE).read_text(encoding="utf-8"))["name"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        raise InputError(f"{data / FILE}: expected a JSON object with the study's name") from None
    chosen = _source(data, source)
    files = {
        table: sorted((data / "data" / chosen).glob(f"*/*_{table}_data.csv")) for table in TABLES
    }
    tables = {
        table: [row for path in paths for row in _rows(path, TABLES[table])]
        for table, paths in files.items()
    }
    return Dataset(data, name, chosen, tables, files)


def check_out(out: Path) -> None:
    """A place for an export: a new or an empty folder. Raises InputError."""
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise InputError(f"--out = {out}: expected a new or an empty folder")


def put(path: Path, text: str) -> None:
    """A new private file. Raises InputError."""
    try:
        make_folder(path.parent)
        write_new(path, text)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def as_csv(columns: Sequence[str], rows: Sequence[Mapping[str, str]]) -> str:
    """A table as the recorder writes it."""
    lines = [csv_line([row.get(name, "") for name in columns]) for row in rows]
    return "\n".join([csv_line(list(columns)), *lines]) + "\n"


def as_json(value: Any) -> str:
    """JSON for people."""
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def latest_attempts(rows: Sequence[Row]) -> list[Row]:
    """Each participant's trials once: of a repeated trial, the last attempt."""
    last: dict[tuple[str, int], Row] = {}
    for row in sorted(rows, key=lambda row: (int(row["session"]), int(row["attempt"]))):
        last[row["participant"], int(row["trial"])] = row
    return [last[key] for key in sorted(last)]


def _source(data: Path, wanted: str | None) -> str:
    there = [s for s in SOURCES if any((data / "data" / s).glob("*/*_trials_data.csv"))]
    if wanted is not None and wanted not in there:
        raise InputError(f"--source = {wanted}: expected one of: {', '.join(there) or 'none'}")
    if not there:
        raise InputError(f"{data}: no trial tables: expected data/SOURCE/PARTICIPANT/*.csv")
    if wanted is None and len(there) > 1:
        raise InputError(f"{data}: several sources: choose with --source {' or '.join(there)}")
    return wanted or there[0]


def _rows(path: Path, columns: tuple[Column, ...]) -> list[Row]:
    """A table's rows, every cell of its column's type."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            reader = csv.reader(file, strict=True)
            header, *lines = list(reader) or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: not readable as a table: {error}") from None
    names = [column.name for column in columns]
    if header != names:
        odd = sorted(set(header) ^ set(names))
        raise InputError(f"{path}: header: expected {len(names)} columns; not so: {odd[:5]}")
    for number, line in enumerate(lines, start=2):
        if len(line) != len(names):
            raise InputError(
                f"{path}: row {number}: {len(line)} of {len(names)} values: expected a whole row"
            )
        for column, text in zip(columns, line, strict=True):
            if not fits(text, column.type):
                raise InputError(
                    f"{path}: row {number}: {column.name} = {text!r}: expected {column.type}"
                )
        if not PARTICIPANT.fullmatch(line[names.index("participant")]):
            raise InputError(f"{path}: row {number}: participant: expected a participant's id")
    return [dict(zip(names, line, strict=True)) for line in lines]


def fits(text: str, kind: str) -> bool:
    """Whether a cell's text fits its column's type; an empty one does."""
    if text == "" or kind == "text":
        return True
    if kind == "boolean":
        return text in ("true", "false")
    try:
        return (kind == "integer" and str(int(text)) == text) or math.isfinite(float(text))
    except ValueError:
        return False
