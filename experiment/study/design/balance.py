"""Balance, counted from the trials that came out: not from what made them.

Each of these is equally often, over a complete cycle of a group's slots:

    level × position    each condition at each position of a session, where its order promises it
    successor           each condition after each other one
    item × cell         each item of a world's shared scenes in each of the cells that share it
    item × row          each item in each row of the design
    item × cell × row   each item in each cell in each row

Orders that nest are counted stage by stage: the outer conditions in the session, the inner ones
within each outer one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise, product
from math import lcm
from typing import NamedTuple, TypeVar

from seethrough.experiment.study.design.conditions import Branch
from seethrough.experiment.study.design.design import Design
from seethrough.experiment.study.design.factors import ALONE, CHANGED, WITHIN, Levels
from seethrough.experiment.study.design.squares import positions_promised, successors_promised


class Met(NamedTuple):
    """A trial as it is in a table: who met what, where."""

    slot: int
    block: int
    levels: Levels
    task: str
    scene: str


@dataclass(frozen=True)
class Count:
    """How often each of some things occurred in a group; `uneven` is the largest difference."""

    group: int
    what: str
    where: str
    counts: Mapping[Hashable, int]

    @property
    def uneven(self) -> int:
        """0: each equally often."""
        return max(self.counts.values()) - min(self.counts.values()) if self.counts else 0


def cycle(design: Design, group: int) -> int:
    """Slots of a group after which all that is promised has come out even."""
    plans = [design.plans[cell] for cell in design.groups[group].cells]
    shared = [_sharing(design, group, cell) for cell, plan in
              zip(design.groups[group].cells, plans, strict=True) if plan.shared]  # fmt: skip
    return lcm(design.cycle(group), *(design.rows(group) * k for k in shared))


def _sharing(design: Design, group: int, cell: Sequence[str]) -> int:
    """Cells of a person that share this cell's items."""
    changed = [i for i, f in enumerate(design.factors) if f.scenes == CHANGED]
    return sum(all(c[i] == cell[i] for i in changed) for c in design.groups[group].cells)


def counted(design: Design, trials: Iterable[Met]) -> tuple[Count, ...]:
    """Every count of every group, from the trials of any number of sessions."""
    people: dict[int, list[Met]] = {}
    for trial in trials:
        people.setdefault(trial.slot, []).append(trial)
    found: list[Count] = []
    for group in range(len(design.groups)):
        own = {s: met for s, met in people.items() if design.group_of(s)[0] == group}
        sequences = [_conditions(design, met) for met in own.values()]
        found += _stage(group, design.branch(group), sequences, "")
        found += _items(design, group, own)
    return tuple(found)


def repeated(design: Design, trials: Iterable[Met]) -> list[str]:
    """Who met an item twice: a line each."""
    met = Counter((t.slot, t.scene) for t in trials)
    return [f"slot {slot}: {scene} {n} times" for (slot, scene), n in met.items() if n > 1]


def _conditions(design: Design, met: Sequence[Met]) -> tuple[tuple[str, ...], ...]:
    """A person's conditions in the order of the blocks."""
    block = [f.name for f in design.factors if f.block]
    ordered = sorted(met, key=lambda t: t.block)
    firsts = [next(of_block) for _, of_block in groupby(ordered, key=lambda t: t.block)]
    return tuple(tuple(trial.levels[name] for name in block) for trial in firsts)


def _stage(
    group: int, branch: Branch, sequences: Sequence[Sequence[tuple[str, ...]]], where: str
) -> Iterable[Count]:
    size = len(branch.cells[0])
    runs = [[cell for cell, _ in groupby(seq, key=lambda c: tuple(c[:size]))] for seq in sequences]
    if positions_promised(branch.order):
        at = Counter((p, cell) for run in runs for p, cell in enumerate(run))
        places = [(p, cell) for p in range(len(branch.cells)) for cell in branch.cells]
        yield Count(group, "level × position", where, _all(places, at))
    if successors_promised(branch.order) and len(branch.cells) > 1:
        after = Counter(pair for run in runs for pair in pairwise(run))
        pairs = [(a, b) for a in branch.cells for b in branch.cells if a != b]
        yield Count(group, "successor", where, _all(pairs, after))
    for cell, inner in zip(branch.cells, branch.inner, strict=bool(branch.inner)):
        within = [[c[size:] for c in seq if c[:size] == cell] for seq in sequences]
        yield from _stage(group, inner, within, f"{where} {'/'.join(cell)}".strip())


Thing = TypeVar("Thing", bound=Hashable)


def _all(wanted: Iterable[Thing], counts: Mapping[Thing, int]) -> dict[Hashable, int]:
    """Every thing that should occur, and every one that does."""
    return {key: counts.get(key, 0) for key in dict.fromkeys([*wanted, *counts])}


def _items(design: Design, group: int, people: Mapping[int, Sequence[Met]]) -> Iterable[Count]:
    alone = [f.name for f in design.factors if f.scenes == ALONE and f.kind == WITHIN]
    changed = [f.name for f in design.factors if f.scenes == CHANGED]
    rows = design.rows(group)
    of: dict[tuple[str, ...], list[tuple[int, Met]]] = {}
    for slot, met in people.items():
        for trial in met:
            cell = tuple(trial.levels[f.name] for f in design.factors)
            if design.plans[cell].shared:
                key = (*(trial.levels[n] for n in changed), trial.task)
                of.setdefault(key, []).append(((design.group_of(slot)[1] - 1) % rows, trial))
    for key, own in of.items():
        items = sorted({t.scene for _, t in own})
        cells = sorted({tuple(t.levels[n] for n in alone) for _, t in own})
        shown = [(t.scene, tuple(t.levels[n] for n in alone), row) for row, t in own]
        in_cell = Counter((scene, levels) for scene, levels, _ in shown)
        in_row = Counter((scene, row) for scene, _, row in shown)
        wanted = list(product(items, cells, range(rows)))
        where = "/".join(key)
        yield Count(group, "item × cell", where, _all([(w[0], w[1]) for w in wanted], in_cell))
        yield Count(group, "item × row", where, _all([(w[0], w[2]) for w in wanted], in_row))
        yield Count(group, "item × cell × row", where, _all(wanted, Counter(shown)))
