"""Which measures stand in which section: times by their logarithms, all else on its scale."""

from __future__ import annotations

from seethrough.analysis.page.blocks import Block, Section, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.tests.measured import measured_blocks
from seethrough.analysis.sections.tests.ranked import ranked_blocks
from seethrough.analysis.words import capitalised

Tables = dict[str, dict[str, Table]]
"""measure → its tables by what they hold: `logs`, `tests`, `ranks`, `contrasts`, `anova…`."""


def speed_section(context: Context) -> tuple[Section | None, Tables]:
    """The measures that are analysed as logarithms; None where a study has none."""
    tables: Tables = {}
    blocks: list[Block] = []
    measures = [m for m in context.design.measures() if m.log]
    for measure in measures:
        own, tables[measure.name] = measured_blocks(context, measure)
        blocks += own
    if not measures:
        return None, {}
    said = measures[0].said
    title = capitalised(said) if len(measures) == 1 else "Times"
    blocks = blocks or [say(f"The data have no {said}.")]
    return Section("time", title, tuple(blocks)), tables


def plain_section(context: Context) -> tuple[Section, Tables]:
    """All other measures, those that are compared by their order last."""
    tables: Tables = {}
    blocks: list[Block] = []
    plain = [m for m in context.design.measures() if not m.log]
    for measure in (m for m in plain if not m.ranked):
        own, tables[measure.name] = measured_blocks(context, measure)
        blocks += own
    for measure in (m for m in plain if m.ranked):
        own, tests = ranked_blocks(context, measure)
        blocks += own
        tables[measure.name] = {"ranks": tests} if tests is not None else {}
    if not blocks:
        blocks.append(say("Nobody has a measure of accuracy under two levels."))
    return Section("accuracy", "Accuracy", tuple(blocks)), tables
