"""Whether a glTF file's JSON is what its specification says, before anything is made of it.

What is read of each object stands in gltf_json; this asks those declarations. Every whole number of
the format counts something or names it, so none is negative; every other number is finite.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Required, get_args, get_origin, get_type_hints, is_typeddict

from seethrough.renderer.models.files import gltf_json
from seethrough.renderer.models.files.part import LARGEST
from seethrough.renderer.models.files.source import Refused

_WORDS: Mapping[object, str] = {
    int: "a whole number of at least 0",
    float: f"a finite number smaller than {LARGEST:g}",
    str: "text",
    bool: "true or false",
}


def check_json(table: Mapping[str, object]) -> None:
    """Raises Refused for the first value that is not what it should be, by its place."""
    for kind in gltf_json.KINDS:
        if kind.name in table:
            rows = table[kind.name]
            if not isinstance(rows, list):
                raise _wrong(kind.name, rows, "an array")
            for number, row in enumerate(rows):
                _check(row, kind.row, f"{kind.name}[{number}]")
    asset = table.get("asset", {})
    if not isinstance(asset, dict):
        raise _wrong("asset", asset, "an object")
    for name in ("extensionsRequired", "extensionsUsed"):
        _check(table.get(name, []), list[str], name)


def _check(value: object, expected: object, where: str) -> None:
    if expected is object:
        return
    if isinstance(expected, type) and is_typeddict(expected):
        _check_object(value, expected, where)
    elif get_origin(expected) is list:
        if not isinstance(value, list):
            raise _wrong(where, value, "an array")
        for number, item in enumerate(value):
            _check(item, get_args(expected)[0], f"{where}[{number}]")
    elif get_origin(expected) is Mapping:
        if not isinstance(value, dict):
            raise _wrong(where, value, "an object")
        for name, item in value.items():
            _check(item, get_args(expected)[1], f"{where}.{name[:40]}")
    elif not _is_plain(value, expected):
        raise _wrong(where, value, _WORDS[expected])


def _check_object(value: object, expected: type, where: str) -> None:
    if not isinstance(value, dict):
        raise _wrong(where, value, "an object")
    for name, (kind, needed) in _members(expected).items():
        if name in value:
            _check(value[name], kind, f"{where}.{name}")
        elif needed:
            raise Refused(f"{where}.{name}: missing, expected {_word(kind)}")


@cache
def _members(expected: type) -> Mapping[str, tuple[object, bool]]:
    """Name → what it is, and whether it has to be there."""
    total = getattr(expected, "__total__", True)
    found: dict[str, tuple[object, bool]] = {}
    for name, hint in get_type_hints(expected, include_extras=True).items():
        needed = get_origin(hint) is Required
        found[name] = (get_args(hint)[0] if needed else hint, needed or total)
    return MappingProxyType(found)


def _is_plain(value: object, expected: object) -> bool:
    if expected is str:
        return isinstance(value, str)
    if isinstance(value, bool) or expected is bool:
        return isinstance(value, bool) and expected is bool
    if expected is int:
        return isinstance(value, int) and value >= 0
    return isinstance(value, int | float) and abs(value) < LARGEST  # NaN is not less either


def _word(kind: object) -> str:
    if is_typeddict(kind) or get_origin(kind) is Mapping:
        return "an object"
    return _WORDS.get(kind, "an array")


def _wrong(where: str, value: object, expected: str) -> Refused:
    shown = json.dumps(value, ensure_ascii=False)
    shown = shown if len(shown) <= 40 else f"{shown[:40]}…"
    return Refused(f"{where} = {shown}: expected {expected}")
