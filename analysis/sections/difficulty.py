"""Difficulty balance: the scenes of both conditions by the certificate's measures."""

from __future__ import annotations

from collections.abc import Sequence

from seethrough.analysis.comparison import Pair, compare, headed
from seethrough.analysis.design import Design
from seethrough.analysis.load.matching import (
    ONLY_BETWEEN,
    QUANTITIES,
    Balance,
    balance,
    with_certificate,
)
from seethrough.analysis.page.blocks import Block, Cited, Column, Prose, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.undefined import Undefined, is_defined

LARGE = 0.25
"""Standardised difference from which covariates count as unbalanced (Stuart 2010)."""

COLUMNS = (
    Column("measure", "measure"),
    Column("task", "task"),
    Column("quantity", "quantity"),
    Column("contrast", "levels"),
    Column("n", "n", "int"),
    Column("mean_baseline", "M baseline", "sig3"),
    Column("mean_level", "M level", "sig3"),
    Column("difference", "baseline − level", "sig3", "95 % interval", "low", "high"),
    Column("low", "from", "sig3", "95 % interval"),
    Column("high", "to", "sig3", "95 % interval"),
    Column("smd", "in SD of scenes", "fixed2", "level − baseline"),
    Column("p", "p", "p"),
)
SHOWN = tuple("task quantity contrast n mean_baseline mean_level difference smd p".split())


def difficulty_blocks(context: Context) -> list[Block]:
    """A sentence on the largest difference, and the table of all."""
    certificate = context.study.certificate
    found = balance(with_certificate(context.trials, certificate), context.design)
    source = (
        "Measured from fixed views without the technique (the study's difficulty certificate): "
        "visible fraction of the targets in view; targets hidden in every view; distractors that "
        "hide part of a target; objects in view; path past every target."
        if certificate is not None
        else "The data hold no difficulty certificate: only what the trials recorded is compared; "
        "`seethrough check STUDY --certificate DATA/certificate.csv` adds visible fraction, "
        "occluders, clutter and path."
    )
    if not found:
        return [say(f"Difficulty: nothing is known of the scenes. {source}", kind="note")]
    table = _table(context, found, source)
    return [_sentence(table, found, context.design), table]


def _table(context: Context, found: Sequence[Balance], note: str) -> Table:
    pairs: list[Pair] = [b.pair for b in found]
    tests = compare(pairs)
    rows = []
    for b in found:
        own = tests.row(b.pair.key)
        rows.append(
            {
                **{c.name: own[c.name] for c in COLUMNS if c.name in own},
                "task": context.design.task_said(b.task),
                "quantity": QUANTITIES[b.quantity],
                "contrast": f"{b.pair.names[0]} → {b.pair.names[1]}",
                "low": own["difference_low"],
                "high": own["difference_high"],
                "smd": b.smd,
            }
        )
    title = "Difficulty of the scenes, by task and condition"
    return Table("difficulty", title, headed(COLUMNS, pairs), tuple(rows), SHOWN, note)


def _named(found: Sequence[Balance], design: Design) -> str:
    said = (f"{design.task_said(b.task)}, {QUANTITIES[b.quantity]}" for b in found)
    return "; ".join(dict.fromkeys(said))


def _sentence(table: Table, found: Sequence[Balance], design: Design) -> Prose:
    """The largest standardised difference by name, and which pass the usual limit."""
    known = [(abs(b.smd), b) for b in found if is_defined(b.smd)]
    apart = [b for b in found if b.smd == Undefined(ONLY_BETWEEN)]
    if apart and not known:
        return say("Difficulty: the scenes of the two levels differ in {}.", _named(apart, design))
    if not known:
        return say("Difficulty: within each task all scenes are alike in what is known of them.")
    _, worst = max(known, key=lambda pair: pair[0])
    runs: list[str | Cited] = [
        f"Difficulty: of {len(known)} comparisons of the scenes the largest difference is ",
        table.cite(worst.pair.key, "smd", "fixed3"),
        f" SD of scenes ({design.task_said(worst.task)}, {QUANTITIES[worst.quantity]})",
    ]
    over = [*(b for smd, b in known if smd >= LARGE), *apart]
    if over:
        named = _named(over, design)
        runs.append(f". Apart by {LARGE} SD or more, so that times may differ for it: {named}.")
    else:
        runs.append(f"; none reaches {LARGE} SD, the usual limit of balance.")
    return say("{}", runs)
