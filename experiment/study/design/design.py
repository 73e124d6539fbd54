"""The plan of a study, from numbers alone: conditions, orders, items, trials and their streams.

Pure: the same design and slot give the same session on every machine.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import lcm

import numpy as np
from numpy.random import Generator, SeedSequence

from seethrough.experiment.study.design.conditions import Branch, branches, leaves_of
from seethrough.experiment.study.design.factors import (
    ALONE,
    CHANGED,
    WITHIN,
    Cell,
    Factor,
    Levels,
    every_cell,
)
from seethrough.experiment.study.design.groups import Group, groups_of
from seethrough.experiment.study.design.items import letters, rotation
from seethrough.experiment.study.design.squares import square

# First words of a stream's spawn key: what the stream is for (CONVENTIONS.md).
STUDY_SCENES, PARTICIPANT, SIMULATED = 0, 1, 2
ORDERS = 4
TRAINING_TRIAL = 1_000  # first trial number of the training streams, above any study's trials


@dataclass(frozen=True)
class Trial:
    """One trial: where it stands in the session, the level of every factor, what it asks in which
    world, and the stream its scene is from."""

    number: int
    block: int
    task_set: int
    in_set: int
    levels: Levels = field(hash=False)
    task: str
    scene: str
    stream: tuple[int, ...]
    training: bool = False
    world: str = ""


@dataclass(frozen=True)
class TaskSet:
    """A task within a condition: its training, then its trials."""

    training: tuple[Trial, ...]
    trials: tuple[Trial, ...]


@dataclass(frozen=True)
class CellPlan:
    """What a design needs to know of a cell: its world, whether scenes are the same for everybody,
    its tasks, trials of each task, and practice trials before them."""

    world: str
    tasks: tuple[str, ...]
    trials: int
    practice: int
    shared: bool = False


@dataclass(frozen=True)
class Design:
    """Factors, cells that are there and what happens in each; `order` is the square over the
    conditions of all factors that have no order of their own.

    A scene named in `redraw` is drawn again, from a stream of its own, as often as it is named:
    the difficulty certificate says which (experiment/study/checked/certificate.py).
    """

    factors: tuple[Factor, ...]
    plans: Mapping[Cell, CellPlan] = field(hash=False)
    order: str = "williams"
    people: int = 1
    seed: int = 0
    excluded: tuple[Levels, ...] = field(default=(), hash=False)
    redraw: Sequence[str] = field(default=(), hash=False)

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """Every cell that is not left out."""
        return every_cell(self.factors, self.excluded)

    @cached_property
    def groups(self) -> tuple[Group, ...]:
        """Who is assigned or measured what, with the places that are wanted of each."""
        return groups_of(self.factors, self.cells, self.people)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The factors' names."""
        return tuple(factor.name for factor in self.factors)

    def levels(self, cell: Cell) -> Levels:
        """Factor → level of a cell."""
        return dict(zip(self.names, cell, strict=True))

    @cached_property
    def _branches(self) -> tuple[Branch, ...]:
        return tuple(branches(self.factors, group.cells, self.order) for group in self.groups)

    @cached_property
    def _codes(self) -> dict[tuple[Cell, str], int]:
        """A number for each cell's levels of the factors that leave scenes alone, and of those that
        change them: the first factor's count singly, so that at a new last factor's first level
        every number is as it was."""
        codes = {}
        for scenes in (ALONE, CHANGED):
            weights, weight = [], 1
            for factor in self.factors:
                meant = factor.scenes == scenes and (factor.kind == WITHIN or scenes == CHANGED)
                weights.append(weight if meant else 0)
                weight *= len(factor.levels) if meant else 1
            places = [{name: k for k, name in enumerate(f.names)} for f in self.factors]
            for cell in self.cells:
                codes[cell, scenes] = sum(
                    w * at[lv] for w, at, lv in zip(weights, places, cell, strict=True)
                )
        return codes

    def code(self, cell: Cell, scenes: str) -> int:
        """The cell's number among those that differ in factors of this kind: see CONVENTIONS.md."""
        return self._codes[cell, scenes]

    @cached_property
    def _blocks(self) -> tuple[dict[Cell, list[Cell]], ...]:
        block = [i for i, factor in enumerate(self.factors) if factor.block]
        found: list[dict[Cell, list[Cell]]] = []
        for group in self.groups:
            cells: dict[Cell, list[Cell]] = {}
            for cell in group.cells:
                cells.setdefault(tuple(cell[i] for i in block), []).append(cell)
            found.append(cells)
        return tuple(found)

    def cells_of(self, group: int, condition: Cell) -> list[Cell]:
        """The cells that are mixed within a condition's block."""
        return self._blocks[group][condition]

    def branch(self, group: int) -> Branch:
        """The tree of conditions of a group."""
        return self._branches[group]

    def group_of(self, slot: int) -> tuple[int, int]:
        """(group, number in the group from 1) of a slot from 1: groups take turns."""
        index = _index(slot)
        return index % len(self.groups), index // len(self.groups) + 1

    def slot_of(self, group: int, number: int) -> int:
        """The slot of a group's number, from 1."""
        return (number - 1) * len(self.groups) + group + 1

    def slots(self, count: int) -> list[int]:
        """The slots of the first people, as they are assigned where nobody drops out: each time the
        group that has least of its places taken."""
        taken = [0] * len(self.groups)
        found = []
        for _ in range(count):
            shares = [taken[g] / max(group.people, 1) for g, group in enumerate(self.groups)]
            which = shares.index(min(shares))
            taken[which] += 1
            found.append(self.slot_of(which, taken[which]))
        return found

    def rows(self, group: int = 0) -> int:
        """Orders of the conditions over a complete cycle of the group's slots."""
        return self.branch(group).cycle

    def cycle(self, group: int = 0) -> int:
        """Slots of the group after which orders of conditions and of tasks begin again."""
        orders = [len(square(self.order, len(self.plans[c].tasks)))
                  for c in self.groups[group].cells]  # fmt: skip
        return self.rows(group) * lcm(*orders)

    def conditions(self, group: int = 0) -> tuple[Levels, ...]:
        """The conditions of a group, in file order: levels of the factors that make blocks."""
        return tuple(
            dict(zip(self.branch(group).names, c, strict=True))
            for c in leaves_of(self.branch(group))
        )


