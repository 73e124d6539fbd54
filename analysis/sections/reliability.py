"""Whether items that are averaged or added up measure one thing: α and ω in each condition."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from seethrough.analysis.design import Item
from seethrough.analysis.measures import ratings
from seethrough.analysis.page.blocks import Block, Cited, Column, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.reliability import LEAST_ITEMS, reliability
from seethrough.analysis.stats.undefined import is_defined, number_in

COLUMNS = (
    Column("scale", "scale"),
    Column("label", "scale"),
    Column("items", "items", "int"),
    Column("n", "n", "int", "who answered them all"),
    Column("alpha", "α", "bound2", "95 % interval (Feldt)", "low", "high"),
    Column("low", "from", "bound2", "95 % interval"),
    Column("high", "to", "bound2", "95 % interval"),
    Column("omega", "ω", "bound2", "one factor, by maximum likelihood"),
)
FAIR = 0.70
"""α below which the mean of items is said to be rough."""


def reliability_blocks(
    context: Context, scales: Sequence[tuple[str, Sequence[Item]]]
) -> list[Block]:
    """A row for each scale of three items or more and each condition that it is asked about.

    Conditions are kept apart: what differs between them is no agreement of items.
    """
    rows: list[dict[str, object]] = []
    for name, items in scales:
        rows += _rows(context, name, items)
    if not rows:
        return []
    table = Table(
        "reliability", "Do the items of a scale go together?", COLUMNS, tuple(rows),
        ("label", "items", "n", "alpha", "omega"),
        "Over the participants, in each condition; items that count the other way round are "
        "turned. ω of one factor has no interval here.",
    )  # fmt: skip
    return [*(_sentence(table, name) for name, _ in scales if _known(table, name)), table]


def _known(table: Table, name: str) -> list[str]:
    """The rows of a scale that have an α."""
    return [
        str(r["scale"])
        for r in table.rows
        if str(r["scale"]).split("/")[0] == name and is_defined(r["alpha"])
    ]


def parts_of(items: Sequence[Item]) -> tuple[str, ...]:
    """The names of what a scale is made of: its items, or the parts of one that is a sum."""
    return items[0].parts if len(items) == 1 else tuple(i.name for i in items)


def _rows(context: Context, name: str, items: Sequence[Item]) -> list[dict[str, object]]:
    parts = parts_of(items)
    turned = {r for i in items for r in i.reverse}
    factors = [context.design.factor(f) for f in items[0].each]
    if len(parts) < LEAST_ITEMS:
        return []
    cells = ratings(context.study.questionnaire, parts, factors)
    if set(cells.factors["item"]) != set(parts):
        return []
    signs = np.array([-1.0 if p in turned else 1.0 for p in cells.factors["item"]])
    found = []
    for at in itertools.product(*(cells.factors[f.name] for f in factors)):
        own = cells.pick(**dict(zip((f.name for f in factors), at, strict=True))).values
        own = own[np.isfinite(own).all(axis=1)] * signs
        if not len(own):
            continue
        made = reliability(own)
        found.append(
            {
                "scale": "/".join((name, *at)),
                "label": ", ".join((name, *at)),
                "items": made.k,
                "n": made.n,
                "alpha": made.alpha,
                "low": made.interval[0],
                "high": made.interval[1],
                "omega": made.omega,
            }
        )
    return found


def _sentence(table: Table, name: str) -> Block:
    keys = sorted(_known(table, name), key=lambda k: number_in(table.row(k), "alpha"))
    least, most = keys[0], keys[-1]
    runs: list[str | Cited] = [table.cite(least, "alpha", "bound2")]
    if len(keys) > 1:
        runs += [" to ", table.cite(most, "alpha", "bound2"), f" over {len(keys)} conditions"]
    rough = number_in(table.row(least), "alpha") < FAIR
    words = ": below .70 items hardly measure one thing, so that their mean or sum is rough" if (
        rough) else ""  # fmt: skip
    return say(f"Items of {name}: α = {{}}{words}.", runs)
