"""The sidecars' `design` entry as a `Design`; every fault of it is one line."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeGuard, TypeVar

from seethrough.analysis import design as d
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.schema import FIXED

ENTRY = "design"
_NUMBER = (int, float)

Value = TypeVar("Value")
Default = TypeVar("Default")


def read_design(entry: object, where: str) -> d.Design:
    """The design that a sidecar holds; `where` names the file. Raises DataError."""
    reader = _Reader(where)
    made = reader.design(entry)
    if reader.lines:
        raise DataError(reader.lines)
    return made


class _Reader:
    """Collects a line for each fault, so that all of them are shown at once."""

    def __init__(self, where: str) -> None:
        self.where = where
        self.lines: list[str] = []

    def wrong(self, path: str, value: object, expected: str) -> None:
        self.lines.append(f"{self.where}: {path} = {value!r}: expected {expected}")

    def value(
        self, table: Mapping[str, object], path: str, key: str, default: Default,
        fits: Callable[[object], TypeGuard[Value]], expected: str,
    ) -> Value | Default:  # fmt: skip
        """`table[key]`, or `default` where it is not there; a line where it does not fit."""
        found = table.get(key)
        if found is None and (default is None or key not in table):
            return default
        if not fits(found):
            self.wrong(f"{path}.{key}", found, expected)
            return default
        return found

    def text(
        self, table: Mapping[str, object], path: str, key: str, default: str | None = ""
    ) -> str:
        if default is None and key not in table:
            self.lines.append(f"{self.where}: {path}.{key}: missing")
            return ""
        return self.value(table, path, key, default or "", _is_text, "a text")

    def choice(
        self, table: Mapping[str, object], path: str, key: str, known: Sequence[str], default: str
    ) -> str:
        def fits(value: object) -> TypeGuard[str]:
            return value in known

        return self.value(table, path, key, default, fits, f"one of {', '.join(known)}")

    def tables(
        self, table: Mapping[str, object], path: str, key: str
    ) -> Iterator[tuple[str, Mapping[str, object]]]:
        """The tables of an array, each with its path."""
        found = table.get(key, [])
        if not isinstance(found, list):
            self.wrong(f"{path}.{key}", found, "an array of tables")
            return
        for i, inner in enumerate(found):
            if isinstance(inner, Mapping):
                yield f"{path}.{key}[{i}]", inner
            else:
                self.wrong(f"{path}.{key}[{i}]", inner, "a table")

    def texts(self, table: Mapping[str, object], path: str, key: str) -> tuple[str, ...]:
        found = table.get(key, [])
        if isinstance(found, str):
            return (found,)
        if not isinstance(found, list) or not all(isinstance(x, str) for x in found):
            self.wrong(f"{path}.{key}", found, "an array of texts")
            return ()
        return tuple(found)

    def design(self, entry: object) -> d.Design:
        if not isinstance(entry, Mapping):
            self.wrong(ENTRY, entry, "a table")
            return d.NO_DESIGN
        factors = tuple(self.factor(t, p) for p, t in self.tables(entry, ENTRY, "factors"))
        tasks = tuple(self.task(t, p) for p, t in self.tables(entry, ENTRY, "tasks"))
        for what, names in (("factors", [f.name for f in factors]),
                            ("tasks", [t.name for t in tasks])):  # fmt: skip
            for name in sorted({n for n in names if names.count(n) > 1}):
                self.wrong(f"{ENTRY}.{what}", name, "each name once")
        known = {f.name: f.levels for f in factors}
        excluded = tuple(self.cell(t, p, known) for p, t in self.tables(entry, ENTRY, "excluded"))
        made = d.Design(factors, tasks, excluded, items=self.items(entry))
        stated = tuple(
            self.prediction(t, p, made) for p, t in self.tables(entry, ENTRY, "predictions")
        )
        own = self.with_margins(tasks, stated)
        selected = self.text(entry, ENTRY, "selected")
        return d.Design(factors, own, excluded, stated, made.items, selected)

    def with_margins(
        self, tasks: tuple[d.Task, ...], stated: tuple[d.Prediction, ...]
    ) -> tuple[d.Task, ...]:
        """The measures with the margins that the study's predictions declare of them."""
        margins = {
            name: (value, p.ratio) for p in stated for name, value in (p.margin or {}).items()
        }
        measures = [m for t in tasks for m in t.measures]
        known = {m.column: m for m in measures} | {m.name: m for m in measures}
        for name, (value, ratio) in margins.items():
            above = 1 if ratio or (name in known and known[name].log) else 0
            if name not in known:
                self.wrong(f"{ENTRY}.predictions.margin", name, f"a measure: {', '.join(known)}")
            elif not above < value < 1e300:
                self.wrong(f"{ENTRY}.predictions.margin.{name}", value,
                           f"a number above {above}")  # fmt: skip
                return tasks

        def own(m: d.Measured) -> d.Measured:
            name = m.name if m.name in margins else m.column
            if name not in margins:
                return m
            value, ratio = margins[name]
            return replace(m, margin=value, ratio=ratio)

        return tuple(replace(t, measures=tuple(map(own, t.measures))) for t in tasks)

    def factor(self, table: Mapping[str, object], path: str) -> d.Factor:
        name = self.text(table, path, "name", None)
        if name in FIXED:
            self.wrong(f"{path}.name", name, "a name that is no fixed column")
        levels = self.texts(table, path, "levels")
        if len(levels) < 1 or len(set(levels)) < len(levels):
            self.wrong(f"{path}.levels", list(levels), "levels, each once")
            levels = tuple(dict.fromkeys(levels)) or ("?",)

        def fits(value: object) -> TypeGuard[list[float]]:
            if not isinstance(value, list) or len(value) != len(levels):
                return False
            return all(_is_number(x) and not _is_bool(x) for x in value)

        numbers = self.value(table, path, "numbers", None, fits, "a number for each level")
        labels = self.by_level(table, path, "labels")
        tasks = self.by_level(table, path, "tasks")
        return d.Factor(
            name,
            self.choice(table, path, "kind", d.KINDS, d.WITHIN),
            levels,
            self.choice(table, path, "baseline", levels, levels[0]),
            tuple(map(float, numbers)) if numbers is not None else None,
            {level: self.text(labels, f"{path}.labels", level) for level in labels},
            self.choice(table, path, "scenes", ("alone", "changed"), "alone"),
            self.text(table, path, "order"),
            {level: self.texts(tasks, f"{path}.tasks", level) for level in tasks} or None,
        )

    def by_level(self, table: Mapping[str, object], path: str, key: str) -> Mapping[str, object]:
        """A table whose keys are levels; empty where it is not there."""
        found = table.get(key)
        if found is None:
            return {}
        if not isinstance(found, Mapping) or not all(isinstance(level, str) for level in found):
            self.wrong(f"{path}.{key}", found, "a table, by level")
            return {}
        return found

    def task(self, table: Mapping[str, object], path: str) -> d.Task:
        return d.Task(
            self.text(table, path, "name", None),
            self.text(table, path, "code"),
            tuple(self.measure(t, p) for p, t in self.tables(table, path, "measures")),
            self.text(table, path, "label"),
        )

    def measure(self, table: Mapping[str, object], path: str) -> d.Measured:
        name = self.text(table, path, "name", None)
        log = self.value(table, path, "log", False, _is_bool, "true or false")
        above = 1 if log else 0
        return d.Measured(
            name,
            self.text(table, path, "column") or name,
            self.text(table, path, "unit"),
            self.choice(table, path, "direction", ("less", "more"), "less"),
            self.choice(table, path, "scale", d.SCALES, "ratio"),
            self.choice(table, path, "adds", d.ADDS, "mean"),
            log,
            self.choice(table, path, "rows", ("all", "right"), "all"),
            self.margin(table, path, above),
            self.text(table, path, "label"),
            self.value(table, path, "pool", log, _is_bool, "true or false"),
            self.value(table, path, "price", False, _is_bool, "true or false"),
            self.value(table, path, "digits", 2 if log else 3, _is_digits, "0 to 9"),
        )

    def margin(self, table: Mapping[str, object], path: str, above: float) -> float | None:
        def fits(value: object) -> TypeGuard[float]:
            return _is_number(value) and not _is_bool(value) and above < value < 1e300

        return self.value(table, path, "margin", None, fits, f"a number above {above:g}")

    def cell(
        self, table: Mapping[str, object], path: str, known: Mapping[str, Sequence[str]]
    ) -> Mapping[str, str]:
        for name, level in table.items():
            if level not in known.get(name, ()):
                self.wrong(f"{path}.{name}", level, f"a level of {name}")
        return {str(k): str(v) for k, v in table.items()}

    def items(self, entry: Mapping[str, object]) -> tuple[d.Item, ...] | None:
        if "items" not in entry:
            return None
        return tuple(
            d.Item(
                self.text(t, p, "name", None),
                self.text(t, p, "label"),
                self.texts(t, p, "each"),
                self.text(t, p, "group"),
                self.text(t, p, "of"),
                self.value(t, p, "points", None, _is_whole, "a number"),
                self.value(t, p, "low", 0, _is_number, "a number"),
                self.texts(t, p, "parts"),
                self.texts(t, p, "reverse"),
            )
            for p, t in self.tables(entry, ENTRY, "items")
        )

    def prediction(self, table: Mapping[str, object], path: str, made: d.Design) -> d.Prediction:
        name = self.text(table, path, "name", None)
        margin = table.get("margin")
        ratio = table.get("ratio")
        measures = self.texts(table, path, "measure")
        if isinstance(margin, _NUMBER) and not isinstance(margin, bool):
            margin = dict.fromkeys(measures, margin)
        if ratio is not None:
            margin = dict.fromkeys(measures, ratio)
        if margin is not None and not (
            isinstance(margin, Mapping) and all(isinstance(v, _NUMBER) for v in margin.values())
        ):
            self.wrong(f"{path}.margin", margin, "a number, or one for each measure")
            margin = None
        contrast, _, level = self.text(table, path, "contrast").partition("=")
        levels = made.levels
        if contrast and contrast not in levels:
            expected = ", ".join(levels) or "no factor"
            self.wrong(f"{path}.contrast", contrast, f"a factor: {expected}")
        elif level and level not in levels[contrast]:
            self.wrong(f"{path}.contrast", level, f"a level of {contrast}")
        return d.Prediction(
            name,
            self.text(table, path, "text") or self.text(table, path, "label"),
            measures,
            contrast if contrast in levels else "",
            self.choice(table, path, "expect", d.EXPECT, "different"),
            level or self.text(table, path, "level"),
            {k: float(v) for k, v in margin.items()} if margin else None,
            self.value(table, path, "value", None, _is_number, "a number"),
            self.choice(table, path, "combine", ("all", "any"), "all"),
            ratio is not None,
            self.text(table, path, "reason"),
        )


def _is_text(value: object) -> TypeGuard[str]:
    return isinstance(value, str)


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float)


def _is_whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int)


def _is_bool(value: object) -> TypeGuard[bool]:
    return isinstance(value, bool)


def _is_digits(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= 9
