"""Conditions and the order in which a slot meets them.

Factors of equal order that follow one another are crossed and share a square; others nest inside,
in file order. So the conditions are a tree: a stage for each run of equal orders, at each stage the
combinations of levels that are there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import lcm

from numpy.random import Generator

from seethrough.experiment.study.design.factors import Cell, Factor
from seethrough.experiment.study.design.squares import square

Draw = Callable[[tuple[int, ...]], Generator]


@dataclass(frozen=True)
class Stage:
    """Factors of equal order that follow one another: they are crossed."""

    order: str
    names: tuple[str, ...]


@dataclass(frozen=True)
class Branch:
    """The combinations of a stage under one combination of the stages before; `inner` has a branch
    for each of them, or nothing at the last stage."""

    order: str
    names: tuple[str, ...]  # of this stage's factors and those within
    cells: tuple[Cell, ...]
    inner: tuple[Branch, ...]

    @property
    def rows(self) -> int:
        """Rows of this stage's own square."""
        return len(square(self.order, len(self.cells)))

    @property
    def cycles(self) -> tuple[int, ...]:
        """Rows of each stage, for all branches of the stage together."""
        deeper = [branch.cycles for branch in self.inner]
        return (self.rows, *(lcm(*rows) for rows in zip(*deeper, strict=True)))

    @property
    def cycle(self) -> int:
        """Slots after which the orders begin again."""
        total = 1
        for rows in self.cycles:
            total *= rows
        return total

    def order_of_slot(self, index: int, draw: Draw) -> tuple[Cell, ...]:
        """The conditions in the order of a slot, counted from 0."""
        return self.order_at(index, self.cycles, 0, (), draw)

    def order_at(
        self, index: int, cycles: tuple[int, ...], stage: int, path: tuple[int, ...], draw: Draw
    ) -> tuple[Cell, ...]:
        """This branch's part of the order; `path` are the positions taken so far."""
        before = 1
        for rows in cycles[:stage]:
            before *= rows
        if self.order == "random":
            row = tuple(int(i) for i in draw(path).permutation(len(self.cells)))
        else:
            rows_ = square(self.order, len(self.cells))
            row = rows_[(index % before + index // before) % len(rows_)]
        found: list[Cell] = []
        for k in row:
            if not self.inner:
                found.append(self.cells[k])
                continue
            rest = self.inner[k].order_at(index, cycles, stage + 1, (*path, k + 1), draw)
            found += [(*self.cells[k], *cell) for cell in rest]
        return tuple(found)


def stages(factors: Sequence[Factor], order: str) -> tuple[Stage, ...]:
    """The stages of a design's orders; none where no factor makes conditions."""
    block = [f for f in factors if f.block]
    runs = groupby(block, key=lambda f: f.order or order)
    return tuple(Stage(kind, tuple(f.name for f in run)) for kind, run in runs)


def branches(factors: Sequence[Factor], cells: Sequence[Cell], order: str) -> Branch:
    """The tree of the conditions that the cells make; one condition of no levels without factors
    that make any."""
    block = [i for i, f in enumerate(factors) if f.block]
    conditions = tuple(dict.fromkeys(tuple(cell[i] for i in block) for cell in cells))
    return _branch(stages(factors, order) or (Stage(order, ()),), conditions)


def _branch(left: tuple[Stage, ...], conditions: Sequence[Cell]) -> Branch:
    stage, *rest = left
    size = len(stage.names)
    own = tuple(dict.fromkeys(c[:size] for c in conditions))
    names = tuple(name for s in left for name in s.names)
    inner = tuple(
        _branch(tuple(rest), [c[size:] for c in conditions if c[:size] == mine])
        for mine in (own if rest else ())
    )
    return Branch(stage.order, names, own, inner)


def leaves_of(branch: Branch) -> tuple[Cell, ...]:
    """The conditions of a tree, in file order."""
    if not branch.inner:
        return branch.cells
    return tuple(
        (*cell, *rest)
        for cell, inner in zip(branch.cells, branch.inner, strict=True)
        for rest in leaves_of(inner)
    )
