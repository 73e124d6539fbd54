"""What a report is made of. Every number in a sentence is cited from a table that is also a CSV."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeGuard

from seethrough.analysis.page.numbers import show
from seethrough.analysis.stats.undefined import Undefined


@dataclass(frozen=True, slots=True)
class Column:
    """A table's column: its name in the CSV, its heading, and how its numbers are shown.

    `low` and `high` name the columns of its interval, shown with it in one cell of the page. The
    style `own` takes the row's `digits`, and its `kind` (fixed, or bound for what is at most 1).
    """

    name: str
    label: str
    style: str = "text"
    about: str = ""
    low: str = ""
    high: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows keyed by their first column. `shown` picks columns for the page; the CSV has all.

    `source` names the table whose CSV this one is a further view of.
    """

    key: str
    title: str
    columns: tuple[Column, ...]
    rows: tuple[Mapping[str, object], ...]
    shown: tuple[str, ...] = ()
    note: str = ""
    source: str = ""

    @property
    def file(self) -> str:
        """Name of the CSV that has all of it."""
        return f"{self.source or self.key}.csv"

    def column(self, name: str) -> Column:
        return next(c for c in self.columns if c.name == name)

    def row(self, key: str) -> Mapping[str, object]:
        """The row whose first column is `key`."""
        return next(r for r in self.rows if r[self.columns[0].name] == key)

    def visible(self) -> tuple[Column, ...]:
        """The columns on the page."""
        return tuple(self.column(n) for n in self.shown) if self.shown else self.columns

    def cite(self, key: str, column: str, style: str = "") -> Cited:
        """A number of this table, for a sentence."""
        row = self.row(key)
        text = show(row[column], style or self.style(row, self.column(column)))
        return Cited(row[column], text, self.file, key, column)

    def style(self, row: Mapping[str, object], column: Column) -> str:
        """How this row's number in `column` is shown."""
        kind = row.get("kind", "fixed")
        return f"{kind}{row['digits']}" if column.style == "own" else column.style

    def text(self, row: Mapping[str, object], column: Column) -> str:
        """A cell as the page has it: the number, and its interval where it has one."""
        value, style = row.get(column.name), self.style(row, column)
        shown = show(value, style)
        if not column.low or value is None or isinstance(value, Undefined):
            return shown
        low, high = row[column.low], row[column.high]
        if low is None or (isinstance(low, Undefined) and isinstance(high, Undefined)):
            return shown
        return f"{shown} [{show(low, style)}, {show(high, style)}]"


@dataclass(frozen=True, slots=True)
class Cited:
    """A shown number and where it comes from: file, row and column."""

    value: object
    text: str
    file: str
    row: str
    column: str


@dataclass(frozen=True, slots=True)
class Prose:
    """A paragraph; `kind` is text, answer (a prediction's), warning or note."""

    runs: tuple[str | Cited, ...]
    kind: str = "text"


def say(template: str, *values: str | Cited | Sequence[str | Cited], kind: str = "text") -> Prose:
    """A paragraph from a template with a `{}` for each value; a value may be several runs."""
    parts = template.split("{}")
    if len(parts) != len(values) + 1:
        raise ValueError(f"{len(values)} values for {len(parts) - 1} places in: {template}")
    runs: list[str | Cited] = [parts[0]]
    for value, text in zip(values, parts[1:], strict=True):
        runs.extend([value] if isinstance(value, str | Cited) else value)
        runs.append(text)
    return Prose(tuple(r for r in runs if r != ""), kind)


@dataclass(frozen=True, slots=True)
class Figure:
    """A chart: `spec` is Vega-Lite without the page's theme; `alt` tells what it shows."""

    key: str
    title: str
    alt: str
    spec: Mapping[str, object] = field(repr=False)


@dataclass(frozen=True, slots=True)
class Fold:
    """Details behind a summary line."""

    summary: str
    blocks: tuple[Block, ...]


Block = Prose | Table | Figure | Fold


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the report with its line in the contents."""

    key: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class Report:
    """`banner` warns on every copy, e.g. that participants were simulated; `script`: analysis.R."""

    title: str
    subtitle: str
    banner: str
    sections: tuple[Section, ...]
    script: str = ""


def more(table: Table, title: str, shown: str) -> Fold:
    """Further columns of a table, behind a fold; what no row has is said once, below."""
    names = [n for n in shown.split() if not all(_gone(row.get(n)) for row in table.rows)]
    gone = {
        str(row[n]).removeprefix("undefined: ")
        for n in shown.split()
        if n not in names
        for row in table.rows
    }
    view = replace(
        table,
        key=f"{table.key}_more",
        title=title,
        shown=tuple(names),
        source=table.key,
        note=f"Columns that no row has are left out: {'; '.join(sorted(gone))}." if gone else "",
    )
    return Fold(title, (view,))


def _gone(value: object) -> TypeGuard[Undefined]:
    return isinstance(value, Undefined)


def row_texts(table: Table, row: Mapping[str, object]) -> list[str]:
    """The cells of a row on the page; a reason for `undefined` is given once in a row."""
    said: set[str] = set()
    texts = []
    for column in table.visible():
        value = row.get(column.name)
        if isinstance(value, Undefined) and value.reason in said:
            texts.append("undefined")
            continue
        if isinstance(value, Undefined):
            said.add(value.reason)
        texts.append(table.text(row, column))
    return texts


def walk(blocks: Sequence[Block]) -> list[Block]:
    """All blocks, those inside folds too."""
    found: list[Block] = []
    for block in blocks:
        found.append(block)
        if isinstance(block, Fold):
            found.extend(walk(block.blocks))
    return found
