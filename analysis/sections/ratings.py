"""The questionnaire: ratings per condition, preference, depth perception."""

from __future__ import annotations

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Measure, add_holm, measure, sd_of
from seethrough.analysis.figures.comparison import ratings_figure
from seethrough.analysis.measures import answers, rating
from seethrough.analysis.page.blocks import Block, Cited, Column, Section, Table, say
from seethrough.analysis.sections.context import Context
from seethrough.analysis.sections.ordinal import (
    four_conditions,
    friedman_row,
    friedman_sentence,
    friedman_table,
)
from seethrough.analysis.sections.tables import keep, missing_note
from seethrough.analysis.stats.ranks import share_interval, sign_test
from seethrough.analysis.stats.undefined import Undefined, is_defined

ONCE = {
    "preference": "preference for dynamic transparency (0 or 1)",
    "depth_self_report": "self-reported depth perception (0–4)",
    "depth_test": "static depth test (correct of 3)",
}
ITEMS = {"efficiency": "efficiency", "ease": "ease of use", "enjoy": "enjoyment"}
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
    cells = rating(table)
    context.lacking("ratings", cells)
    if cells.factors["item"]:
        blocks += _ratings(context, cells)
    blocks += [*missing_note(cells.missing), *_single(context)]
    return Section("ratings", "Ratings and preference", tuple(blocks)) if blocks else None


def _ratings(context: Context, cells: Cells) -> list[Block]:
    each: list[Measure] = []
    for scenario in cells.factors["scenario"]:
        for item in cells.factors["item"]:
            at = {"item": item, "scenario": scenario}
            found = measure(
                f"{item}_{scenario}", f"{item}, {scenario}", "", 2, cells, "ratings", "", **at
            )
            each += keep([found])
    overall = keep([measure("rating_overall", "overall", "", 2, cells)])
    rows = [friedman_row(m, context, 30 + i) for i, m in enumerate([*overall, *each])]
    if not rows:
        return []
    add_holm(rows, [*overall, *each], "p_exact")
    tests = friedman_table("friedman_ratings", "Ratings (0–4): Friedman tests", rows)
    said = [friedman_sentence(tests, m.key, _said(m), context) for m in [*overall, *each]]
    figure = ratings_figure("ratings", each, cells.factors["scenario"], tests)
    return [*said, figure, tests, *four_conditions(context, cells, 50)]


def _said(m: Measure) -> str:
    if m.key == "rating_overall":
        return "Overall rating (0–4)"
    item, scenario = m.label.split(", ")
    return f"Rating of {ITEMS[item]}, {scenario}"


_OF_SHARES = ("neutral", "low", "high", "p")
"""Columns that only the preference has."""


def _single(context: Context) -> list[Block]:
    """Items that were asked once."""
    asked = context.study.questionnaire
    rows = []
    for item, label in ONCE.items():
        values = answers(asked, item)
        if len(values):
            own = _share(asked) if item == "preference" else dict.fromkeys(_OF_SHARES)
            rows.append(
                {
                    "item": item,
                    "label": label,
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
        "Preference and depth perception",
        SINGLE,
        tuple(rows),
        tuple("label n neutral mean sd p".split()),
        "Preference: 1 dynamic, 0 standard. Who prefers neither is a tie: counted, and left out of "
        "share, interval (Clopper and Pearson's) and sign test.",
    )
    return [*_preference(table), table]


def preferences(asked: pd.DataFrame) -> tuple[int, int, int]:
    """How many prefer dynamic transparency, the standard, and neither.

    Neither is what says so in `text`, or has a value between 0 and 1.
    """
    own = asked[(asked["item"] == "preference") & asked["value"].notna()]
    value, text = own["value"], own["text"].astype("str")
    neither = (text == NEUTRAL) | ((value != 0) & (value != 1))
    return (
        int(((value == 1) & ~neither).sum()),
        int(((value == 0) & ~neither).sum()),
        int(neither.sum()),
    )


def _share(asked: pd.DataFrame) -> dict[str, object]:
    """The columns of the preference: its share and interval are of those who prefer one."""
    dynamic, standard, neither = preferences(asked)
    n = dynamic + standard
    if n == 0:
        gone = Undefined("nobody prefers one to the other")
        return {"neutral": neither, "mean": gone, "sd": gone, "low": gone, "high": gone, "p": gone}
    low, high = share_interval(dynamic, n)
    share = np.repeat([1.0, 0.0], [dynamic, standard])
    return {
        "neutral": neither,
        "mean": dynamic / n,
        "sd": sd_of(share),
        "low": low,
        "high": high,
        "p": sign_test(dynamic, standard),
    }


def _preference(table: Table) -> list[Block]:
    if "preference" not in [r["item"] for r in table.rows]:
        return []
    row = table.row("preference")
    neutral: list[str | Cited] = []
    if row["neutral"]:
        neutral = [", of them ", table.cite("preference", "neutral"), " for neither"]
    if not is_defined(row["mean"]):
        return [say("Preference: {}.", table.cite("preference", "mean"))]
    p = table.cite("preference", "p")
    return [
        say(
            "Preference (n = {}{}): of those who prefer one, a share of {} prefers dynamic "
            "transparency, 95 % CI [{}, {}], "
            f"sign test p {'' if p.text.startswith(('<', '>')) else '= '}{{}}.",
            table.cite("preference", "n"),
            neutral,
            table.cite("preference", "mean", "bound2"),
            table.cite("preference", "low"),
            table.cite("preference", "high"),
            p,
        )
    ]
