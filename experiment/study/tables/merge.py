"""A level is a part of a study: merged into it table by table, arrays and values replaced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

Path = tuple[str, ...]


def merged(table: Mapping[str, object], part: Mapping[str, object]) -> dict[str, object]:
    """`table` with what `part` says instead; neither is changed."""
    result = dict(table)
    for key, value in part.items():
        old = result.get(key)
        if isinstance(value, Mapping) and isinstance(old, Mapping):
            value = merged(old, value)
        result[key] = value
    return result


def leaves(part: Mapping[str, object], where: Path = ()) -> Iterator[tuple[Path, object]]:
    """(names, value) of each key that a part sets; an empty table sets itself."""
    for key, value in part.items():
        path = (*where, key)
        if isinstance(value, Mapping) and value:
            yield from leaves(value, path)
        else:
            yield path, value


def nested(path: Path, value: object) -> dict[str, object]:
    """The part that sets one key."""
    first, *rest = path
    return {first: nested(tuple(rest), value) if rest else value}


def overlap(a: Path, b: Path) -> bool:
    """Whether one of two keys is the other, or a table that holds it."""
    short = min(len(a), len(b))
    return a[:short] == b[:short]