def _index(slot: int) -> int:
    if slot < 1:
        raise ValueError(f"slot = {slot}, expected at least 1")
    return slot - 1


def session_for(slot: int, design: Design) -> tuple[TaskSet, ...]:
    """Every task set of a slot's session, in order."""
    return _Session(slot, design).task_sets()


class _Session:
    """One slot's plan while it is made."""

    def __init__(self, slot: int, design: Design) -> None:
        self.design = design
        which, self.number = design.group_of(slot)
        self.group, self.which = design.groups[which], which
        self.branch = design.branch(which)
        self.index = self.number - 1
        self.outer, self.passes = self.index % self.branch.cycle, self.index // self.branch.cycle

    def task_sets(self) -> tuple[TaskSet, ...]:
        sets: list[TaskSet] = []
        played = 0
        for block, condition in enumerate(self.order(), start=1):
            mixed = self.design.cells_of(self.which, condition)
            plan = self.design.plans[mixed[0]]
            for which in self._row(len(plan.tasks), (ORDERS, self.number, self.which, block)):
                place = (block, len(sets) + 1, which)
                made = self._task_set(mixed, plan, place, played)
                played += len(made.trials)
                sets.append(made)
        return tuple(sets)

    def order(self) -> tuple[Cell, ...]:
        """The conditions in the slot's order."""
        seed, words = self.design.seed, (ORDERS, self.number, self.which, 0)
        return self.branch.order_of_slot(self.index, lambda more: generator(seed, (*words, *more)))

    def _row(self, k: int, words: tuple[int, ...]) -> tuple[int, ...]:
        """The order of k tasks in each condition.

        Orders alternate from slot to slot and shift with each pass through the conditions' rows, so
        that no row always meets the same task first.
        """
        if self.design.order == "random":
            return tuple(map(int, generator(self.design.seed, words).permutation(k)))
        rows = square(self.design.order, k)
        return rows[(self.outer + self.passes) % len(rows)]

    def _task_set(
        self, mixed: Sequence[Cell], plan: CellPlan, place: tuple[int, int, int], played: int
    ) -> TaskSet:
        block, task_set, _ = place
        order = [self._round(mixed, (block, task_set, n)) for n in range(1, plan.trials + 1)]
        trials: list[Trial] = []
        for round_, cells in enumerate(order, start=1):
            for cell in cells:
                in_set = len(trials) + 1
                trials.append(self._trial(cell, place, (played + in_set, in_set), round_))
        practised = [c for _ in range(plan.practice) for c in order[0]][: plan.practice]
        met: dict[Cell, int] = {}
        training = []
        for in_set, cell in enumerate(practised, start=1):
            met[cell] = met.get(cell, 0) + 1
            training.append(self._trial(cell, place, (0, in_set), met[cell], training=True))
        return TaskSet(tuple(training), tuple(trials))

    def _round(self, mixed: Sequence[Cell], words: tuple[int, int, int]) -> list[Cell]:
        """Every mixed cell once, shuffled."""
        if len(mixed) == 1:
            return [mixed[0]]
        rng = generator(self.design.seed, (ORDERS, self.number, self.which, *words))
        return [mixed[int(i)] for i in rng.permutation(len(mixed))]

    def _trial(
        self,
        cell: Cell,
        place: tuple[int, int, int],
        at: tuple[int, int],
        round_: int,
        training: bool = False,
    ) -> Trial:
        (block, task_set, which), (number, in_set) = place, at
        plan, levels = self.design.plans[cell], self.design.levels(cell)
        task = plan.tasks[which]
        word = TRAINING_TRIAL + round_ if training else round_
        alone, changed = self.design.code(cell, ALONE), self.design.code(cell, CHANGED)
        if plan.shared:
            chosen = self._set(cell)
            stream: tuple[int, ...] = (STUDY_SCENES, chosen, changed, which, word)
            changing = [f.name for f in self.design.factors if f.scenes == CHANGED]
            where = "-".join(levels[name] for name in changing) or plan.world
            practice = "training-" if training else ""
            scene = f"{where}-{letters(chosen)}-{task}-{practice}{round_}"
        else:
            stream = (PARTICIPANT, self.number, alone, changed, which, word)
            scene = "stream-" + "-".join(map(str, stream))
        again = list(self.design.redraw).count(scene)
        stream = (*stream, again) if again else stream
        return Trial(
            number, block, task_set, in_set, levels, task, scene, stream, training, plan.world
        )

    def _set(self, cell: Cell) -> int:
        """Which set of items goes with the cell: sets rotate over the cells of the person that
        differ only in factors that leave scenes alone."""
        code, changed = self.design.code, self.design.code(cell, CHANGED)
        cells = [code(c, ALONE) for c in self.group.cells if code(c, CHANGED) == changed]
        turn = rotation(self.outer, self.passes, len(cells))
        return (cells.index(code(cell, ALONE)) + turn) % len(cells)


def scene_names(number: int, design: Design) -> list[str]:
    """The scenes that the people with this number in their group meet, and shared ones: every
    session has each of those."""
    return [
        trial.scene
        for group in range(len(design.groups))
        for task_set in session_for(design.slot_of(group, number), design)
        for trial in (*task_set.trials, *task_set.training)
    ]


def number_of(scene: str) -> int:
    """The number in a group of the person whose own scene it is; else the first."""
    words = scene.split("-")
    own = words[0] == "stream" and len(words) > 2 and words[2].isascii() and words[2].isdigit()
    return max(int(words[2]), 1) if own and len(words[2]) < 10 else 1


def generator(seed: int, stream: Sequence[int]) -> Generator:
    """The Generator of a stream: any trial's scene can be made again alone."""
    return np.random.Generator(np.random.PCG64(SeedSequence(seed, spawn_key=tuple(stream))))
