"""Makes malformed study files: case number → the same file on every machine.

What a case breaks is known, so that the program has to refuse it; only the cases called "bytes" may
by chance leave a valid study, and some that are called "as saved" have to.
"""

from __future__ import annotations

import codecs
import copy
import datetime
import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import broken_scenes
import numpy as np
from broken_own import OWN

from seethrough.experiment.study.config import find
from seethrough.experiment.study.tables.keys import keys_of
from seethrough.experiment.study.tables.study_tables import TABLES

Table = dict[str, Any]
BASE = tomllib.loads(find("published").read_text("utf-8"))
BASE["questions"]["consent"]["file"] = ""
PLAIN = ("study", "design", "display", "session", "analysis", "practice")  # no table in a table
BASE["texts"] = {"welcome.text": "Hello."}
NASTY = (
    "\n", "\r\n", "\x1b[2J", "\0", "\u2028", "\x85", "é", "𝔘", "a\nTraceback", "=1+1", "..", "",
    " ", "{x}", "%s", "a" * 5000, "\\", '"', "'", "\u202e",
)  # fmt: skip
NUMBERS = (float("nan"), float("inf"), -float("inf"), -1, -0.5, -1e300, -(10**30), -(2**63))
OTHERS: dict[type, tuple[Any, ...]] = {
    bool: (0, 1, "true", [True], {"x": 1}, 1.5),
    int: (1.5, "3", True, [1], {"x": 1}, datetime.date(2026, 1, 2), "\x1b[2J"),
    float: ("0.5", True, [0.5], {"x": 1}, datetime.time(1, 2), "\n"),
    str: (3, 0.5, True, ["a"], {"x": 1}, datetime.datetime(2026, 1, 2, 3, 4)),
    list: (3, 0.5, True, "count", {"x": 1}, [[1]], [{}], [None]),
    dict: (3, 0.5, True, "none", [1], datetime.date(2026, 1, 2)),  # a table within a table
}


@dataclass(frozen=True)
class Case:
    """A study file's bytes, what was done to them, and whether it must be refused; `faults` are the
    keys that have to be named, each in a line."""

    kind: str
    what: str
    data: bytes
    must_fail: bool = True
    faults: tuple[str, ...] = ()
    beside: Mapping[str, bytes] = field(default_factory=dict)


def case(number: int) -> Case:
    """The case of a number."""
    rng = np.random.default_rng(np.random.SeedSequence(20261122, spawn_key=(number,)))
    kinds = list(KINDS)
    kind = kinds[number % len(kinds)]
    return KINDS[kind](kind, rng)


def _pick(rng: np.random.Generator, options: Any) -> Any:
    return options[int(rng.integers(len(options)))]


def _tables(study: Table) -> list[tuple[str, Table]]:
    """The tables whose keys each have a type of their own, by their names."""
    plugins = [
        (f"{kind}.{name}", own)
        for kind in ("technique", "world")
        for name, own in study[kind].items()
        if isinstance(own, dict)
    ]
    return [*((name, study[name]) for name in PLAIN if name in study), *plugins]


def _place(rng: np.random.Generator, study: Table, kind: type | None = None) -> tuple[Table, str]:
    """A random key that holds a value (of a type, if given), and its table."""
    places = [
        (table, key)
        for name, table in _tables(study)
        for key, value in table.items()
        if kind is None or type(value) is kind
    ]
    return _pick(rng, places)


def _done(kind: str, what: str, study: Table) -> Case:
    return Case(kind, what, toml(study).encode("utf-8", "surrogatepass"))


