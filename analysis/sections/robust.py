"""The contrasts once more: without normality, and without the people whose scores lie far off."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair
from seethrough.analysis.measures import cells_of
from seethrough.analysis.page.blocks import Block, Column, Prose, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.tests.measured import pairs_of
from seethrough.analysis.stats.flips import FAR, outliers, sign_flip
from seethrough.analysis.stats.paired import one_sample
from seethrough.analysis.stats.undefined import Number, Undefined, is_defined

ROBUST = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("p", "p (t)", "p"),
    Column("p_flip", "p (sign flips)", "p", "no normality assumed"),
    Column("method", "by"),
    Column("outliers", "outliers", "int", f"beyond {FAR:g} robust SD"),
    Column("p_without", "p (t)", "p", "without them"),
)
MOST = 40
"""Rows that the table has at most: the scales that decide, measure by measure."""


def robust_blocks(context: Context) -> list[Block]:
    """A table of every within contrast on the scale that decides; a sentence where it matters."""
    pairs: list[tuple[Pair, bool]] = []
    for measure in (m for m in context.design.measures() if not m.ranked):
        cells: Cells = cells_of(context.trials, context.design, measure)
        if not (cells.counts > 0).any():
            continue
        logs = cells_of(context.trials, context.design, measure, log=True) if measure.log else None
        pairs += [(p, measure.log) for p in pairs_of(context, measure, cells, logs)]
    rows = tuple(_row(context, pair, log, 400 + i) for i, (pair, log) in enumerate(pairs[:MOST]))
    if not rows:
        return []
    note = (
        "On the scale that decides (logarithms where a measure has them), uncorrected. Sign flips: "
        "each participant's difference gets either sign; outliers only show what rests on them, "
        "and nobody is left out elsewhere for being one."
    )
    shown = tuple("label n p p_flip method outliers p_without".split())
    table = Table("robust", "Contrasts without normality, and without outliers", ROBUST, rows,
                  shown, note)  # fmt: skip
    return [_sentence(rows, context.plan.alpha), table]


def _row(context: Context, pair: Pair, log: bool, purpose: int) -> dict[str, object]:
    first, second = pair.logs if log and pair.logs is not None else (pair.first, pair.second)
    scores = first - second
    scale = float(np.max(np.abs([first, second])))  # what rounds the scores
    far = outliers(scores, scale)
    flipped, method = sign_flip(scores, context.rng(purpose), scale)
    kept = scores[~far]
    gone = Undefined("everybody is an outlier")
    without: Number = one_sample(kept, scale).p if len(kept) else gone
    return {
        "measure": pair.key,
        "label": f"{_name(context, pair)}, {pair.label}",
        "n": len(scores),
        "p": one_sample(scores, scale).p,
        "p_flip": flipped,
        "method": method,
        "outliers": int(far.sum()),
        "p_without": without,
    }


def _name(context: Context, pair: Pair) -> str:
    return next((m.said for m in context.design.measures() if m.name == pair.of), pair.of)


def _sentence(rows: tuple[Mapping[str, object], ...], alpha: float) -> Prose:
    """Which contrasts fall on another side of α."""
    other = [str(r["label"]) for r in rows if _differs(r, alpha)]
    if not other:
        return say("No contrast falls on another side of α without normality or without outliers.")
    return say(f"On another side of α without normality or without outliers: {'; '.join(other)}.",
               kind="warning")  # fmt: skip


def _differs(row: Mapping[str, object], alpha: float) -> bool:
    """Whether a contrast falls on another side of α in one of the other ways."""
    p, others = row["p"], (row["p_flip"], row["p_without"])
    return is_defined(p) and any(is_defined(o) and (o < alpha) != (p < alpha) for o in others)
