"""Aligned ranks of ordinal measures, only where they were asked for."""

from __future__ import annotations

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Measured
from seethrough.analysis.measures import TASK
from seethrough.analysis.page.blocks import Block, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import EFFECTS, effect_row
from seethrough.analysis.sections.tests.omnibus import complete
from seethrough.analysis.stats.aligned import aligned_ranks

WARNING = (
    "Aligned ranks were asked for. They reject far too often where values are discrete or skewed, "
    "and an effect of one factor leaks into tests of others (Tsandilas and Casiez 2024): what only "
    "they show is no finding."
)
GROUPS = "For designs with groups of people they were never validated, so none are computed here."
SHOWN = tuple("effect df1 df2 F p eps p_gg".split())


def aligned_blocks(context: Context, measure: Measured, cells: Cells) -> list[Block]:
    """A table for each task with two or more within factors, the warning first."""
    if not context.plan.aligned_ranks:
        return []
    if context.design.groups:
        return [say(f"{WARNING} {GROUPS}", kind="warning")]
    found: list[Block] = []
    for task in cells.factors[TASK]:
        kept, gone = complete(context.design, cells.pick(task=task))
        whole = kept.lone().whole()
        if whole.values.ndim < 3 or len(whole.values) < 2:
            continue
        several = f"_in_{task}" if len(cells.factors[TASK]) > 1 else ""
        effects = aligned_ranks(whole.values, tuple(whole.factors))
        title = f"{measure.title}, {context.design.task_said(task)}: "
        found.append(
            Table(f"aligned_{measure.name}{several}", f"{title}aligned ranks", EFFECTS,
                  tuple(effect_row(e) for e in effects.values()), SHOWN, gone)
        )  # fmt: skip
    return [say(WARNING, kind="warning"), *found] if found else []
