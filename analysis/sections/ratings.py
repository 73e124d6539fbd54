"""The questionnaire: ratings per condition, preference, depth perception."""

from __future__ import annotations

import numpy as np

from analysis.cells import Cells
from analysis.comparison import Measure, add_holm, measure
from analysis.figures.comparison import ratings_figure
from analysis.measures import answers, rating
from analysis.page.blocks import Block, Column, Section, Table, say
from analysis.sections.context import Context
from analysis.sections.ordinal import (
    four_conditions,
    friedman_row,
    friedman_sentence,
    friedman_table,
)
from analysis.sections.tables import keep, missing_note
from analysis.stats.ranks import share_interval, sign_test
from analysis.stats.undefined import ONE_PARTICIPANT, Undefined

ONCE = {
    "preference": "preference for dynamic transparency (0 or 1)",
    "depth_self_report": "self-reported depth perception (0–4)",
    "depth_test": "static depth test (correct of 3)",
}
SINGLE = (
    Column("item", "item"),
    Column("label", "item"),
    Column("n", "n", "int"),
    Column("mean", "mean", "fixed2", "95 % interval of a share", "low", "high"),
    Column("sd", "SD", "fixed2"),
    Column("low", "from", "bound2", "95 % interval of the share"),
    Column("high", "to", "bound2", "95 % interval of the share"),
    Column("p", "p (sign test)", "p"),
)


def ratings_section(context: Context) -> Section | None:
    """None if the study asked nothing."""
    table = context.study.questionnaire
    if not len(table):
        return None
    blocks: list[Block] = []
    cells = rating(table)
    context.missing["ratings"] = cells.missing
    if cells.factors["item"] and len(cells.values):
        blocks += _ratings(context, cells)
    blocks += [*missing_note(cells.missing), *_single(context)]
    return Section("ratings", "Ratings and preference", tuple(blocks)) if blocks else None


def _ratings(context: Context, cells: Cells) -> list[Block]:
    each: list[Measure] = []
    for scenario in cells.factors["scenario"]:
        for item in cells.factors["item"]:
            at = {"item": item, "scenario": scenario}
            found = measure(
                f"{item}_{scenario}", f"{item}, {scenario}", "", 2, cells, "ratings", **at
            )
            each += keep([found])
    overall = keep([measure("rating_overall", "overall", "", 2, cells)])
    rows = [friedman_row(m, context, 30 + i) for i, m in enumerate([*overall, *each])]
    if not rows:
        return []
    add_holm(rows, [*overall, *each], "p_exact")
    tests = friedman_table("friedman_ratings", "Ratings (0–4): Friedman tests", rows)
    said = [friedman_sentence(tests, m.key, _said(m), context.plan) for m in [*overall, *each]]
    figure = ratings_figure("ratings", each, cells.factors["scenario"], tests)
    return [*said, figure, tests, *four_conditions(context, cells, 50)]


def _said(m: Measure) -> str:
    return "Overall rating (0–4)" if m.key == "rating_overall" else f"Rating of {m.label}"


def _single(context: Context) -> list[Block]:
    """Items that were asked once."""
    rows = []
    for item, label in ONCE.items():
        values = answers(context.study.questionnaire, item)
        if not len(values):
            continue
        n, hits = len(values), int(np.sum(values == 1))
        share = item == "preference"
        ends = share_interval(hits, n) if share else (None, None)
        rows.append(
            {
                "item": item,
                "label": label,
                "n": n,
                "mean": float(values.mean()),
                "sd": float(np.std(values, ddof=1)) if n > 1 else Undefined(ONE_PARTICIPANT),
                "low": ends[0],
                "high": ends[1],
                "p": sign_test(hits, n - hits) if share else None,
            }
        )
    if not rows:
        return []
    table = Table(
        "single_items",
        "Preference and depth perception",
        SINGLE,
        tuple(rows),
        tuple("label n mean sd p".split()),
        "Preference: 1 dynamic, 0 standard or neutral; its interval is Clopper and Pearson's.",
    )
    return [*_preference(table), table]


def _preference(table: Table) -> list[Block]:
    if "preference" not in [r["item"] for r in table.rows]:
        return []
    p = table.cite("preference", "p")
    return [
        say(
            "A share of {} of the {} participants prefers dynamic transparency, 95 % CI [{}, {}], "
            f"sign test p {'' if p.text.startswith('<') else '= '}{{}}.",
            table.cite("preference", "mean", "bound2"),
            table.cite("preference", "n"),
            table.cite("preference", "low"),
            table.cite("preference", "high"),
            p,
        )
    ]
