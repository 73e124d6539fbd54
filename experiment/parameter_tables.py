"""Tables of a config that are parameters of a scene or a technique: frozen dataclasses that check
themselves. Here their keys and types are checked first, so that every message names its key."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, get_args, get_origin, get_type_hints

from pydantic import BeforeValidator, TypeAdapter, ValidationError


def from_table(cls: type) -> BeforeValidator:
    """A validator that makes a `cls` of a table. Its ValueErrors read "key = value: expected …"."""

    def build(table: Any) -> Any:
        # pydantic says of anything else that it is not a table
        return _built(cls, table) if isinstance(table, Mapping) else table

    return BeforeValidator(build)


def _built(cls: type, table: Mapping[str, Any]) -> Any:
    types, fields = get_type_hints(cls), dataclasses.fields(cls)
    names = [f.name for f in fields]
    values = {}
    for name, value in table.items():
        if name not in names:
            raise ValueError(
                f"{name:.60} = {_short(value)}: unknown key; known: {', '.join(names)}"
            )
        values[name] = _checked(name, value, types[name])
    for f in fields:
        if f.name not in values and f.default is f.default_factory is dataclasses.MISSING:
            raise ValueError(f"{f.name} = missing: expected a value")
    try:
        return cls(**values)
    except ValueError as error:
        # Techniques put their own name first; the table's name stands there already.
        raise ValueError(str(error).rpartition(": ")[2]) from None


def _checked(name: str, value: Any, hint: Any) -> Any:
    plain = tuple(value) if isinstance(value, list) else value
    inner = get_args(hint)[0] if get_origin(hint) is tuple else None
    if isinstance(plain, tuple) and dataclasses.is_dataclass(inner):
        return tuple(_item(f"{name}[{i}]", item, inner) for i, item in enumerate(plain))
    try:
        return TypeAdapter(hint, config={"strict": True}).validate_python(plain)
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]["msg"].removeprefix("Input should be ")
        reason = reason.replace("Tuple should have", "an array of").replace(" after validation", "")
        raise ValueError(f"{name} = {_short(value)}: expected {reason}") from None


def _item(name: str, value: Any, cls: Any) -> Any:
    """An entry of an array of tables."""
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} = {_short(value)}: expected a table")
    try:
        return _built(cls, value)
    except ValueError as error:
        raise ValueError(f"{name}.{error}") from None


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"
