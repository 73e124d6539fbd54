"""What parameters declare of themselves: meaning, unit and what is allowed, once for the check of a
value, the words of a message and the reference of keys (docs/keys.md)."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import EllipsisType, UnionType
from typing import (
    ClassVar,
    Protocol,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from seethrough.renderer.meant import meant

Value = TypeVar("Value")


class Declares(Protocol):
    """Parameters: a frozen dataclass whose fields declare themselves."""

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[object]]]

    def __init__(self, **values: object) -> None: ...


@dataclasses.dataclass(frozen=True)
class Of:
    """A limit that follows from other parameters, and how one says it, with their `names`."""

    said: str
    value: Callable[[Mapping[str, float]], float]

    @property
    def names(self) -> set[str]:
        """The parameters that it follows from."""
        return set(self.said.split("`")[1::2])


@dataclasses.dataclass(frozen=True)
class Key:
    """What is declared of a parameter. `low` and `high` are allowed themselves; of a pair of
    numbers both keep to them, and the first is at most the second unless it is a `point`."""

    meaning: str
    unit: str = ""
    low: float | None = None
    high: float | Of | None = None
    choices: tuple[str, ...] = ()
    point: bool = False
    said: str = ""  # what is allowed, where neither limits nor choices say it
    shown: bool = False  # whether participants read it: a text that a study's language translates


def key(
    default: Value | EllipsisType,
    meaning: str,
    unit: str = "",
    *,
    low: float | None = None,
    high: float | Of | None = None,
    choices: tuple[str, ...] = (),
    point: bool = False,
    said: str = "",
    shown: bool = False,
) -> Value:
    """A field of a frozen dataclass with what is declared of it; default ... for none.

    Its type is the value's, as that of `dataclasses.field` is.
    """
    metadata = {"key": Key(meaning, unit, low, high, choices, point, said, shown)}
    if isinstance(default, EllipsisType):
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


def declared(cls: type[Declares]) -> dict[str, Key]:
    """Name → declaration of the parameters that a study may set, in their order."""
    return {f.name: f.metadata["key"] for f in dataclasses.fields(cls) if "key" in f.metadata}


def allowed(hint: object, said: Key, values: Mapping[str, object] | None = None) -> str:
    """What a value of this type may be, in words: "a number from 0 to 1". With the values of all
    parameters, limits that follow from others come with their value."""
    plain, optional = _plain(hint)
    if said.said:
        return said.said
    if said.choices:
        one = ", ".join(f'"{c}"' for c in said.choices)
        return f"an array of some of {one}, each once" if _many(plain) else f"one of {one}"
    words = _words(plain, said, values)
    return f"{words}, or no such key" if optional else words


def _words(plain: object, said: Key, values: Mapping[str, object] | None) -> str:
    if get_origin(plain) is tuple:
        inner = get_args(plain)
        if _many(plain):
            return "an array of texts" if inner[0] is str else "an array of tables"
        if said.point:
            return f"[x, y], numbers{_limits(said, values)}"
        return f"[lowest, highest], {'whole ' * (inner[0] is int)}numbers{_limits(said, values)}"
    kinds: dict[object, str] = {
        int: "a whole number",
        float: "a number",
        bool: "true or false",
        str: "text",
    }
    return f"{kinds[plain]}{_limits(said, values)}"


def _limits(said: Key, values: Mapping[str, object] | None) -> str:
    high = said.high
    if said.low is None or high is None:
        return ""
    if isinstance(high, Of):
        most = high.said if values is None else f"{high.said} ({_most(high, values):g})"
    else:
        most = _number(high)
    return f" from {_number(said.low)} to {most}"


def _number(value: float) -> str:
    """10000 rather than 1e+04."""
    return str(int(value)) if float(value).is_integer() and abs(value) < 1e9 else f"{value:.4g}"


def problems(
    cls: type[Declares], values: Mapping[str, object], wrong: Iterable[str] = ()
) -> Iterator[tuple[str, object, str]]:
    """(name, value, what was expected) of each of the values that is not allowed.

    Types of tables have been checked. What is `wrong` already is not looked at, nor
    are limits that follow from what is wrong.
    """
    hints, found = get_type_hints(cls), set(wrong)
    follow = {n: s.high.names for n, s in declared(cls).items() if isinstance(s.high, Of)}
    for name, said in sorted(declared(cls).items(), key=lambda item: item[0] in follow):
        value = values[name]
        if name in found or follow.get(name, set()) & found:
            continue
        if (value is None and _plain(hints[name])[1]) or _fits(value, hints[name], said, values):
            continue
        found.add(name)
        yield name, value, allowed(hints[name], said, values) + meant(value, said.choices)


def check(parameters: Declares, owner: str = "") -> None:
    """Raise ValueError, one line for the first parameter that is not allowed."""
    values = {f.name: getattr(parameters, f.name) for f in dataclasses.fields(parameters)}
    for name, value, expected in problems(type(parameters), values):
        shown = list(value) if isinstance(value, tuple) else value
        raise ValueError(f"{owner and f'{owner}: '}{name} = {shown!r}, expected {expected}")


def _fits(value: object, hint: object, said: Key, values: Mapping[str, object]) -> bool:
    plain, _ = _plain(hint)
    if said.choices:
        found = value if _many(plain) and isinstance(value, tuple) else (value,)
        if not all(isinstance(one, str) for one in found):
            return False
        return bool(found) and len(set(found)) == len(found) and set(found) <= {*said.choices}
    if said.low is None:
        return _is_of(value, plain)
    high = _most(said.high, values) if isinstance(said.high, Of) else said.high
    kind = get_args(plain)[0] if get_origin(plain) is tuple else plain
    if get_origin(plain) is not tuple:
        return _within(value, kind, said.low, high)
    if not isinstance(value, tuple) or len(value) != 2:
        return False
    inside = all(_within(v, kind, said.low, high) for v in value)
    return inside and (said.point or value[0] <= value[1])


def _is_of(value: object, plain: object) -> bool:
    """Whether it is of its type, where that is one of the plain ones."""
    if plain is bool or plain is str:
        return isinstance(value, bool if plain is bool else str)
    if _many(plain) and get_args(plain)[0] is str:
        return isinstance(value, tuple) and all(isinstance(one, str) for one in value)
    return True


def _most(high: Of, values: Mapping[str, object]) -> float:
    """A limit that follows from the numbers among other parameters."""
    return high.value({n: v for n, v in values.items() if isinstance(v, int | float)})


def _within(value: object, kind: object, low: float, high: float | None) -> bool:
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    if kind is int and not isinstance(value, int):
        return False
    return math.isfinite(value) and low <= value and (high is None or value <= high)


def _plain(hint: object) -> tuple[object, bool]:
    """The type without None, and whether None was among it."""
    if get_origin(hint) in (Union, UnionType):
        inner = [h for h in get_args(hint) if h is not type(None)]
        return inner[0], len(inner) < len(get_args(hint))
    return hint, False


def _many(hint: object) -> bool:
    return get_origin(hint) is tuple and Ellipsis in get_args(hint)
