"""Tables of a config that are parameters of a scene or a technique: frozen dataclasses that check
themselves. Here their keys and types are checked first, so that every message names its key."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, get_type_hints

from pydantic import BeforeValidator, TypeAdapter, ValidationError


def from_table(cls: type) -> BeforeValidator:
    """A validator that makes a `cls` of a table. Its ValueErrors read "key = value: expected …"."""
    types = get_type_hints(cls)
    names = [f.name for f in dataclasses.fields(cls)]

    def build(table: Any) -> Any:
        if not isinstance(table, Mapping):
            return table  # pydantic says that it is not a table
        values = {}
        for name, value in table.items():
            if name not in names:
                raise ValueError(
                    f"{name:.60} = {_short(value)}: unknown key; known: {', '.join(names)}"
                )
            values[name] = _checked(name, value, types[name])
        try:
            return cls(**values)
        except ValueError as error:
            # Techniques put their own name first; the table's name stands there already.
            raise ValueError(str(error).rpartition(": ")[2]) from None

    return BeforeValidator(build)


def _checked(name: str, value: Any, hint: Any) -> Any:
    plain = tuple(value) if isinstance(value, list) else value
    try:
        return TypeAdapter(hint, config={"strict": True}).validate_python(plain)
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]["msg"].removeprefix("Input should be ")
        reason = reason.replace("Tuple should have", "an array of").replace(" after validation", "")
        raise ValueError(f"{name} = {_short(value)}: expected {reason}") from None


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"
