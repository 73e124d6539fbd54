"""The questionnaire: ratings per condition, preference, depth perception."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair, pair_of
from seethrough.analysis.design import Item
from seethrough.analysis.figures.comparison import ratings_figure
from seethrough.analysis.measures import ratings
from seethrough.analysis.page.blocks import Block, Section
from seethrough.analysis.sections.asked_once import once_blocks
from seethrough.analysis.sections.base.asked import (
    Alike,
    asked_alike,
    items_of,
    one_scale,
    scales,
)
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import keep, missing_note
from seethrough.analysis.sections.reliability import reliability_blocks
from seethrough.analysis.sections.tests.measured import in_short
from seethrough.analysis.sections.tests.ordinal import (
    conditions,
    friedman_row,
    friedman_sentence,
    friedman_table,
)
from seethrough.analysis.stats.multiplicity import add_holm
from seethrough.analysis.words import capitalised


def ratings_section(context: Context) -> Section | None:
    """None if the study asked nothing."""
    table = context.study.questionnaire
    if not len(table):
        return None
    blocks: list[Block] = []
    for number, group in enumerate(asked_alike(context)):
        blocks += _group(context, group, number)
    blocks += once_blocks(context, [item for item in items_of(context) if not item.each])
    blocks += reliability_blocks(context, scales(context))
    return Section("ratings", "Questionnaire", tuple(blocks)) if blocks else None


def _group(context: Context, group: Alike, number: int) -> list[Block]:
    """Items that are asked alike: tests of each and of their mean, by level."""
    names = [i.name for i in group.items]
    cells = ratings(context.study.questionnaire, names, group.each)
    context.lacking(group.name, cells)
    blocks = _ratings(context, cells, group, number) if cells.factors["item"] else []
    return [*blocks, *missing_note(context.missing[group.name])]


def _ratings(context: Context, cells: Cells, group: Alike, number: int) -> list[Block]:
    name, items, (*others, main) = group.name, group.items, group.each
    contrasts = [c for c in main.contrasts() if c.level in cells.factors[main.name]]
    several = len(contrasts) > 1
    each, overall = [], []
    labels = {i.name: i.label for i in items}
    for contrast in contrasts:
        ending = f"/{contrast.key}" if several else ""
        words = f": {contrast.baseline} → {contrast.level}" if several else ""
        for where in itertools.product(*(cells.factors[f.name] for f in others)):
            for item in cells.factors["item"]:
                at = {"item": item, **dict(zip((f.name for f in others), where, strict=True))}
                key = "_".join((item, *where)) + ending
                label = ", ".join((item, *where)) + words
                each.append(pair_of(key, label, "", 2, cells, contrast, "ratings", at=at))
        if (len(cells.factors["item"]) > 1 or others) and not group.both_ways:
            key = f"{group.stem}_overall{ending}"
            family = "overall" if several else ""
            overall.append(pair_of(key, f"overall{words}", "", 2, cells, contrast, family))
    found, means = keep(each), keep(overall)
    rows = [friedman_row(m, context, 30 + i + 1000 * number)
            for i, m in enumerate([*means, *found])]  # fmt: skip
    if not rows:
        return []
    add_holm(rows, [m.family for m in (*means, *found)], "p_exact")
    scale = _points(items)
    title = f"{capitalised(name)}{f' ({scale})' if scale else ''}: Friedman tests"
    tests = friedman_table(f"friedman_{name}", title, rows, [*means, *found])
    over_all = [
        friedman_sentence(tests, m, f"Overall rating{f' ({scale})' if scale else ''}"
                          + m.label.removeprefix("overall"), context)
        for m in means
    ]  # fmt: skip
    each_said = [friedman_sentence(tests, m, _said(m, labels), context) for m in found]
    said = in_short([(m, tests.row(m.key), sentence) for m, sentence in zip(
        [*means, *found], [*over_all, *each_said], strict=True)], context,
        capitalised(name))  # fmt: skip
    ending = "conditions" if name == "ratings" else f"{name}_conditions"
    ordered = [main.name, *(f.name for f in others)]
    over = conditions(context, cells, ordered, ending, f"{group.stem}_conditions",
                      "Overall rating", 50 + 1000 * number)  # fmt: skip
    if several or not found:
        return [*said, tests, *over]
    figure = ratings_figure(name, found, others, tests, scale)
    return [*said, figure, tests, *over]


def _points(items: Sequence[Item]) -> str:
    """`0–4` where the items say how many points their scale has."""
    first = items[0]
    if first.points is None or not one_scale(items):
        return ""
    return f"{first.low:g}–{first.low + first.points - 1:g}"


def _said(m: Pair, labels: Mapping[str, str]) -> str:
    item, comma, where = m.label.partition(", ")
    return f"{labels.get(item, item).capitalize()}{comma}{where}"
