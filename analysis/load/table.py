"""Many small CSV files of one header as one checked table; what is wrong is named by file and row.

Rows are counted as a spreadsheet shows them: the header is row 1. The files' bodies are joined and
parsed in one go (10,000 files one by one take a minute); only when something looks wrong is the
slow, exact search for the culprit started.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.chain import read_rows
from seethrough.analysis.load.files import AGAIN, MARKS, Source

NEWLINE = b"\n"
CONTROL = re.compile(rb"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")

WANTED = {
    "integer": "a whole number",
    "number": "a finite number",
    "boolean": "true or false",
}


def read_table(sources: Sequence[Source], columns: Mapping[str, str]) -> pd.DataFrame:
    """The files' rows with `columns` (name → type), and `_file`, `_row` to name each by.

    Numbers and integers are float64 (NaN where empty), booleans float64 0/1, texts str.
    Raises DataError with one line per problem.
    """
    problems = [line for source in sources for line in _shape_problems(source, columns)]
    if problems:
        raise DataError(problems)
    frames = []
    for header, group in _by_header(sources).items():
        bodies = [_plain_body(source.data) for source in group]
        joined = header + b"\n" + b"".join(bodies)
        frame = _parse(joined, columns, group)
        counts = [_rows(body) for body in bodies]
        if sum(counts) != len(frame):  # two readers of CSV disagree: neither is to be trusted
            names = ", ".join(source.name for source in group[:3])
            raise DataError(f"{names}: cannot be read unambiguously as comma-separated values")
        frame["_file"] = pd.Categorical(
            np.repeat([source.name for source in group], counts),
            categories=[source.name for source in group],
        )
        frame["_row"] = np.concatenate([np.arange(2, count + 2) for count in counts])
        frames.append(frame)
    if len(frames) == 1:
        return frames[0]
    table = pd.concat(frames, ignore_index=True)
    table["_file"] = pd.Categorical(table["_file"])
    return table


def _by_header(sources: Sequence[Source]) -> dict[bytes, list[Source]]:
    """Files grouped by their exact header line."""
    groups: dict[bytes, list[Source]] = {}
    for source in sources:
        groups.setdefault(source.data.partition(b"\n")[0].rstrip(b"\r"), []).append(source)
    return groups


def _plain_body(data: bytes) -> bytes:
    """The rows below the header, with plain line ends and no more quotes than needed."""
    body = data.partition(b"\n")[2]
    if b'"' not in body and b"\r" not in body:
        return body
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(_cells(body))
    return out.getvalue().encode()


def _cells(body: bytes) -> list[list[str]]:
    """The rows' cells, read strictly. Raises csv.Error."""
    return read_rows(body.decode("utf-8"))


def _rows(body: bytes) -> int:
    """Number of CSV rows; quoted texts may hold line breaks."""
    return body.count(b"\n") if b'"' not in body else len(_cells(body))


def _shape_problems(source: Source, columns: Mapping[str, str]) -> list[str]:
    """Encoding, header, and rows that are not as long as the header."""
    head, _, body = source.data.partition(b"\n")
    for mark, what in MARKS.items():
        if head.startswith(mark):
            return [f"{source.name}: {AGAIN} ({what})"]
    try:
        source.data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = source.data[: error.start].count(b"\n") + 1
        return [f"{source.name}: row {line}: not UTF-8 text"]
    try:
        names = next(csv.reader([head.decode("utf-8").rstrip("\r")], strict=True), [])
    except csv.Error as error:
        return [f"{source.name}: row 1: not a header of column names ({error})"]
    missing = [name for name in columns if name not in names]
    if missing:
        spare = sorted(set(names) - set(columns))
        hint = f" (columns it does not know: {', '.join(spare[:5])})" if spare else ""
        return [f"{source.name}: column = {name}: missing{hint}" for name in missing]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        return [f"{source.name}: column = {twice}: twice in the header"]
    if body and not body.endswith(b"\n"):
        return [f"{source.name}: row {body.count(NEWLINE) + 2}: half-written: the line has no end"]
    return _row_problems(source.name, body, len(names))


def _row_problems(name: str, body: bytes, width: int) -> list[str]:
    """Rows that are not `width` values long, or hold what no text has."""
    odd = CONTROL.search(body)
    if odd:
        row = body.count(NEWLINE, 0, odd.start()) + 2
        return [f"{name}: row {row}: a control character (byte {odd.group()[0]}): expected text"]
    if b'"' not in body and b"\r" not in body:
        lengths = [line.count(b",") + 1 for line in body.split(NEWLINE)[:-1]]
    else:
        try:
            lengths = [len(cells) for cells in _cells(body)]
        except csv.Error as error:
            return [f"{name}: not comma-separated values ({error})"]
    return [
        f"{name}: row {row}: {count} of {width} values: expected a whole row"
        for row, count in enumerate(lengths, start=2)
        if count != width
    ]


def _parse(joined: bytes, columns: Mapping[str, str], group: Sequence[Source]) -> pd.DataFrame:
    """Parse at full speed; on any surprise look for the values at fault one by one."""
    numeric = {name: "float64" for name, kind in columns.items() if kind in ("integer", "number")}
    texts = {name: "str" for name, kind in columns.items() if name not in numeric}
    try:
        frame = pd.read_csv(
            io.BytesIO(joined),
            usecols=list(columns),
            dtype=numeric | texts,
            keep_default_na=False,
            skip_blank_lines=False,
            na_values={name: [""] for name in numeric},
        )[list(columns)]
    except ValueError:
        raise DataError(_value_problems(group, columns)) from None
    odd = any(_odd(frame[name], kind) for name, kind in columns.items())
    if odd:
        raise DataError(_value_problems(group, columns))
    for name, kind in columns.items():
        if kind == "boolean":
            frame[name] = frame[name].map({"true": 1.0, "false": 0.0, "": np.nan}).astype("float64")
        elif kind == "text" and frame[name].nunique() < len(frame) / 2:
            frame[name] = frame[name].astype("category")
    return frame


def _odd(values: pd.Series, kind: str) -> bool:
    """Whether a parsed column holds a value that its type does not allow."""
    if kind == "boolean":
        return not bool(values.isin(["true", "false", ""]).all())
    if kind == "text":
        return False
    known = values.to_numpy()[~np.isnan(values.to_numpy())]
    if not np.all(np.isfinite(known)):
        return True
    return kind == "integer" and bool(np.any(known != np.round(known)))


def _value_problems(group: Sequence[Source], columns: Mapping[str, str]) -> list[str]:
    """Every value that its column's type does not allow, by file and row."""
    problems = []
    for source in group:
        rows = csv.DictReader(io.StringIO(source.data.decode("utf-8"), newline=""))
        for number, row in enumerate(rows, start=2):
            problems += [
                f"{source.name}: row {number}: {name} = {row[name]!r}: expected {WANTED[kind]}"
                for name, kind in columns.items()
                if kind != "text" and not allowed(row[name], kind)
            ]
    if not problems:  # the parser refused what the slow reader takes: say at least where
        problems = [f"{group[0].name}: cannot be read as comma-separated values"]
    return problems


def allowed(text: str, kind: str) -> bool:
    """Whether a CSV cell fits its column's type; an empty one does."""
    if text == "":
        return True
    if kind == "boolean":
        return text in ("true", "false")
    try:
        number = float(text)
    except ValueError:
        return False
    return bool(np.isfinite(number)) and (kind == "number" or number == round(number))
