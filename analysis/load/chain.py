"""The hash chain over a trial table's rows: a changed byte is found and named.

A table with a chain ends in the column `chain`: in each row the SHA-256, in hexadecimal, of the
value in the row before followed by the row's own text up to (without) the comma before `chain`.
The sidecar's `chain.start` stands before the first row; it is itself made from the sidecar and the
table's header. The session's end file, if the session was closed, holds the last value and the
hashes of the session's other tables. Traces are not read by a report, and not checked by it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.errors import DataError
from analysis.load.table import Source

COLUMN = "chain"
END = "_end.json"


@dataclass(frozen=True, slots=True)
class ChainState:
    """`state`: verified, open (verified, but the session was never closed), or none."""

    file: str
    state: str


def link(before: str, text: str) -> str:
    """The chain's value for a row."""
    return hashlib.sha256((before + text).encode("utf-8", "replace")).hexdigest()


def start_of(sidecar: Mapping[str, Any], header: str) -> str:
    """Where a chain starts: the sidecar, but for `chain.start` itself, and the header."""
    chain = {key: value for key, value in sidecar["chain"].items() if key != "start"}
    plain = json.dumps({**sidecar, "chain": chain}, sort_keys=True, ensure_ascii=False)
    return link(plain, header)


def verify(source: Source, sidecar: Mapping[str, Any], folder: Path) -> ChainState:
    """Check header, sidecar, every row and the session's end.

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
    return ChainState(source.name, _verify_end(source.name, before, folder))


def _verify_end(name: str, last: str, folder: Path) -> str:
    """The end file against the table and the session's other tables."""
    path = folder / name.replace("_trials_data.csv", END)
    if not path.is_file():
        return "open"
    try:
        end = json.loads(path.read_bytes())
        files = dict(end["files"])
    except (ValueError, KeyError, TypeError, RecursionError):
        raise DataError(f"{path.relative_to(folder)}: expected a session's end, as JSON") from None
    if end.get("chain") != last:
        raise DataError(f"{name}: rows at its end were removed or added, or {path.name} changed")
    for other, digest in files.items():
        if not other.endswith("_data.csv"):
            continue
        table = path.parent / Path(other).name
        if not table.is_file():
            raise DataError(f"{table.relative_to(folder)}: removed after the session")
        if hashlib.sha256(table.read_bytes()).hexdigest() != digest:
            raise DataError(f"{table.relative_to(folder)}: changed after the session")
    return "verified"
