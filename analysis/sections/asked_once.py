"""What was asked once: numbers with their spread, names with their counts, a preference with its
test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from seethrough.analysis.comparison import sd_of
from seethrough.analysis.design import Item
from seethrough.analysis.measures import answers
from seethrough.analysis.page.blocks import Block, Cited, Column, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.ranks import share_interval, sign_test
from seethrough.analysis.stats.undefined import Undefined, is_defined
from seethrough.analysis.words import capitalised

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
_OF_SHARES = ("neutral", "low", "high", "p")
"""Columns that only the preference has."""


CHOICES = (
    Column("choice", "choice"),
    Column("label", "item"),
    Column("option", "option"),
    Column("n", "n", "int", "who answered"),
    Column("chosen", "chose it", "int"),
    Column("share", "share", "fixed2"),
)


def _options(asked: pd.DataFrame, item: Item) -> list[str]:
    """The options that an item's rows name, in the order of their values; none for a number."""
    own = asked[(asked["item"] == item.name) & asked["value"].notna()]
    named = own[own["text"].astype("str").str.strip() != ""]
    return [str(t) for t in dict.fromkeys(named.sort_values("value")["text"].astype("str"))]


def _choices(context: Context, items: Sequence[Item]) -> list[Block]:
    """How often each option was chosen, of items whose values are names."""
    asked = context.study.questionnaire
    rows = []
    for item in items:
        own = asked[(asked["item"] == item.name) & asked["value"].notna()]["text"].astype("str")
        rows += [
            {
                "choice": f"{item.name}/{option}",
                "label": item.label or item.name,
                "option": option,
                "n": len(own),
                "chosen": int((own == option).sum()),
                "share": float((own == option).mean()),
            }
            for option in _options(asked, item)
        ]
    if not rows:
        return []
    shown = ("label", "option", "n", "chosen", "share")
    return [Table("choices", "What was chosen", CHOICES, tuple(rows), shown)]


def once_blocks(context: Context, items: Sequence[Item]) -> list[Block]:
    """Items that were asked once. Where the study says what it asked, names are counted."""
    asked = context.study.questionnaire
    options = {i.name: _options(asked, i) for i in items if not i.of} if (
        context.design.items is not None) else {}  # fmt: skip
    named = [i for i in items if i.points is None and len(options.get(i.name, ())) > 1]
    return [*_numbers(context, [i for i in items if i not in named], options),
            *_choices(context, named)]  # fmt: skip


def _numbers(
    context: Context, items: Sequence[Item], options: Mapping[str, Sequence[str]]
) -> list[Block]:
    asked = context.study.questionnaire
    rows, sides = [], []
    for item in items:
        values = answers(asked, item.name)
        if len(values):
            about = "".join(f": {option}" for option in options.get(item.name, ())[:1])
            own = _share(asked, item) if item.of else dict.fromkeys(_OF_SHARES)
            if item.of:
                sides.append((item, _sides(context, item)))
            rows.append(
                {
                    "item": item.name,
                    "label": (item.label or item.name) + about,
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
    key, said = item.name, capitalised(item.name)
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
            f"sign test p {equals(p.text)}{{}}.",
            table.cite(key, "n"),
            neutral,
            table.cite(key, "mean", "bound2"),
            table.cite(key, "low"),
            table.cite(key, "high"),
            p,
        )
    ]
