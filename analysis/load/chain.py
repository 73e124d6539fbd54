"""The hash chain over a trial table's rows: a changed byte is found and named.

A table with a chain ends in the column `chain`: in each row the SHA-256, in hexadecimal, of the
value in the row before followed by the row's own text up to (without) the comma before `chain`.
The sidecar's `chain.start` stands before the first row; it is itself made from the sidecar and the
table's header (CONVENTIONS.md). What one participant's files say together is in `person.py`.

A program that opened the table and saved it again may have left every cell as it was: that gets a
line of its own, since the original is then still what it was.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from seethrough.analysis.load.files import AGAIN, MARKS, table_in

COLUMN = "chain"
LONGEST_CELL = 2**31 - 1  # characters: Python's own limit of 131,072 is less than a remark may have
HALF = "half-written"
SEPARATORS = (",", ";", "\t")


@dataclass(frozen=True, slots=True)
class ChainState:
    """`state`: verified, open (verified, but the session was never closed), or none.

    `traces`: how many trace files were verified, None where their folder is gone; `last`: the
    chain's end.
    """

    file: str
    state: str
    traces: int | None = 0
    last: str = ""


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode("utf-8", "replace")).hexdigest()


def start_of(sidecar: Mapping[str, object], header: str) -> str:
    """Where a chain starts: the sidecar, but for `chain.start` itself, and the header."""
    chain = {key: value for key, value in table_in(sidecar, "chain").items() if key != "start"}
    plain = json.dumps({**sidecar, "chain": chain}, sort_keys=True, ensure_ascii=False)
    return link(plain, header)


def seal_of(end: Mapping[str, object]) -> str:
    """The end file's hash of itself, but for `seal`."""
    plain = {key: value for key, value in end.items() if key != "seal"}
    return link("", json.dumps(plain, sort_keys=True, ensure_ascii=False))


@dataclass(frozen=True, slots=True)
class Table:
    """A trial table as its chain has it: the problems found, its cells, and the chain's end.

    `half`: the line for a last row that a crash left half-written, where that is all.
    """

    problems: tuple[str, ...]
    rows: tuple[Mapping[str, str], ...] = ()
    last: str = ""
    half: str = ""


def read_rows(text: str, separator: str = ",") -> list[list[str]]:
    """The cells of a table's rows, however long a cell is. Raises csv.Error."""
    csv.field_size_limit(LONGEST_CELL)
    return list(csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True))


def is_chained(data: bytes) -> bool:
    """Whether a table's header ends in the chain's column, whoever saved it last."""
    text, _ = _decoded(data)
    head = re.split("[\r\n]", text, maxsplit=1)[0]
    return any(head.rpartition(s)[2].strip('"') == COLUMN for s in SEPARATORS)


def check_table(name: str, data: bytes, sidecar: Mapping[str, object]) -> Table:
    """A table with a chain, row by row, against the sidecar that the chain starts from."""
    text, marks = _decoded(data)
    lines = list(_lines(text))
    problems = list(_row_problems(name, lines, sidecar))
    if not problems and not marks:
        return Table((), _cells(lines), _last(lines, sidecar))
    plain = _as_recorded(text)
    again = [] if plain is None else list(_row_problems(name, list(_lines(plain)), sidecar))
    if len(problems) == 1 and HALF in problems[0] and (plain is None or again):
        return Table((), _cells(lines[:-1]), _last(lines[:-1], sidecar), problems[0])
    if plain is None or plain.encode("utf-8", "replace") == data:
        return Table(tuple(problems) or (f"{name}: {AGAIN} ({marks})",))
    how = marks or ("line ends" if "\r" in text else "quotes, separators or empty lines")
    if not again:
        return Table((f"{name}: {AGAIN} ({how})",))
    more = f" and {len(again) - 1} rows more" if len(again) > 1 else ""
    return Table((f"{again[0]}{more}; {AGAIN} ({how})",))


def cells_have(data: bytes, digest: str) -> bool:
    """Whether a table's cells, written as the recorder does, have this SHA-256."""
    plain = _as_recorded(_decoded(data)[0])
    return (
        plain is not None and hashlib.sha256(plain.encode("utf-8", "replace")).hexdigest() == digest
    )


def _decoded(data: bytes) -> tuple[str, str]:
    """The table's text, and the mark that a program which saved it again left before it."""
    for mark, what in MARKS.items():
        if data.startswith(mark):
            code = "utf-8-sig" if mark == b"\xef\xbb\xbf" else "utf-16"
            return data.decode(code, "replace"), what
    return data.decode("utf-8", "replace"), ""


def _lines(text: str) -> Iterator[str]:
    """The rows' texts, each with its line's end: the line breaks in a quoted cell end no row."""
    held = ""
    for line in _split(text):
        held += line
        if held.count('"') % 2 == 0:
            yield held
            held = ""
    if held:
        yield held


def _split(text: str) -> Iterator[str]:
    """Lines that end in \\n and nothing else."""
    start = 0
    while (end := text.find("\n", start)) >= 0:
        yield text[start : end + 1]
        start = end + 1
    if start < len(text):
        yield text[start:]


def _row_problems(name: str, lines: list[str], sidecar: Mapping[str, object]) -> Iterator[str]:
    """What of header and rows is not as it was written."""
    header = lines[0].removesuffix("\n") if lines else ""
    if header.rpartition(",")[2] != COLUMN:
        yield f"{name}: column = chain: missing, though its sidecar begins a chain"
        return
    chain = sidecar.get("chain")
    if not isinstance(chain, Mapping) or "start" not in chain:
        yield f"{name}: column = chain: expected chain.start in its sidecar"
        return
    before = str(chain["start"])
    if start_of(sidecar, header) != before:
        yield f"{name}: row 1: this header, or its sidecar, was changed"
    for number, line in enumerate(lines[1:], start=2):
        text, _, value = line.removesuffix("\n").rpartition(",")
        if not line.endswith("\n"):
            yield f"{name}: row {number}: {HALF}: the line has no end"
        elif value != link(before, text):
            yield f"{name}: row {number}: changed, or a row before it removed"
        before = value


def _cells(lines: list[str]) -> tuple[Mapping[str, str], ...]:
    header, *rows = read_rows("".join(lines))
    return tuple(dict(zip(header, row, strict=False)) for row in rows)


def _last(lines: list[str], sidecar: Mapping[str, object]) -> str:
    if len(lines) > 1:
        return lines[-1].removesuffix("\n").rpartition(",")[2]
    return str(table_in(sidecar, "chain")["start"])


def _as_recorded(text: str) -> str | None:
    """The same cells as the recorder writes them; None where they are no table.

    A row is quoted where it must be and ends in a line feed; its chain stands last.
    """
    head = re.split("[\r\n]", text, maxsplit=1)[0]
    separator = max(SEPARATORS, key=head.count)
    try:
        rows = read_rows(text if "\n" in text else text.replace("\r", "\n"), separator)
    except csv.Error:
        return None
    out = io.StringIO()
    for row in rows:
        if row:
            line = io.StringIO()
            csv.writer(line, lineterminator="\r\n").writerow(row)
            out.write(line.getvalue()[:-2] + "\n")
    return out.getvalue()