def _unknown_key(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    table = _pick(rng, [study, *(table for _, table in _tables(study))])
    known = _pick(rng, list(table))
    key = _pick(rng, [*NASTY, known + "s", known.upper() + "_", known[1:] + "x", "__class__"])
    table[key] = _pick(rng, [1, "x", [], {}, {"a": {"b": 1}}, True, float("nan"), *NASTY])
    return _done(kind, repr(key), study)


def _wrong_type(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    table, key = _place(rng, study)
    table[key] = _pick(rng, OTHERS[type(table[key])])
    return _done(kind, f"{key} = {table[key]!r}", study)


def _out_of_range(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    table, key = _place(rng, study, _pick(rng, [int, float]))
    table[key] = _pick(rng, NUMBERS if type(table[key]) is float else NUMBERS[3:4] + NUMBERS[6:])
    return _done(kind, f"{key} = {table[key]!r}", study)


def _wrong_item(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    table, key = _place(rng, study, list)
    items = table[key]
    text = isinstance(items[0], str)
    wrong = [3, {}, [], *NASTY] if text else ["x", {}, [], *NUMBERS, True]
    items[int(rng.integers(len(items)))] = _pick(rng, wrong)
    if rng.random() < 0.2:
        items.extend(items * 40)
    return _done(kind, f"{key} = {items!r:.60}", study)


def _wrong_text(kind: str, rng: np.random.Generator) -> Case:
    """Texts with rules: names, languages, addresses, files, and texts that there are not."""
    study = copy.deepcopy(BASE)
    rule = _pick(rng, ["name", "title", "language", "ledger", "consent", "texts"])
    nasty = str(_pick(rng, NASTY))
    if rule == "name":
        study["study"]["name"] = _pick(rng, ["a b", "../x", "é", "x" * 33, "a_b", "", nasty + "!"])
    elif rule == "title":
        study["study"]["title"] = _pick(rng, ["", "x" * 201])
    elif rule == "language":
        study["study"]["language"] = _pick(rng, ["zz", "EN", "english", "../en", nasty])
    elif rule == "ledger":
        study["session"]["ledger"] = _pick(rng, ["mysql://x", "u:secret@h", "file:/x", nasty + "/"])
    elif rule == "consent":
        wrong = [p for p in (*NASTY, "nothing.txt", "/", "/dev/null/x", "x/" * 3000) if p]
        study["questions"]["consent"]["file"] = _pick(rng, wrong)
    else:
        study["texts"][_pick(rng, [n for n in NASTY if n] + ["welcome", "x.y"])] = "Hello."
    return _done(kind, rule, study)


def _missing(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    required = ("name", "title", "description", "participants", "seed")
    if rng.random() < 0.2:
        what = "study"
        del study[what]
    else:
        what = _pick(rng, required)
        del study["study"][what]
    return _done(kind, what, study)


def _no_table(kind: str, rng: np.random.Generator) -> Case:
    study = copy.deepcopy(BASE)
    name = _pick(rng, list(study))
    study[name] = _pick(rng, [1, "x", [1], True, datetime.date(2026, 1, 2), [{"a": 1}], 0.5])
    return _done(kind, f"{name} = {study[name]!r}", study)


def _no_toml(kind: str, rng: np.random.Generator) -> Case:
    """A valid file with something that TOML never allows."""
    lines = toml(BASE).split("\n")
    at = int(rng.integers(len(lines)))
    wrong = _pick(
        rng,
        [
            "= 3", "a b = 1", "a = ", "a = [1,", '"a = 1', "[", "[x", "a = 1 2", "\0", "a = 01",
            "]", "x = " + "[" * 5000, "x = " + "{a=" * 3000, "a = 1\na = 2", "[study]\n[study]",
            "a\x7f", "x = 2026-13-99", "x = '\x01'", "x = \"\\q\"", "\x1b]0;title\x07", "a = +-1",
        ],
    )  # fmt: skip
    return Case(kind, repr(wrong[:20]), "\n".join([*lines[:at], wrong, *lines[at:]]).encode())


def _not_utf8(kind: str, rng: np.random.Generator) -> Case:
    data = toml(BASE).encode()
    at = int(rng.integers(len(data)))
    wrong = _pick(rng, [b"\xff", b"\xc3(", b"\xed\xa0\x80", b"\x80", b"\xf8\x88", b"\xc0\xaf"])
    return Case(kind, repr(wrong), data[:at] + wrong + data[at:])


def _bytes(kind: str, rng: np.random.Generator) -> Case:
    """Cut, doubled, exchanged bytes: most are no TOML any more, the rest may be a study."""
    data = bytearray(toml(BASE).encode())
    for _ in range(int(rng.integers(1, 6))):
        a, b = sorted(int(v) for v in rng.integers(len(data), size=2))
        how = rng.integers(4)
        if how == 0:
            del data[a : a + int(rng.integers(1, 40))]
        elif how == 1:
            data[a] = int(rng.integers(256))
        elif how == 2:
            data[a:a] = data[b : b + 20]
        elif rng.random() < 0.3:
            del data[a:]
        data = data or bytearray(b"=")
    return Case(kind, "bytes", bytes(data), must_fail=not _is_table(bytes(data)))


def _several(kind: str, rng: np.random.Generator) -> Case:
    """Up to six faults in one file, each of another key: all of them have to be told."""
    study = copy.deepcopy(BASE)
    faults: dict[str, Any] = {}
    for _ in range(int(rng.integers(2, 7))):
        name, table = _pick(rng, _tables(study))
        key = _pick(rng, list(dict(_tables(BASE))[name]))
        if rng.random() < 0.3:
            key = f"{key}x"
            table[key] = 1
        else:
            table[key] = _pick(rng, OTHERS[type(dict(_tables(BASE))[name][key])])
        faults[f"{name}.{key}"] = table[key]
    if rng.random() < 0.3:
        study["texts"]["welcome.txt"] = "Hello."
        faults["texts.welcome.txt"] = "Hello."
    case = _done(kind, f"{list(faults)}", study)
    return replace(case, faults=tuple(n for n, v in faults.items() if not _by_item(v)))


def _by_item(value: Any) -> bool:
    """Whether what is wrong is an item of it: the line then names key[0]."""
    return isinstance(value, list)


def _every_key(kind: str, rng: np.random.Generator) -> Case:
    """Any key that is declared, set or not: a value of a type that it never has."""
    study = copy.deepcopy(BASE)
    table = _pick(rng, list(TABLES))
    key = _pick(rng, list(keys_of(table)))
    wrong = _pick(rng, [datetime.date(2026, 1, 2), {"x": 1}, [[1]], [{}], [None, 1, 2]])
    study.setdefault(table, {})[key] = wrong
    return _done(kind, f"{table}.{key} = {wrong!r}", study)


def _factor(kind: str, rng: np.random.Generator) -> Case:
    """Every way to write a factor wrongly; what is named is the factor."""
    study = copy.deepcopy(BASE)
    factors = study["factors"]
    own = factors["transparency"]
    values = {"set": "world.abstract.side", "values": [80.0, 100.0]}
    wrong: dict[str, Callable[[], None]] = {
        "unknown key": lambda: own.update(level=3),
        "no levels": lambda: own.clear(),
        "one level": lambda: own["levels"].pop("dynamic"),
        "a level that is no table": lambda: own["levels"].update(dynamic=_pick(rng, [3, "x", []])),
        "unknown table": lambda: own["levels"].update(dynamic={"techniqe": {"use": "dynamic"}}),
        "unknown technique": lambda: own["levels"].update(dynamic={"technique": {"use": "xray"}}),
        "out of range": lambda: own["levels"]["dynamic"]["technique"].update(
            dynamic={"alpha_target": 7.0}),
        "a quoted key": lambda: own["levels"].update(dynamic={"technique.use": "dynamic"}),
        "a fixed key": lambda: own["levels"].update(dynamic={"study": {"seed": 3}}),
        "a session's key": lambda: own["levels"].update(dynamic={"display": {"width": 640}}),
        "a block's key, mixed": lambda: factors["scenario"].update(order="mixed"),
        "one key of two": lambda: factors.update(
            other={"levels": {"a": {"technique": {"use": "dynamic"}}, "b": {}}}),
        "set beside levels": lambda: own.update(set="technique.use"),
        "values beside levels": lambda: own.update(values=[1, 2]),
        "set of nothing": lambda: factors.update(side={"set": "side", "values": [1, 2]}),
        "a value twice": lambda: factors.update(side={**values, "values": [80.0, 80.0]}),
        "one value": lambda: factors.update(side={**values, "values": [80.0]}),
        "mixed types": lambda: factors.update(side={**values, "values": [80.0, "a"]}),
        "a value out of range": lambda: factors.update(side={**values, "values": [80.0, -1.0]}),
        "no order": lambda: own.update(order="random2"),
        "a group's order": lambda: own.update(vary="between", order="latin"),
        "another way": lambda: own.update(vary="across"),
        "people within": lambda: own.update(people=8),
        "people who are not all": lambda: own.update(vary="between", people=3),
        "people of another level": lambda: own.update(vary="between", people={"x": 8}),
        "measured levels": lambda: own.update(vary="measured"),
        "measured set": lambda: factors.update(side={**values, "vary": "measured"}),
        "a baseline that is none": lambda: own.update(baseline="xray"),
        "a label of nothing": lambda: own.update(labels={"xray": "X"}),
        "a column's name": lambda: factors.update(task=own),
        "no name": lambda: factors.update({_pick(rng, ["A", "a b", "9", "é", "x" * 40]): own}),
        "no cell": lambda: study["design"].update(exclude=[{"transparency": "dynamic"}]),
        "no such cell": lambda: study["design"].update(exclude=[{"transparency": "xray"}]),
        "a cell of nothing": lambda: study["design"].update(exclude=[{"view": "xray"}]),
        "too many cells": lambda: factors.update(
            {f"f{n}": {"set": f"world.abstract.{key}", "values": list(range(1, 101))}
             for n, key in enumerate(("objects", "distractors"))}, transparency=own,
        ),
        "fewer people than groups": lambda: (own.update(vary="between"),
            study["study"].update(participants=1)),
    }  # fmt: skip
    what = _pick(rng, list(wrong))
    wrong[what]()
    return _done(kind, what, study)


def _as_saved(kind: str, rng: np.random.Generator) -> Case:
    """As editors save a study: valid with a mark or other line ends, refused in UTF-16 and 32."""
    how = _pick(rng, ["mark", "CRLF", "both", "utf-16", "utf-16-le", "utf-16-be", "utf-32"])
    text = toml(BASE)
    if how in ("mark", "CRLF", "both"):
        data = text.replace("\n", "\r\n" if how != "mark" else "\n").encode()
        return Case(kind, how, codecs.BOM_UTF8 * (how != "CRLF") + data, must_fail=False)
    return Case(kind, how, text.encode(how))


def _twice(kind: str, rng: np.random.Generator) -> Case:
    """A key or a table that stands there twice."""
    lines = toml(BASE).splitlines()
    keys = [i for i, line in enumerate(lines) if " = " in line]
    at = int(_pick(rng, keys))
    if rng.random() < 0.3:
        name = _pick(rng, list(BASE))
        return Case(kind, name, "\n".join([*lines, f'["{name}"]']).encode())
    return Case(kind, lines[at], "\n".join([*lines[: at + 1], *lines[at:]]).encode())


def _is_table(data: bytes) -> bool:
    try:
        tomllib.loads(data.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError):
        return False
    return True


def _scene(kind: str, rng: np.random.Generator) -> Case:
    """A table of a scene, its tags or its items."""
    what, scene = broken_scenes.broken(rng)
    study = copy.deepcopy(BASE)
    study["world"]["scene"] = scene
    return _done(kind, what, study)


def _own(kind: str, rng: np.random.Generator) -> Case:
    """Of what a study may bring along: broken_own.py."""
    what, study, beside = OWN[kind](BASE, rng)
    return replace(_done(kind, what, study), beside=beside)


KINDS: dict[str, Callable[[str, np.random.Generator], Case]] = {
    "unknown key": _unknown_key,
    "wrong type": _wrong_type,
    "out of range": _out_of_range,
    "wrong item": _wrong_item,
    "wrong text": _wrong_text,
    "missing": _missing,
    "no table": _no_table,
    "no TOML": _no_toml,
    "not UTF-8": _not_utf8,
    "bytes": _bytes,
    "several": _several,
    "every key": _every_key,
    "factor": _factor,
    "as saved": _as_saved,
    "twice": _twice,
    "scene": _scene,
    **dict.fromkeys(OWN, _own),
}


def toml(study: Table) -> str:
    """A table as TOML: plain values first, then its tables."""
    flat = {k: v for k, v in study.items() if not isinstance(v, dict)}
    lines = [f"{_key(k)} = {_value(v)}" for k, v in flat.items()]
    for name, table in study.items():
        if isinstance(table, dict):
            lines.append(f"[{_key(name)}]")
            lines += [f"{_key(k)} = {_value(v)}" for k, v in table.items()]
    return "\n".join(lines) + "\n"


def _key(key: str) -> str:
    return _text(key)


def _text(text: str) -> str:
    quoted = json.dumps(text, ensure_ascii=True)
    # JSON writes letters beyond 16 bits as pairs of escapes, which TOML does not know.
    return quoted if text.isascii() else '"' + "".join(f"\\U{ord(c):08X}" for c in text) + '"'


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if value is None:
        return '"None"'
    if isinstance(value, float):
        return {"inf": "inf", "-inf": "-inf", "nan": "nan"}.get(repr(value), repr(value))
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return value.isoformat() if hasattr(value, "isoformat") else repr(value)
