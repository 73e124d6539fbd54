"""[factors.NAME] of a study file, read: what is wrong with each is found, all of it at once."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeGuard

from seethrough.experiment.study.design.factors import (
    ALONE,
    BETWEEN,
    CHANGED,
    KINDS,
    MEASURED,
    WITHIN,
    Factor,
    Level,
)
from seethrough.experiment.study.design.squares import MIXED, SQUARES
from seethrough.experiment.study.tables.merge import Path, leaves, nested, overlap
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault
from seethrough.experiment.study.tables.scopes import (
    BLOCK,
    FIXED,
    SESSION,
    changes_scenes,
    scope_of,
    sections,
)
from seethrough.renderer.meant import one_of

FACTOR_KEYS = {  # key → what it may be, what it means
    "levels": ("a table of levels, levels.NAME = { … }",
               "two or more; each is the part of a study that holds there"),
    "set": ('a key, as "world.abstract.objects"', "the one key that `values` are of"),
    "values": ("an array of numbers, of texts, or of true and false",
               "short for levels that differ in one key; alone for a measured factor"),
    "vary": ('one of "within", "between", "measured"',
             "whether each person meets all levels, is assigned one, or brings one along"),
    "people": ("a whole number, or one for each level, as { a = 10, b = 4 }",
               "how many people each level of a between or measured factor has"),
    "order": ('one of "williams", "latin", "fixed", "random", "mixed"',
              "a square of its own; mixed: from trial to trial within a block; none: the design's"),
    "baseline": ("a level", "what the others are compared with; none: the first"),
    "labels": ("a table of level and text", "what participants and reports read of a level"),
    "text": ("text", "what is asked of a person about a measured factor"),
}  # fmt: skip
KEYS = tuple(FACTOR_KEYS)
NAME = re.compile(r"[a-z][a-z0-9_]{0,31}")
NAMED = "a name of 1 to 32 lower-case letters, digits and _, a letter first"
LEVEL = re.compile(r"-?[A-Za-z0-9][A-Za-z0-9_.-]{0,30}")
LEVELLED = "a level's name of 1 to 32 letters, digits, _, . and -"
LONGEST_LABEL = 100
LABELLED = f"text of 1 to {LONGEST_LABEL} printable characters"
ORDERS = (*SQUARES, MIXED)
BARE = "a bare dotted key, as in technique.use = …: in quotes it is one name with dots"


def read_factors(
    table: object, reserved: Sequence[str], people: int | None
) -> tuple[tuple[Factor, ...], list[Fault]]:
    """The factors of [factors], and all that is wrong with them.

    `reserved` are names of columns, which no factor can have; `people` is how many are wanted.
    """
    if not isinstance(table, Mapping):
        return (), [Fault("factors", table, "a table for each factor, [factors.NAME]")]
    found: list[Factor] = []
    faults: list[Fault] = []
    for name, own in table.items():
        where = f"factors.{name}"
        if not NAME.fullmatch(name) or name in reserved:
            said = f"another name: {name} is a column" if name in reserved else NAMED
            faults.append(Fault("factors", name, said))
        elif not isinstance(own, Mapping):
            faults.append(Fault(where, own, f"a table, [{where}]"))
        else:
            reader = _Reader(name, own, people)
            factor = reader.factor()
            faults += reader.faults
            found += [factor] if factor is not None and not reader.faults else []
    faults += _clashes(found)
    return tuple(found), faults


class _Reader:
    """One factor's table while it is read."""

    def __init__(self, name: str, table: Mapping[str, object], people: int | None) -> None:
        self.name, self.table, self.people = name, table, people
        self.where = f"factors.{name}"
        self.faults: list[Fault] = []

    def wrong(self, key: str, value: object, expected: str) -> None:
        self.faults.append(Fault(f"{self.where}.{key}", value, expected))

    def factor(self) -> Factor | None:
        """The factor, as far as it can be read."""
        for key, value in self.table.items():
            if key not in KEYS:
                self.faults.append(Fault(f"{self.where}.{key}", value, known=KEYS))
        kind = self._choice("vary", KINDS, WITHIN)
        order = self._choice("order", ORDERS, "")
        if order and kind != WITHIN:
            self.wrong("order", order, f"no order where a factor varies {kind}")
        levels = self._values(kind) if "values" in self.table else self._levels(kind)
        if len(levels) < 2:
            if not self.faults:
                key = "values" if "values" in self.table else "levels"
                self.wrong(key, [level.name for level in levels], "two levels or more")
            return None
        names = [level.name for level in levels]
        self._scopes(levels, kind, order)
        paths = [path for level in levels for path, _ in leaves(level.part)]
        scenes = CHANGED if any(map(changes_scenes, paths)) else ALONE
        baseline = self._level("baseline", names)
        return Factor(
            self.name, self._labelled(levels), kind, order, baseline or names[0], scenes,
            self._people(kind, names), self._text("text", ""),
        )  # fmt: skip

    def _levels(self, kind: str) -> tuple[Level, ...]:
        if "set" in self.table:
            self.wrong("set", self.table["set"], "no set beside levels: `set` goes with `values`")
        if "levels" not in self.table:
            self.wrong("levels", MISSING, "levels.NAME = { … }, two or more, or set and values")
            return ()
        if kind == MEASURED:
            self.wrong("levels", "…", "values alone: a measured factor sets no key")
            return ()
        table = self.table["levels"]
        if isinstance(table, list) and all(isinstance(level, Level) for level in table):
            return tuple(table)  # of a sidecar
        if not isinstance(table, Mapping):
            self.wrong("levels", table, "levels.NAME = { … }, two or more")
            return ()
        found = []
        for name, part in table.items():
            where = f"levels.{name}"
            if not LEVEL.fullmatch(name):
                self.wrong("levels", name, LEVELLED)
            elif not isinstance(part, Mapping):
                self.wrong(where, part, "a part of a study, as { technique.use = … }")
            else:
                found.append(Level(name, part))
        return tuple(found)

    def _values(self, kind: str) -> tuple[Level, ...]:
        if "levels" in self.table:
            self.wrong("values", self.table["values"], "either levels or values, not both")
        values = self.table["values"]
        if not isinstance(values, list):
            self.wrong("values", values, "an array of two values or more")
            return ()
        path = self._set(kind)
        kinds = {_kind(value) for value in values}
        if "" in kinds or len(kinds) > 1:
            self.wrong("values", values, "numbers, or texts, or true and false: one type")
            return ()
        found: list[Level] = []
        for number, value in enumerate(values):
            name = level_name(value)
            if not LEVEL.fullmatch(name):
                self.wrong(f"values[{number}]", value, LEVELLED)
            elif name in [level.name for level in found]:
                self.wrong(f"values[{number}]", value, "each level once")
            else:
                own = float(value) if _kind(value) == "number" else None
                found.append(Level(name, nested(path, value) if path else {}, number=own))
        return tuple(found)

    def _set(self, kind: str) -> Path:
        """The one key that `values` are of."""
        said = self.table.get("set")
        if kind == MEASURED:
            if said is not None:
                self.wrong("set", said, "values alone: a measured factor sets no key")
            return ()
        expected = 'the key that the values are of, as "world.abstract.distractors"'
        if not isinstance(said, str) or not all(said.split(".")) or "." not in said:
            self.wrong("set", MISSING if said is None else said, expected)
            return ()
        return tuple(said.split("."))

    def _scopes(self, levels: Sequence[Level], kind: str, order: str) -> None:
        """Every key that a level sets may change with this factor."""
        seen: set[Path] = set()
        for level in levels:
            for path, value in leaves(level.part):
                if path in seen:
                    continue
                seen.add(path)
                key = self._key(level, path)
                if any("." in name for name in path):
                    self.wrong(key, value, BARE)
                elif path[0] not in sections():
                    self.faults.append(Fault(f"{self.where}.{key}", value, known=sections()))
                elif expected := self._out_of_scope(scope_of(path), kind, order):
                    self.wrong(key, value, expected)

    def _key(self, level: Level, path: Path) -> str:
        return "set" if "values" in self.table else ".".join(("levels", level.name, *path))

    @staticmethod
    def _out_of_scope(scope: str, kind: str, order: str) -> str:
        if scope == FIXED:
            return "another key: this one is the same in the whole study"
        if scope == SESSION and kind != BETWEEN:
            return 'vary = "between": this key is the same in a whole session'
        if scope == BLOCK and order == MIXED:
            return "another order: this key is the same in a whole block, and cannot be mixed"
        return ""

    def _people(self, kind: str, names: Sequence[str]) -> tuple[int, ...] | None:
        said = self.table.get("people")
        if said is None:
            return None
        expected = "how many people each level has, as 12 or { a = 10, b = 4 }"
        if kind == WITHIN:
            self.wrong("people", said, "no people: each person meets all levels of this factor")
            return None
        whole = said if isinstance(said, Mapping) else dict.fromkeys(names, said)
        each = {str(n): count for n, count in whole.items() if _count(count)}
        if set(each) != set(names) or len(each) != len(whole):
            self.wrong("people", said, f"{expected}, of {', '.join(names)}")
            return None
        total = sum(each.values())
        if self.people is not None and total != self.people:
            sums = f"(all levels together make {total})"
            self.wrong("people", said, f"{self.people} in all, as study.participants has it {sums}")
        return tuple(each[name] for name in names)

    def _labelled(self, levels: Sequence[Level]) -> tuple[Level, ...]:
        said = self.table.get("labels", {})
        names = [level.name for level in levels]
        if not isinstance(said, Mapping) or not all(isinstance(t, str) for t in said.values()):
            self.wrong("labels", said, 'texts of levels, as { plain = "the plain view" }')
            return tuple(levels)
        taken = {name: name for name in names if name not in said}
        for name, label in said.items():
            where = f"{self.where}.labels.{name}"
            if name not in names:
                self.faults.append(Fault(where, label, known=(*names,)))
            elif not 1 <= len(label) <= LONGEST_LABEL or not label.isprintable():
                self.faults.append(Fault(where, label, LABELLED))
            elif label in taken:
                said_twice = f"another text than that of {taken[label]}"
                self.faults.append(Fault(where, label, said_twice))
            else:
                taken[label] = name
        return tuple(
            Level(lv.name, lv.part, said.get(lv.name, lv.label), lv.number) for lv in levels
        )

    def _level(self, key: str, names: Sequence[str]) -> str:
        value = self.table.get(key, "")
        name = level_name(value) if _kind(value) else ""
        if key in self.table and name not in names:
            self.wrong(key, value, one_of(name, names))
        return name

    def _choice(self, key: str, known: Sequence[str], default: str) -> str:
        value = self.table.get(key, default)
        if key in self.table and value not in known and not (value == "" == default):
            self.wrong(key, value, one_of(value, known))
            return default
        return str(value)

    def _text(self, key: str, default: str) -> str:
        value = self.table.get(key, default)
        if not isinstance(value, str):
            self.wrong(key, value, "text")
            return default
        return value


def level_name(value: object) -> str:
    """The name of the level that a value makes: 80, 0.3, yes."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _kind(value: object) -> str:
    if isinstance(value, bool):
        return "boolean"
    if isinstance(value, int | float):
        return "number"
    return "text" if isinstance(value, str) else ""


def _count(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= 10_000


def _clashes(factors: Sequence[Factor]) -> Iterator[Fault]:
    """Two factors that set one key."""
    setters: list[tuple[Factor, Path]] = []
    for factor in factors:
        own = dict.fromkeys(path for level in factor.levels for path, _ in leaves(level.part))
        for path in own:
            other = next((f for f, p in setters if f is not factor and overlap(p, path)), None)
            if other is not None:
                key = ".".join(path)
                yield Fault(
                    f"factors.{factor.name}", key,
                    f"a key of its own: factors.{other.name} sets it, too",
                )  # fmt: skip
        setters += [(factor, path) for path in own]


def where_set(factor: Factor, level: str, key: str, listed: bool) -> str:
    """How to name a key that a level sets: factor, level, key."""
    if listed:
        return f"factors.{factor.name}.values[{factor.names.index(level)}]"
    return f"factors.{factor.name}.levels.{level}.{key}"
