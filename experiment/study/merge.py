"""A level is a part of a study: merged into it table by table, arrays and values replaced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

Path = tuple[str, ...]


def merged(table: Mapping[str, Any], part: Mapping[str, Any]) -> dict[str, Any]:
    """`table` with what `part` says instead; neither is changed."""
    result = dict(table)
    for key, value in part.items():
        old = result.get(key)
        both = isinstance(value, Mapping) and isinstance(old, Mapping)
        result[key] = merged(result[key], value) if both else value
    return result


def leaves(part: Mapping[str, Any], where: Path = ()) -> Iterator[tuple[Path, Any]]:
    """(names, value) of each key that a part sets; an empty table sets itself."""
    for key, value in part.items():
        path = (*where, key)
        if isinstance(value, Mapping) and value:
            yield from leaves(value, path)
        else:
            yield path, value


def nested(path: Path, value: Any) -> dict[str, Any]:
    """The part that sets one key."""
    first, *rest = path
    return {first: nested(tuple(rest), value) if rest else value}


def overlap(a: Path, b: Path) -> bool:
    """Whether one of two keys is the other, or a table that holds it."""
    short = min(len(a), len(b))
    return a[:short] == b[:short]
