"""What is wrong with a study file, in words: a line each, every fault at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from seethrough.experiment.errors import MOST, InputError, gathered, short, shown, unknown
from seethrough.experiment.study.tables.keys import keys_of, tables
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault
from seethrough.renderer.meant import meant


def study_error(faults: Sequence[Fault], file: str) -> InputError:
    """All that is wrong with a study, as lines: file: key = value: what was expected.

    Of very many faults the words are made for the first ones only.
    """
    lines = [f"{file}: {_line(fault)}" for fault in islice(faults, MOST)]
    return gathered(lines, len(faults) - len(lines))


def _line(fault: Fault) -> str:
    where, _, name = fault.key.rpartition(".")
    if fault.known:
        # Names that are no names at all are shown, not compared.
        return f"{_name(where, name)} = {shown(fault.value)}: {unknown(name, fault.known)}"
    if fault.value is MISSING:
        return f"{fault.key}: missing, expected {fault.expected}"
    return f"{_name(where, name)} = {shown(fault.value)}: expected {fault.expected}"


def _name(where: str, name: str) -> str:
    return f"{where}.{short(name)}" if where else short(name)


def faults_of(error: ValidationError, section: str, table: Mapping[str, object]) -> list[Fault]:
    """What pydantic found in a table, as faults of its keys."""
    return list(_faults(error.errors(include_url=False), section))


def _faults(errors: Sequence[ErrorDetails], section: str) -> Iterator[Fault]:
    items = {error["loc"][:1] for error in errors if len(error["loc"]) > 1}
    for error in errors:
        if error["loc"] not in items:  # else too short an array, of which wrong items do not count
            yield _of_key(section, error["loc"], error)


def _of_key(section: str, rest: Sequence[int | str], error: ErrorDetails) -> Fault:
    """A fault of a key of one of the session's own tables, or of an item of its array."""
    if len(rest) > 1 and f"{section}.{rest[0]}" in tables():
        if not isinstance(rest[1], int):
            return _of_key(f"{section}.{rest[0]}", rest[1:], error)
        where = f"{section}.{rest[0]}[{rest[1]}]"
        if len(rest) == 2:
            return Fault(where, error["input"], "a table")
        fault = _of_key(f"{section}.{rest[0]}", rest[2:], error)
        return fault._replace(key=fault.key.replace(f"{section}.{rest[0]}", where, 1))
    name, item = str(rest[0]), next((n for n in rest[1:] if isinstance(n, int)), None)
    keys = keys_of(_declared(section))
    if name not in keys:
        return Fault(f"{section}.{name}", error["input"], known=tuple(keys))
    where = f"{section}.{name}" + ("" if item is None else f"[{item}]")
    if error["type"] == "missing":
        return Fault(where, MISSING, keys[name].allowed)
    return Fault(where, error["input"], _expected(error, keys[name].allowed, item is not None))


def _declared(section: str) -> str:
    """The table that declares a section's keys: that of all questions, of every task's limit."""
    table = section.partition(".")[0]
    return f"{table}.NAME" if table in ("questions", "task") and "." in section else section


def _expected(error: ErrorDetails, allowed: str, item: bool) -> str:
    """A validator's own words, an item's choices, or what is declared of the key."""
    if error["type"] == "value_error":
        return error["msg"].removeprefix("Value error, ")
    if error["type"] == "literal_error":
        choices = str(error["ctx"]["expected"])
        near = meant(error["input"], choices.split("'")[1::2])
        return (choices.replace("'", '"') if item else allowed) + near
    if item:
        return "text"
    sizes = {"too_short": "at least", "too_long": "at most"}
    if error["type"] in sizes:
        bound = error["ctx"].get("min_length", error["ctx"].get("max_length"))
        return f"{allowed}, {sizes[error['type']]} {bound}"
    return allowed
