"""Which contrasts a design asks for: the scores of everybody, and the weights of groups."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Contrast, Design, Factor
from seethrough.analysis.page.blocks import Table
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import design_at
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.contrasts import trend
from seethrough.analysis.stats.undefined import is_defined

CONTRAST, BETWEEN, DIFFERENCE, SIMPLE = "contrast", "between", "interaction", "simple effect"
TRENDS = {1: "linear trend", 2: "quadratic trend"}


@dataclass(frozen=True, slots=True)
class Asked:
    """A row to be: scores of everybody, the groups' weights, and what it is called.

    `span`: what a slope is taken times for a ratio of the last level to the first.
    """

    key: str
    label: str
    kind: str
    family: str
    scores: Array
    weights: Mapping[str, float]
    scale: float
    span: float | None = None


def asked_of(context: Context, cells: Cells, where: str, anova: Table | None) -> Iterator[Asked]:
    """Every contrast that the design asks of a place, of those who did it."""
    design = design_at(context, cells)
    within = [f for f in design.crossed if len(cells.factors.get(f.name, ())) > 1]
    if context.design.groups:
        for factor in within:
            for c in _there(factor, cells):
                yield from _within(design, cells, where, factor, c)
        for factor in design.groups:
            for c in factor.contrasts():
                weights = group_weights(design, factor, c)
                level, scale = level_of(cells)
                yield Asked(f"{where}/{c.key}", f"{where}: {_words(c)}", BETWEEN,
                            f"{BETWEEN} {factor.name}", level, weights, scale)  # fmt: skip
    for factor in within:
        yield from _trends(design, cells, where, factor)
    yield from _simple(design, cells, where, within, anova, context.plan.alpha)


def _words(c: Contrast) -> str:
    return f"{c.factor}, {c.baseline} − {c.level}"


def _there(factor: Factor, cells: Cells) -> list[Contrast]:
    known = cells.factors[factor.name]
    return [c for c in factor.contrasts() if c.level in known and c.baseline in known]


def level_of(cells: Cells) -> tuple[Array, float]:
    """Each person's mean over the cells that are there, and the largest value."""
    flat = cells.values.reshape(len(cells.values), -1)
    flat = flat[:, np.isfinite(flat).any(axis=0)]
    return flat.mean(axis=1), float(np.nanmax(np.abs(flat), initial=0.0))


def _within(
    design: Design, cells: Cells, where: str, factor: Factor, c: Contrast
) -> Iterator[Asked]:
    """A within contrast over all groups, each weighing the same, and its differences between."""
    first, second = cells.both(factor.name, c.baseline, c.level)
    scores, scale = first - second, float(np.nanmax(np.abs([first, second]), initial=0.0))
    yield Asked(f"{where}/{c.key}", f"{where}: {_words(c)}", CONTRAST,
                f"{CONTRAST} {factor.name}", scores, equal_weights(design), scale)  # fmt: skip
    for group in design.groups:
        for g in group.contrasts():
            yield Asked(
                f"{where}/{c.key}×{g.key}", f"{where}: ({_words(c)}) × ({_words(g)})", DIFFERENCE,
                f"{DIFFERENCE} {factor.name} {group.name}", scores,
                group_weights(design, group, g), scale,
            )  # fmt: skip


def equal_weights(design: Design) -> dict[str, float]:
    """Every group weighs the same."""
    keys = [_group_key(cell) for cell in design.cells(design.groups)]
    return dict.fromkeys(keys, 1 / len(keys))


def _group_key(cell: Mapping[str, str]) -> str:
    return "\x1f".join(cell.values())


def group_weights(design: Design, factor: Factor, c: Contrast) -> dict[str, float]:
    """Baseline less level, over the other group factors' cells, each weighing the same."""
    cells = list(design.cells(design.groups))
    counts = {level: sum(cell[factor.name] == level for cell in cells) for level in factor.levels}
    sign = {c.baseline: 1.0, c.level: -1.0}
    return {
        _group_key(cell): sign[cell[factor.name]] / counts[cell[factor.name]]
        for cell in cells
        if cell[factor.name] in sign
    }


def _trends(design: Design, cells: Cells, where: str, factor: Factor) -> Iterator[Asked]:
    """Linear and quadratic trends over a within factor of numbers with three levels or more."""
    known = cells.factors[factor.name]
    if factor.numbers is None or len(known) < 3:
        return
    x = [factor.numbers[factor.levels.index(level)] for level in known]
    axis = list(cells.factors).index(factor.name) + 1
    moved = np.moveaxis(cells.values, axis, -1)
    flat = moved.reshape(len(moved), -1, len(known))
    flat = flat[:, np.all(np.any(np.isfinite(flat), axis=0), axis=1)]
    if not flat.shape[1]:
        return
    for degree, kind in TRENDS.items():
        if len(set(x)) <= degree:
            continue
        scores = (flat @ trend(x, degree)).mean(axis=1)
        scale = float(np.nanmax(np.abs(flat), initial=0.0) * np.max(np.abs(trend(x, degree))))
        yield Asked(f"{where}/{factor.name}^{degree}", f"{where}: {factor.name}, {kind}", kind,
                    f"{kind} {factor.name}", scores, equal_weights(design), scale,
                    x[-1] - x[0] if degree == 1 else 0.0)  # fmt: skip


def _simple(
    design: Design,
    cells: Cells,
    where: str,
    within: Sequence[Factor],
    anova: Table | None,
    alpha: float,
) -> Iterator[Asked]:
    """Where two factors interact: each contrast of the one at every level of the other."""
    if anova is None:
        return
    found = {
        frozenset(str(r["effect"]).split(" × "))
        for r in anova.rows
        if is_defined(r["p_decisive"]) and r["p_decisive"] < alpha
    }
    for factor, other in itertools.permutations(within, 2):
        if frozenset((factor.name, other.name)) in found:
            for level in cells.factors[other.name]:
                yield from _simple_rows(design, cells.pick(**{other.name: level}), where, factor,
                                        f"{other.name} {level}", equal_weights(design))  # fmt: skip
    for factor, group in itertools.product(within, design.groups):
        if frozenset((factor.name, group.name)) in found:
            for level in group.levels:
                own = [c for c in design.cells(design.groups) if c[group.name] == level]
                weights = {_group_key(c): 1 / len(own) for c in own}
                yield from _simple_rows(design, cells, where, factor,
                                        f"{group.name} {level}", weights)  # fmt: skip


def _simple_rows(
    design: Design, cells: Cells, where: str, factor: Factor, at: str, weights: Mapping[str, float]
) -> Iterator[Asked]:
    for c in _there(factor, cells):
        first, second = cells.both(factor.name, c.baseline, c.level)
        if not (np.isfinite(first) & np.isfinite(second)).any():
            continue
        scale = float(np.nanmax(np.abs([first, second]), initial=0.0))
        yield Asked(f"{where}/{c.key}@{at.replace(' ', '=', 1)}", f"{where}, {at}: {_words(c)}",
                    SIMPLE, f"{SIMPLE} {factor.name}", first - second, weights, scale)  # fmt: skip
