"""Tables of a config that are parameters of a scene or a technique: frozen dataclasses that check
themselves. Here their keys and types are checked first, and all that is wrong is found at once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, NamedTuple, TypeVar, get_args, get_origin, get_type_hints

from pydantic import TypeAdapter, ValidationError

from seethrough.renderer.declared import Declares, Key, allowed, declared, problems


class Fault(NamedTuple):
    """What is wrong with a key: its value, and what was expected; `known` keys for an unknown one,
    MISSING for a value that there is not."""

    key: str
    value: object
    expected: str = ""
    known: tuple[str, ...] = ()


MISSING = object()


Made = TypeVar("Made", bound=Declares)


class Faults(ValueError):
    """All that is wrong with a table."""

    def __init__(self, found: list[Fault]) -> None:
        self.found = found
        super().__init__(f"{len(found)} faults")


def built(cls: type[Made], table: Mapping[str, object]) -> Made:
    """A `cls` of a table. Raises Faults, all that is wrong with it."""
    types, keys = get_type_hints(cls), declared(cls)
    values: dict[str, object] = {f.name: f.default for f in dataclasses.fields(cls)}
    found: list[Fault] = []
    for name, value in table.items():
        if name not in keys:
            found.append(Fault(name, value, known=tuple(keys)))
            continue
        try:
            values[name] = _checked(name, value, types[name], keys[name])
        except Faults as faults:
            found += faults.found
    wrong = {fault.key.partition("[")[0] for fault in found}
    absent = [n for n in keys if n not in table and values[n] is dataclasses.MISSING]
    found += [Fault(name, MISSING, allowed(types[name], keys[name])) for name in absent]
    found += [Fault(*problem) for problem in problems(cls, values, {*wrong, *absent})]
    if found:
        raise Faults(found)
    try:
        return cls(**values)
    except ValueError as error:  # of several keys together: "key = value, expected …"
        key, _, rest = str(error).rpartition(": ")[2].partition(" = ")
        raise Faults([Fault(key, values[key], rest.partition(", expected ")[2])]) from None


def _checked(name: str, value: object, hint: Any, said: Key) -> object:
    plain = tuple(value) if isinstance(value, list) else value
    inner = get_args(hint)[0] if get_origin(hint) is tuple else None
    if isinstance(plain, tuple) and isinstance(inner, type) and dataclasses.is_dataclass(inner):
        return _items(name, plain, inner)
    try:
        return TypeAdapter(hint, config={"strict": True}).validate_python(plain)
    except ValidationError:
        raise Faults([Fault(name, value, allowed(hint, said))]) from None


def _items(name: str, items: tuple[object, ...], cls: type[Made]) -> tuple[Made, ...]:
    """The entries of an array of tables."""
    made: list[Made] = []
    found: list[Fault] = []
    for number, item in enumerate(items):
        where = f"{name}[{number}]"
        if not isinstance(item, Mapping):
            found.append(Fault(where, item, "a table"))
            continue
        try:
            made.append(built(cls, item))
        except Faults as faults:
            found += [fault._replace(key=f"{where}.{fault.key}") for fault in faults.found]
    if found:
        raise Faults(found)
    return tuple(made)
