"""The JSON files of a data folder as whoever writes there reads them: every fault is a line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.files import read_json, table_in
from seethrough.experiment.errors import InputError, shown


def read_object(path: Path) -> dict[str, object]:
    """A file's JSON object. Raises InputError for what is there and is none."""
    try:
        return read_json(path, path.parent)
    except DataError as error:
        raise InputError(*(f"{path.parent / line}" for line in error.lines)) from None


def number_in(entry: Mapping[str, object], name: str, path: Path) -> int:
    """A whole number from 1 in a file's object. Raises InputError."""
    found = entry.get(name)
    if not isinstance(found, int) or isinstance(found, bool) or found < 1:
        said = f"{name} = {shown(found)}" if name in entry else f"{name}: missing"
        raise InputError(f"{path}: {said}: expected a whole number from 1")
    return found


def part_of(entry: Mapping[str, object], name: str, path: Path) -> Mapping[str, object]:
    """An object within a file's object. Raises InputError."""
    try:
        return table_in(entry, name)
    except (KeyError, TypeError):
        said = f"{name} = {shown(entry[name])}" if name in entry else f"{name}: missing"
        raise InputError(f"{path}: {said}: expected a JSON object") from None
