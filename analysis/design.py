"""What a study varied and measured, as its sidecars say it: the analysis knows no name but these.

The sidecars' `design` entry is read here and checked; data that were recorded before there was one
go through `before.py`. Tables, sentences and figures ask these records for names, orders and units.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from seethrough.analysis.words import capitalised

WITHIN, BETWEEN, MEASURED = "within", "between", "measured"
KINDS = (WITHIN, BETWEEN, MEASURED)
SCALES = ("ratio", "count", "bounded", "ordinal", "binary", "censored")
RANKED = ("ordinal", "binary")
"""Scales whose values are compared by their order alone."""
RELATIVE, ABSOLUTE = "relative", "relative absolute"
ADDS = ("mean", "sum", "median", "share", RELATIVE, ABSOLUTE)
"""How a person's trials of a cell become one value. The last two are of signed errors: |Σ error| /
Σ truth, where over- and underestimates cancel, and Σ |error| / Σ truth."""
EXPECT = ("less", "more", "different", "equivalent", "not worse", "at least")


@dataclass(frozen=True, slots=True)
class Contrast:
    """Two levels of a factor; differences are `baseline − level`, ratios `level / baseline`."""

    factor: str
    baseline: str
    level: str
    first: str
    second: str
    between: bool = False

    @property
    def key(self) -> str:
        return f"{self.factor}={self.level}"


@dataclass(frozen=True, slots=True)
class Factor:
    """A column of the tables. `levels` in the study's order; `labels` say them in sentences.

    `numbers`: the levels as numbers, where they are. `tasks`: which tasks a level brings, where
    levels differ in their tasks: such a factor is constant within a task, and drops out of it.
    """

    name: str
    kind: str
    levels: tuple[str, ...]
    baseline: str
    numbers: tuple[float, ...] | None = None
    labels: Mapping[str, str] | None = None
    scenes: str = "alone"
    order: str = ""
    tasks: Mapping[str, tuple[str, ...]] | None = None

    @property
    def within(self) -> bool:
        return self.kind == WITHIN

    def label(self, level: str) -> str:
        """A level in words: as the study has them, else with the factor's name."""
        said = (self.labels or {}).get(level, level)
        if said != level:
            return said
        return f"{self.name} {level}" if self.numbers is not None else f"{level} {self.name}"

    @property
    def nests_tasks(self) -> bool:
        """Whether its levels have tasks of their own."""
        return self.tasks is not None and len({tuple(t) for t in self.tasks.values()}) > 1

    def contrasts(self) -> tuple[Contrast, ...]:
        """Each level against the baseline."""
        return tuple(
            Contrast(self.name, self.baseline, level, self.label(self.baseline), self.label(level),
                     not self.within)
            for level in self.levels if level != self.baseline
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Measured:
    """A measure of a task: the column it is in, and how its values are to be treated.

    `margin`: what the study declared to be no difference that matters, in the measure's unit; of a
    measure that is analysed as logarithms (`log`) a ratio above 1. `rows`: all trials, or those
    with a right answer. `pool`: whether its tasks are also taken together. `price`: whether it is
    what time is set against in the trade-off. `ratio`: whether a margin is one though values are
    not analysed as logarithms.
    """

    name: str
    column: str
    unit: str = ""
    direction: str = "less"
    scale: str = "ratio"
    adds: str = "mean"
    log: bool = False
    rows: str = "all"
    margin: float | None = None
    label: str = ""
    pool: bool = False
    price: bool = False
    digits: int = 3
    ratio: bool = False

    @property
    def said(self) -> str:
        """Its name in sentences."""
        return self.label or self.name.replace("_", " ")

    @property
    def title(self) -> str:
        """Its name at the head of a table, a figure or a sentence."""
        return capitalised(self.said)

    @property
    def ranked(self) -> bool:
        return self.scale in RANKED


@dataclass(frozen=True, slots=True)
class Task:
    """A task with its measures; `label` names it in tables and sentences."""

    name: str
    code: str
    measures: tuple[Measured, ...]
    label: str = ""

    @property
    def said(self) -> str:
        return self.label or " ".join(part for part in (self.code, self.name) if part)


@dataclass(frozen=True, slots=True)
class Item:
    """A question of the questionnaire.

    `each`: the factors that it is asked for each level of, none where it is asked once. `scale` of
    one group (`group`) are averaged. `of`: a factor that a preference is between two levels of.
    `parts`: the items that a sum is made of; `reverse`: which of them, or of the group, count the
    other way round. `points` of a scale, the lowest counting `low`.
    """

    name: str
    label: str
    each: tuple[str, ...] = ()
    group: str = ""
    of: str = ""
    points: int | None = None
    low: float = 0.0
    parts: tuple[str, ...] = ()
    reverse: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Prediction:
    """What the study stated before there were data.

    `expect` as in `EXPECT`; `margin`: by measure, absolute or a `ratio` (always one for what is
    analysed as logarithms); `value`: what a measure is to be at least; `combine`: all or any of
    the measures.
    """

    name: str
    said: str
    measures: tuple[str, ...]
    contrast: str
    expect: str
    level: str = ""
    margin: Mapping[str, float] | None = None
    value: float | None = None
    combine: str = "all"
    ratio: bool = False
    reason: str = ""

    def about(self, measure: Measured) -> bool:
        """Whether it is of a measure: of its name, or of the column that it is made of."""
        return measure.name in self.measures or measure.column in self.measures


@dataclass(frozen=True, slots=True)
class Design:
    """A study's design. `selected`: the rule by which its scenes were selected, "" if they were
    not."""

    factors: tuple[Factor, ...]
    tasks: tuple[Task, ...]
    excluded: tuple[Mapping[str, str], ...] = ()
    predictions: tuple[Prediction, ...] = ()
    items: tuple[Item, ...] | None = None
    selected: str = ""

    def factor(self, name: str) -> Factor:
        return next(f for f in self.factors if f.name == name)

    def task(self, name: str) -> Task | None:
        return next((t for t in self.tasks if t.name == name), None)

    @property
    def levels(self) -> dict[str, tuple[str, ...]]:
        """Every factor's levels, in the study's order."""
        return {f.name: f.levels for f in self.factors}

    @property
    def task_names(self) -> tuple[str, ...]:
        return tuple(t.name for t in self.tasks)

    def measures(self) -> tuple[Measured, ...]:
        """Each measure once, as its first task has it."""
        found: dict[str, Measured] = {}
        for task in self.tasks:
            for m in task.measures:
                found.setdefault(m.name, m)
        return tuple(found.values())

    def tasks_with(self, measure: str) -> tuple[str, ...]:
        """The tasks that have a measure of this name."""
        return tuple(t.name for t in self.tasks if any(m.name == measure for m in t.measures))

    def task_said(self, name: str) -> str:
        """A task in words."""
        task = self.task(name)
        return task.said if task else name

    @property
    def crossed(self) -> tuple[Factor, ...]:
        """Within factors that vary inside each task."""
        return tuple(f for f in self.factors if f.within and not f.nests_tasks)

    @property
    def nesting(self) -> tuple[Factor, ...]:
        """Within factors whose levels have tasks of their own."""
        return tuple(f for f in self.factors if f.within and f.nests_tasks)

    @property
    def groups(self) -> tuple[Factor, ...]:
        """Factors of which each person has one level."""
        return tuple(f for f in self.factors if not f.within)

    @property
    def main(self) -> Factor | None:
        """What people are followed from level to level of: a within factor that leaves the scenes
        alone before one that changes them; None where every factor is between people."""
        alone = [f for f in self.crossed if f.scenes == "alone"]
        return next(iter([*alone, *self.crossed]), None)

    def contrasts(self) -> tuple[Contrast, ...]:
        """Each level of each factor that varies inside a task against its baseline."""
        return tuple(c for f in (*self.crossed, *self.groups) for c in f.contrasts())

    def left_out(self, cell: Mapping[str, str]) -> bool:
        """Whether the study leaves a cell out for everybody."""
        return any(
            all(k in cell and cell[k] == v for k, v in gone.items()) for gone in self.excluded
        )

    def cells(self, factors: tuple[Factor, ...]) -> Iterator[dict[str, str]]:
        """Every cell that exists, the last factor running fastest."""
        for levels in itertools.product(*(f.levels for f in factors)):
            cell = dict(zip((f.name for f in factors), levels, strict=True))
            if not self.left_out(cell):
                yield cell


NO_DESIGN = Design((), ())
