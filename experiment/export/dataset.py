"""What every format of export reads and writes: a study's tables, checked; new private files.

The data folder is only read. Sources (human, simulated, pilot) are never mixed.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from seethrough.analysis.load.chain import read_rows
from seethrough.analysis.load.whole import verified
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import PARTICIPANT, plain
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.record.columns import TABLES, Column, columns_in, factors_in, versions
from seethrough.experiment.record.record_files import csv_line

FORMULA = ("=", "+", "-", "@", "\t", "\r", "'")
HARMLESS = "a text that begins with one of = + - @ ' or a tab has one ' more before it"
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
Row = Mapping[str, str]


@dataclass(frozen=True)
class Dataset:
    """A study's tables of one source: {table: rows as texts}, and the files they are from."""

    folder: Path
    name: str
    source: str
    tables: Mapping[str, Sequence[Row]]
    files: Mapping[str, Sequence[Path]]

    def columns(self, table: str) -> tuple[Column, ...]:
        """A table's columns, factors among them."""
        rows = self.tables[table]
        return columns_in(table, list(rows[0])) if rows else TABLES[table]

    @property
    def factors(self) -> tuple[str, ...]:
        """The factors' columns."""
        rows = self.tables["trials"]
        return factors_in(list(rows[0])) if rows else ()

    @property
    def participants(self) -> tuple[str, ...]:
        """Ids, in order."""
        return tuple(sorted({row["participant"] for row in self.tables["trials"]}))


def read(data: Path, source: str | None = None) -> Dataset:
    """The data folder's tables, verified as a report verifies them.

    Raises DataError where a file is not as it was written, InputError with file, row, column and
    value where a table is none of ours.
    """
    whole = verified(data, source)
    paths: dict[str, list[Path]] = {table: [] for table in TABLES}
    rows: dict[str, list[Row]] = {table: [] for table in TABLES}
    for person in whole.people:
        for session in person.sessions:
            found = {
                "trials": session.table,
                "questionnaire": session.answers,
                "notes": session.notes,
            }
            for table, held in found.items():
                if held is not None:
                    paths[table].append(data / held.name)
                    rows[table] += _rows(data / held.name, held.data, table)
    if not rows["trials"]:
        raise InputError(f"{data}: no trial tables: expected data/SOURCE/PARTICIPANT/*.csv")
    return Dataset(data, str(whole.about.get("name", data.name)), whole.source, rows, paths)


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


def as_json(value: object) -> str:
    """JSON for people."""
    return json.dumps(value, indent=2, ensure_ascii=False) + "\n"


def harmless(text: str) -> str:
    """A free text as spreadsheets show it, whatever it begins with; HARMLESS says how to undo it.

    A spreadsheet takes a cell that begins with one of FORMULA for something to calculate, or to
    run. Numbers are left alone.
    """
    if not text.startswith(FORMULA):
        return text
    return text if _NUMBER.fullmatch(text) else "'" + text


def check_labels(form: str, participants: Sequence[str]) -> None:
    """Labels hold letters and digits alone. Raises InputError where two people would be one."""
    for own in participants:
        same = [p for p in participants if plain(p) == plain(own)]
        if len(same) > 1 or not plain(own):
            raise InputError(
                f"--format = {form}: participants {', '.join(same)}: expected ids that differ in "
                "their letters and digits, of which labels are made"
            )


def latest_attempts(rows: Sequence[Row]) -> list[Row]:
    """Each participant's trials once: of a repeated trial, the last attempt."""
    last: dict[tuple[str, int], Row] = {}
    for row in sorted(rows, key=lambda row: (int(row["session"]), int(row["attempt"]))):
        last[row["participant"], int(row["trial"])] = row
    return [last[key] for key in sorted(last)]


def _rows(path: Path, data: bytes, table: str) -> list[Row]:
    """A table's rows, every cell of its column's type."""
    try:
        header, *lines = read_rows(data.decode("utf-8")) or [[]]
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: not readable as a table: {error}") from None
    columns = columns_in(table, header)
    empty = dict.fromkeys((column.name for column in columns), "")
    columns = next((v for v in versions(columns) if [c.name for c in v] == header), columns)
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
    return [empty | dict(zip(names, line, strict=True)) for line in lines]


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
