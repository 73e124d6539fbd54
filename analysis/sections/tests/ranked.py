"""Right or wrong, and ordinal measures: compared by their order alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair
from seethrough.analysis.design import Factor, Measured
from seethrough.analysis.measures import TASK, cells_of, groups_of
from seethrough.analysis.page.blocks import Block, Column, Prose, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import cell_table
from seethrough.analysis.sections.tests.aligned import aligned_blocks
from seethrough.analysis.sections.tests.measured import in_short, pairs_of
from seethrough.analysis.sections.tests.ordinal import (
    conditions,
    friedman_row,
    friedman_sentence,
    friedman_table,
)
from seethrough.analysis.sections.tests.pairwise import ranked_pairwise
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.multiplicity import add_holm
from seethrough.analysis.stats.undefined import is_defined

GROUPS = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("k", "groups", "int"),
    Column("medians", "medians"),
    Column("h", "H", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p (χ²)", "p"),
    Column("p_exact", "p (permutation)", "p", "enumerated, or drawn where that is too long"),
    Column("method", "by"),
)


def ranked_blocks(context: Context, measure: Measured) -> tuple[list[Block], Table | None]:
    """Cells, Friedman's tests of pairs and of all conditions, tests between groups; and the table
    of pairs."""
    cells = cells_of(context.trials, context.design, measure)
    if not cells.factors[TASK] or not (cells.counts > 0).any():
        return [], None
    binary = measure.scale == "binary"
    context.lacking(f"share {measure.column}" if binary else measure.said, cells)
    what = measure.title
    title = f"Share of {measure.said}" if binary else f"{what} by cell"
    table = cell_table(f"{measure.name}_cells", title, cells, context,
                       kind="bound" if binary else "fixed")  # fmt: skip
    pairs = pairs_of(context, measure, cells)
    blocks: list[Block] = []
    tests = None
    if pairs:
        rows = [friedman_row(m, context, 10 + i) for i, m in enumerate(pairs)]
        add_holm(rows, [m.family for m in pairs], "p_exact")
        tests = friedman_table(f"friedman_{measure.name}", f"{what}: Friedman tests", rows, pairs,
                               binary)  # fmt: skip
        said = [friedman_sentence(tests, m, f"{what}, {m.label}", context) for m in pairs]
        rows_of = [tests.row(m.key) for m in pairs]
        blocks += in_short(list(zip(pairs, rows_of, said, strict=True)), context, what)
    blocks.append(table)
    if tests is not None:
        blocks.append(tests)
    blocks += _conditions(context, measure, cells, what)
    blocks += _between(context, measure, cells, what, pairs)
    blocks += ranked_pairwise(context, measure, cells)
    blocks += aligned_blocks(context, measure, cells)
    return blocks, tests


def _conditions(context: Context, measure: Measured, cells: Cells, what: str) -> list[Table]:
    """Friedman over the conditions of a task, where there are three or more."""
    found: list[Table] = []
    factors = [f.name for f in context.design.crossed if len(cells.factors[f.name]) > 1]
    for i, task in enumerate(cells.factors[TASK]):
        several = f"_{task}" if len(cells.factors[TASK]) > 1 else ""
        own = cells.pick(task=task)
        key = f"{measure.name}_conditions{several}"
        found += conditions(context, own, factors, key, key,
                            f"{what}, {context.design.task_said(task)}", 200 + i)  # fmt: skip
    return found


def _between(
    context: Context, measure: Measured, cells: Cells, what: str, pairs: Sequence[Pair]
) -> list[Block]:
    """Kruskal and Wallis's test of each factor between people, on the person's mean."""
    rows: list[dict[str, object]] = []
    for number, factor in enumerate(context.design.groups):
        for i, task in enumerate(cells.factors[TASK]):
            row = _group_row(context, cells.pick(task=task), factor, 300 + 50 * number + i)
            if row is not None:
                label = f"{context.design.task_said(task)}: {factor.name}"
                rows.append({"measure": f"{measure.name}_{task}/{factor.name}", "label": label,
                             **row})  # fmt: skip
    if not rows:
        return []
    note = "On each person's mean over the conditions. "
    note += "Of two groups, Mann and Whitney's test. Uncorrected for being one of several."
    if pairs:
        note += " The tests above take all groups together."
    table = Table(f"groups_{measure.name}", f"{what} between groups", GROUPS, tuple(rows),
                  tuple("label n k medians h df p p_exact method".split()), note)  # fmt: skip
    return [*(_sentence(table, str(r["measure"]), what) for r in rows), table]


def _group_row(
    context: Context, cells: Cells, factor: Factor, purpose: int
) -> dict[str, object] | None:
    flat = cells.values.reshape(len(cells.values), -1)
    level = flat[:, np.isfinite(flat).any(axis=0)].mean(axis=1)
    own = np.array(groups_of(context.study.trials, factor, cells.participants))
    groups = [level[(own == name) & np.isfinite(level)] for name in factor.levels]
    groups = [g for g in groups if len(g)]
    if len(groups) < 2:
        return None
    test = kruskal_wallis(groups, context.rng(purpose), cells.largest)
    return {
        "n": test.n,
        "k": len(groups),
        "medians": ", ".join(f"{np.median(g):.3g}" for g in groups),
        "h": test.h,
        "df": len(groups) - 1,
        "p": test.p,
        "p_exact": test.exact,
        "method": test.method,
    }


def _sentence(table: Table, key: str, what: str) -> Prose:
    row = table.row(key)
    if not is_defined(row["h"]):
        return say(f"{what}, {row['label']}: {{}}.", table.cite(key, "h"))
    p = table.cite(key, "p_exact")
    return say(
        f"{what}, {row['label']}: H({{}}) = {{}}, permutation p {equals(p.text)}{{}}.",
        table.cite(key, "df"),
        table.cite(key, "h"),
        p,
    )
