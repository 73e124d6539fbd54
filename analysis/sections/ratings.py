"""The questionnaire: ratings per condition, preference, depth perception."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair, add_holm, pair_of, sd_of
from seethrough.analysis.design import Item
from seethrough.analysis.figures.comparison import ratings_figure
from seethrough.analysis.measures import answers, ratings
from seethrough.analysis.page.blocks import Block, Cited, Column, Section, Table, say
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
from seethrough.analysis.stats.ranks import share_interval, sign_test
from seethrough.analysis.stats.undefined import Undefined, is_defined

SINGLE = (
    Column("item", "item"),
    Column("label", "item"),
    Column("n", "n", "int"),
    Column("neutral", "neutral", "int", "for neither: left out of share and test"),
    Column("mean", "mean", "fixed2", "95 % interval of a share", "low", "high"),
    Column("sd", "SD", "fixed2"),
    Column("low", "from", "bound2", "95 % interval of the share"),
    Column("high", "to", "bound2", "95 % interval of the share"),
    Column("p", "p (sign test)", "p"),
)
NEUTRAL = "neutral"
"""What the row of a preference says in `text` where it is for neither."""


def ratings_section(context: Context) -> Section | None:
    """None if the study asked nothing."""
    table = context.study.questionnaire
    if not len(table):
        return None
    blocks: list[Block] = []
    for number, group in enumerate(asked_alike(context)):
        blocks += _group(context, group, number)
    blocks += _single(context, [item for item in items_of(context) if not item.each])
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
    add_holm(rows, [*means, *found], "p_exact")
    scale = _points(items)
    title = f"{name[:1].upper()}{name[1:]}{f' ({scale})' if scale else ''}: Friedman tests"
    tests = friedman_table(f"friedman_{name}", title, rows, [*means, *found])
    over_all = [
        friedman_sentence(tests, m, f"Overall rating{f' ({scale})' if scale else ''}"
                          + m.label.removeprefix("overall"), context)
        for m in means
    ]  # fmt: skip
    each_said = [friedman_sentence(tests, m, _said(m, labels), context) for m in found]
    said = in_short([(m, tests.row(m.key), sentence) for m, sentence in zip(
        [*means, *found], [*over_all, *each_said], strict=True)], context,
        name[:1].upper() + name[1:])  # fmt: skip
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


_OF_SHARES = ("neutral", "low", "high", "p")
"""Columns that only the preference has."""


def _single(context: Context, items: Sequence[Item]) -> list[Block]:
    """Items that were asked once."""
    asked = context.study.questionnaire
    rows, sides = [], []
    for item in items:
        values = answers(asked, item.name)
        if len(values):
            own = _share(asked, item) if item.of else dict.fromkeys(_OF_SHARES)
            if item.of:
                sides.append((item, _sides(context, item)))
            rows.append(
                {
                    "item": item.name,
                    "label": item.label or item.name,
                    "n": len(values),
                    "mean": float(values.mean()),
                    "sd": sd_of(values),
                    **own,
                }
            )
    if not rows:
        return []
    table = Table(
        "single_items",
        "Asked once",
        SINGLE,
        tuple(rows),
        tuple("label n neutral mean sd p".split()),
        "".join(f"{i.name.capitalize()}: 1 {second}, 0 {first}. " for i, (first, second) in sides)
        + ("Who prefers neither is a tie: counted, and left out of share, interval (Clopper and "
           "Pearson's) and sign test." if sides else ""),
    )  # fmt: skip
    return [*(p for item, _ in sides for p in _preference(context, table, item)), table]


def _sides(context: Context, item: Item) -> tuple[str, str]:
    """The two levels that a preference is between."""
    factor = context.design.factor(item.of)
    level = next((c.level for c in factor.contrasts()), factor.baseline)
    return factor.baseline, level


def preferences(asked: pd.DataFrame, item: str) -> tuple[int, int, int]:
    """How many prefer the level, the baseline, and neither.

    Neither is what says so in `text`, or has a value between 0 and 1.
    """
    own = asked[(asked["item"] == item) & asked["value"].notna()]
    value, text = own["value"], own["text"].astype("str")
    neither = (text == NEUTRAL) | ((value != 0) & (value != 1))
    return (
        int(((value == 1) & ~neither).sum()),
        int(((value == 0) & ~neither).sum()),
        int(neither.sum()),
    )


def _share(asked: pd.DataFrame, item: Item) -> dict[str, object]:
    """The columns of the preference: its share and interval are of those who prefer one."""
    level, baseline, neither = preferences(asked, item.name)
    n = level + baseline
    if n == 0:
        gone = Undefined("nobody prefers one to the other")
        return {"neutral": neither, "mean": gone, "sd": gone, "low": gone, "high": gone, "p": gone}
    low, high = share_interval(level, n)
    share = np.repeat([1.0, 0.0], [level, baseline])
    return {
        "neutral": neither,
        "mean": level / n,
        "sd": sd_of(share),
        "low": low,
        "high": high,
        "p": sign_test(level, baseline),
    }


def _preference(context: Context, table: Table, item: Item) -> list[Block]:
    key, said = item.name, f"{item.name[:1].upper()}{item.name[1:]}"
    factor = context.design.factor(item.of)
    words = factor.label(_sides(context, item)[1])
    row = table.row(key)
    neutral: list[str | Cited] = []
    if row["neutral"]:
        neutral = [", of them ", table.cite(key, "neutral"), " for neither"]
    if not is_defined(row["mean"]):
        return [say(f"{said}: {{}}.", table.cite(key, "mean"))]
    p = table.cite(key, "p")
    return [
        say(
            f"{said} (n = {{}}{{}}): of those who prefer one, a share of {{}} prefers {words}, "
            "95 % CI [{}, {}], "
            f"sign test p {'' if p.text.startswith(('<', '>')) else '= '}{{}}.",
            table.cite(key, "n"),
            neutral,
            table.cite(key, "mean", "bound2"),
            table.cite(key, "low"),
            table.cite(key, "high"),
            p,
        )
    ]
