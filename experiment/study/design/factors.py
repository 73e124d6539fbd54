"""What a study varies: factors, their levels, and the cells that they make.

Pure values; experiment/study/tables/factor_tables.py reads them from a study file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

from seethrough.experiment.study.design.squares import MIXED

WITHIN, BETWEEN, MEASURED = "within", "between", "measured"
KINDS = (WITHIN, BETWEEN, MEASURED)
ALONE, CHANGED = "alone", "changed"

Cell = tuple[str, ...]  # a level's name of each factor, in file order
Levels = Mapping[str, str]  # factor → level


@dataclass(frozen=True)
class Level:
    """A level: the part of a study that it sets, its text, and its number where it is one."""

    name: str
    part: Mapping[str, object] = field(default_factory=dict, hash=False)
    label: str = ""
    number: float | None = None


@dataclass(frozen=True)
class Factor:
    """A factor, its levels in the study's order.

    `kind`: each person meets all levels (within), is assigned one (between) or brings one along
    (measured). `order`: a square of its own, "mixed", or "" for the design's. `scenes`: whether
    its levels leave scenes alone or change them. `people`: wanted at each level, where it is said.
    """

    name: str
    levels: tuple[Level, ...]
    kind: str = WITHIN
    order: str = ""
    baseline: str = ""
    scenes: str = ALONE
    people: tuple[int, ...] | None = None
    text: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """The levels' names, in order."""
        return tuple(level.name for level in self.levels)

    @property
    def mixed(self) -> bool:
        """Whether its levels change from trial to trial within a block."""
        return self.order == MIXED

    @property
    def block(self) -> bool:
        """Whether it makes conditions: within, and not mixed."""
        return self.kind == WITHIN and not self.mixed

    def level(self, name: str) -> Level:
        """The level of this name. Raises KeyError."""
        for level in self.levels:
            if level.name == name:
                return level
        raise KeyError(f"{self.name}: {name}")

    def described(self) -> dict[str, object]:
        """What a sidecar says of it: enough to analyse the data without the program."""
        numbers = [level.number for level in self.levels]
        return {
            "name": self.name,
            "kind": self.kind,
            "levels": list(self.names),
            "numbers": None if None in numbers else numbers,
            "labels": {level.name: level.label or level.name for level in self.levels},
            "baseline": self.baseline or self.names[0],
            "scenes": self.scenes,
            "order": self.order,
        }


def every_cell(factors: Sequence[Factor], excluded: Sequence[Levels] = ()) -> tuple[Cell, ...]:
    """One level of every factor, in the order of the file, the last factor fastest; those that an
    entry of `excluded` describes are left out."""
    names = [factor.name for factor in factors]
    cells = product(*(factor.names for factor in factors))
    return tuple(c for c in cells if not left_out(dict(zip(names, c, strict=True)), excluded))


def left_out(levels: Levels, excluded: Sequence[Levels]) -> bool:
    """Whether an entry describes the cell: all that it names agrees."""
    return any(all(levels[n] == level for n, level in entry.items()) for entry in excluded)


def is_measured(factor: Factor) -> bool:
    """Whether people bring the factor's level along."""
    return factor.kind == MEASURED
