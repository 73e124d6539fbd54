"""The hash chain over a table's rows: a changed byte is found and named.

A table may carry a last column `chain`: in each row the SHA-256, in hexadecimal, of the row's
predecessor's value followed by the row's own text up to (without) the comma before `chain`. The
first row's predecessor is the sidecar's `chain.start`; `chain.end` there, once the session is
complete, is the last row's value, so that rows cut off at the end are found too.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from analysis.errors import DataError
from analysis.load.table import Source

COLUMN = "chain"


@dataclass(frozen=True, slots=True)
class ChainState:
    """`state`: verified, or none where the table carries no chain."""

    file: str
    state: str
    rows: int
    last: str


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode()).hexdigest()


def verify(source: Source, sidecar: Mapping[str, Any]) -> ChainState:
    """Check every row's value. Raises DataError naming the first row that is not as written."""
    lines = source.data.decode("utf-8").split("\n")
    if lines[0].rstrip("\r").rsplit(",", 1)[-1] != COLUMN:
        return ChainState(source.name, "none", len(lines) - 2, "")
    about = sidecar.get("chain")
    about = about if isinstance(about, Mapping) else {}
    before = str(about.get("start", ""))
    rows = [line.rstrip("\r") for line in lines[1:] if line]
    for number, row in enumerate(rows, start=2):
        text, _, value = row.rpartition(",")
        if value != link(before, text):
            raise DataError(
                f"{source.name}: row {number}: chain = {value[:12]}…: expected "
                f"{link(before, text)[:12]}…: this row or the one before was changed"
            )
        before = value
    end = about.get("end")
    if end is not None and end != before:
        raise DataError(f"{source.name}: row {len(rows) + 1}: rows after this one were removed")
    return ChainState(source.name, "verified", len(rows), before)
