"""Every pair of a factor's levels, where the study or whoever made the report asked for it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Contrast, Design, Factor, Measured
from seethrough.analysis.measures import TASK, groups_of, over_tasks
from seethrough.analysis.page.blocks import Block, Column, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import design_at
from seethrough.analysis.sections.tests.asked_contrasts import (
    Asked,
    equal_weights,
    group_weights,
    level_of,
)
from seethrough.analysis.sections.tests.contrasts import COLUMNS, OBSERVED, Row, row_of
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.multiplicity import add_holm
from seethrough.analysis.stats.ranks import signed_rank
from seethrough.analysis.stats.ties import slack
from seethrough.analysis.stats.undefined import is_defined
from seethrough.analysis.words import capitalised

KIND = "pair"
NOTE = (
    "Asked for, not only each level against the baseline. Differences are first − second, each "
    "with an error of its own; Holm over all pairs of the factor."
)
RANKED = (
    Column("pair", "pair"),
    Column("label", "pair"),
    Column("n", "n", "int"),
    Column("statistic", "V or H", "fixed1", "signed ranks within people, H between groups"),
    Column("p", "p", "p", "exact, or by permutations"),
    Column("p_holm", "p (Holm)", "p", "over all pairs of the factor"),
    Column("method", "by"),
)


def _pairs(context: Context, cells: Cells) -> Iterator[tuple[Design, Factor, Contrast]]:
    """Every pair of levels that a place has of the factors that were asked for."""
    design = design_at(context, cells)
    for factor in (*design.crossed, *design.groups):
        known = cells.factors.get(factor.name, () if factor.within else factor.levels)
        if factor.name not in context.plan.pairwise or len(known) < 3:
            continue
        for a, b in itertools.combinations(known, 2):
            yield design, factor, Contrast(factor.name, a, b, a, b, not factor.within)


def _places(cells: Cells, pool: bool) -> Iterator[tuple[str, Cells]]:
    if len(cells.factors[TASK]) > 1 and pool:
        yield "overall", over_tasks(cells)
    for task in cells.factors[TASK]:
        yield task, cells.pick(task=task)


def pairwise_blocks(context: Context, measure: Measured, cells: Cells, log: bool) -> list[Block]:
    """The table of all pairs on the scale that decides; nothing where none was asked for."""
    rows: list[Row] = []
    families: list[str] = []
    for where, own in _places(cells, measure.pool):
        said = where if where == "overall" else context.design.task_said(where)
        for design, factor, c in _pairs(context, own):
            scores, weights, scale = _scores(design, own, factor, c)
            key = f"{where}/{factor.name}={c.baseline},{c.level}"
            label = f"{said}: {factor.name}, {c.baseline} − {c.level}"
            asked = Asked(key, label, KIND, factor.name, scores, weights, scale)
            # a margin is declared of each level against the baseline
            made = row_of(context, own, asked, replace(measure, margin=None), log)
            if made is not None:
                rows.append(made)
                families.append(f"{where} {factor.name}")
    if not rows:
        return []
    add_holm(rows, families)
    shown = ("label", "n", "estimate", "t", "df", "p", "p_holm", *(["ratio"] if log else []))
    gone = ("kind", "tost_margin", "tost_p", "noninferior_p")
    columns = tuple(c for c in COLUMNS if c.name not in gone)
    name = f"pairwise_{'log_' if log else ''}{measure.name}"
    title = f"{measure.title}: all pairs"
    table = Table(name, title + (", logarithms" if log else ""), columns, tuple(rows), shown,
                  _note(context))  # fmt: skip
    return [_sentence(context, measure, rows), table]


def _scores(
    design: Design, cells: Cells, factor: Factor, c: Contrast
) -> tuple[Array, Mapping[str, float], float]:
    """One score a person, the groups' weights, and the largest value behind them."""
    if not factor.within:
        level, scale = level_of(cells)
        return level, group_weights(design, factor, c), scale
    first, second = cells.both(factor.name, c.baseline, c.level)
    scale = float(np.nanmax(np.abs([first, second]), initial=0.0))
    return first - second, equal_weights(design), scale


def _note(context: Context) -> str:
    brought = [f for f in context.design.groups
               if f.kind == "measured" and f.name in context.plan.pairwise]  # fmt: skip
    return " ".join([NOTE, *(OBSERVED.format(capitalised(f.name)) for f in brought)])


def _sentence(context: Context, measure: Measured, rows: list[Row]) -> Block:
    """Which pairs differ."""
    found = [str(r["label"]) for r in rows
             if is_defined(r["p_holm"]) and r["p_holm"] < context.plan.alpha]  # fmt: skip
    what = f"{measure.title}, of {len(rows)} pairs"
    if not found:
        return say(f"{what} none was shown to differ, which is no evidence of equality.")
    return say(f"{what} these differ: {'; '.join(found)}.")


def ranked_pairwise(context: Context, measure: Measured, cells: Cells) -> list[Block]:
    """The same of what is compared by its order: signed ranks within people, ranks of groups."""
    rows: list[Row] = []
    families: list[str] = []
    for where, own in _places(cells, measure.pool):
        said = where if where == "overall" else context.design.task_said(where)
        for design, factor, c in _pairs(context, own):
            row = _ranked(context, design, own, factor, c, 600 + len(rows))
            if row is not None:
                words = f"{said}: {factor.name}, {c.baseline} – {c.level}"
                key = f"{where}/{factor.name}={c.baseline},{c.level}"
                rows.append({"pair": key, "label": words, **row})
                families.append(f"{where} {factor.name}")
    if not rows:
        return []
    add_holm(rows, families)
    title = f"{measure.title}: all pairs, by ranks"
    table = Table(f"pairwise_{measure.name}", title, RANKED, tuple(rows),
                  tuple("label n statistic p p_holm method".split()), _note(context))  # fmt: skip
    return [_sentence(context, measure, rows), table]


def _ranked(
    context: Context, design: Design, cells: Cells, factor: Factor, c: Contrast, purpose: int
) -> Row | None:
    """Of who has both levels; of means over the other conditions."""
    if factor.within:
        first, second = cells.both(factor.name, c.baseline, c.level)
        has = np.isfinite(first) & np.isfinite(second)
        if not has.any():
            return None
        a, b = first[has], second[has]
        test = signed_rank(a - b, slack(a, b, largest=cells.largest))
        return {"n": int(has.sum()), "statistic": test.v, "p": test.p, "method": test.method}
    level, largest = level_of(cells)
    own = np.array(groups_of(context.study.trials, factor, cells.participants))
    sides = [level[(own == x) & np.isfinite(level)] for x in (c.baseline, c.level)]
    if any(len(side) == 0 for side in sides):
        return None
    found = kruskal_wallis(sides, context.rng(purpose), largest)
    return {"n": found.n, "statistic": found.h, "p": found.exact, "method": found.method}
