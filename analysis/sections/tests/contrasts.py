"""Contrasts with their own error: between groups, within people across groups, simple effects and
trends. Where nobody is in a group, the plain contrasts stand in the pairs' table instead.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Design, Measured
from seethrough.analysis.equivalence import NO_MARGIN
from seethrough.analysis.measures import TASK, groups_of, over_tasks
from seethrough.analysis.page.blocks import Block, Cited, Column, Prose, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import design_at
from seethrough.analysis.sections.tests.asked_contrasts import (
    BETWEEN,
    CONTRAST,
    SIMPLE,
    TRENDS,
    Asked,
    asked_of,
)
from seethrough.analysis.stats.contrasts import FEW, Estimate, estimate, within_margin
from seethrough.analysis.stats.multiplicity import add_holm
from seethrough.analysis.stats.undefined import Number, Undefined, is_defined, number_in
from seethrough.analysis.words import capitalised

COLUMNS = (
    Column("contrast", "contrast"),
    Column("label", "contrast"),
    Column("kind", "kind"),
    Column("n", "n", "int"),
    Column("least", "smallest group", "int"),
    Column(
        "estimate",
        "estimate",
        "sig3",
        "baseline − level, of a trend its slope; 95 % interval",
        "low",
        "high",
    ),
    Column("low", "from", "sig3", "95 % interval"),
    Column("high", "to", "sig3", "95 % interval"),
    Column("error", "s.e.", "sig3"),
    Column("t", "t", "fixed2"),
    Column("df", "df", "fixed1"),
    Column("p", "p", "p"),
    Column("p_holm", "p (Holm)", "p", "within its kind and factor"),
    Column(
        "ratio", "ratio", "fixed2", "level / baseline, 95 % interval", "ratio_low", "ratio_high"
    ),
    Column("ratio_low", "ratio from", "fixed2", "95 % interval"),
    Column("ratio_high", "ratio to", "fixed2", "95 % interval"),
    Column("tost_margin", "margin", "sig3", "declared before the data"),
    Column("tost_p", "p (TOST)", "p", "that the two are within the margin"),
    Column("noninferior_p", "p (no worse)", "p", "that the level is not worse by the margin"),
)
WELCH = (
    "Each contrast has an error of its own; groups are compared without assuming equal spreads "
    "(Welch), and weigh the same whatever their size."
)
OBSERVED = (
    "{} was brought along, not assigned: its groups may differ in anything else too, and no "
    "difference between them says why."
)
Row = dict[str, object]
"""A row of the table: what a column has, numbers or why there are none."""


def contrast_blocks(
    context: Context, measure: Measured, cells: Cells, anova: Mapping[str, Table], log: bool
) -> tuple[list[Block], dict[str, Table]]:
    """The table of contrasts with its sentences; nothing where there is none to make.

    `cells` are logarithms where `log` says so; `anova`: which interactions were found.
    """
    rows: list[Row] = []
    tasks = cells.factors[TASK]
    places = [(task, cells.pick(task=task)) for task in tasks]
    if len(tasks) > 1 and measure.pool:
        places.insert(0, ("overall", over_tasks(cells)))
    families: list[str] = []
    for where, own in places:
        found = _anova_of(anova, where)
        said = where if where == "overall" else context.design.task_said(where)
        for asked in asked_of(context, own, where, found):
            label = f"{said}{asked.label.removeprefix(where)}"
            made = row_of(context, own, replace(asked, label=label), measure, log)
            if made is not None:
                rows.append(made)
                families.append(f"{asked.family}{' overall' if where == 'overall' else ''}")
    if not rows:
        return [], {}
    add_holm(rows, families)
    shown = ["label", "kind", "n", "estimate", "t", "df", "p", "p_holm"]
    shown += ["ratio"] if log else []
    shown += ["tost_p"] if any(isinstance(r["tost_p"], float) for r in rows) else []
    name = f"contrasts_{'log_' if log else ''}{measure.name}"
    title = f"{measure.title}: contrasts with their own error"
    table = Table(name, title + (", logarithms" if log else ""), COLUMNS, tuple(rows),
                  tuple(shown), _note(context.design, rows))  # fmt: skip
    return [*_sentences(context, table, measure, log), table], {"contrasts": table}


def _anova_of(anova: Mapping[str, Table], where: str) -> Table | None:
    """The table that says which effects a place has."""
    return anova.get(f"anova_in_{where}") or anova.get("anova") or anova.get(f"anova_{TASK}")


def _note(design: Design, rows: Sequence[Mapping[str, object]]) -> str:
    notes = [WELCH] if design.groups else []
    if any(r["kind"] in TRENDS.values() for r in rows):
        notes.append(
            "Trends take the levels' own numbers, not equal steps; a linear one is a slope, its "
            "ratio that of the last level to the first."
        )
    if any(r["kind"] == SIMPLE for r in rows):
        notes.append("Simple effects: only where the interaction was found.")
    small = sorted({number_in(r, "least") for r in rows if number_in(r, "least") < FEW})
    if design.groups and small:
        notes.append(f"Groups of fewer than {FEW} people: their p are rough (.05 to .10 for .05).")
    notes += [OBSERVED.format(capitalised(f.name)) for f in design.groups
              if f.kind == "measured"]  # fmt: skip
    return " ".join(notes)


def row_of(
    context: Context, cells: Cells, asked: Asked, measure: Measured, log: bool
) -> Row | None:
    """An asked contrast's row, of who has what it needs."""
    factors = design_at(context, cells).groups
    has = np.isfinite(asked.scores)
    if factors:
        own = zip(*(groups_of(context.study.trials, f, cells.participants) for f in factors),
                  strict=True)  # fmt: skip
        keys = np.array(["\x1f".join(levels) for levels in own])
        groups = [asked.scores[has & (keys == key)] for key in asked.weights]
    else:
        groups = [asked.scores[has]]
    if any(len(g) == 0 for g in groups):
        return None
    found = estimate(groups, list(asked.weights.values()), asked.scale)
    return {
        "contrast": asked.key,
        "label": asked.label,
        "kind": asked.kind,
        "n": found.n,
        "least": found.least,
        "estimate": found.estimate,
        "low": found.interval[0],
        "high": found.interval[1],
        "error": found.error,
        "t": found.t,
        "df": found.df,
        "p": found.p,
        **_ratios(found, log, asked.span),
        **_margin(found, measure, asked.kind),
    }


def _ratios(found: Estimate, log: bool, span: float | None) -> dict[str, Number | None]:
    """level / baseline from logarithms; of a slope the last level / the first; of a curve none."""
    if not log or span == 0:
        return dict.fromkeys(("ratio", "ratio_low", "ratio_high"))
    times = -1.0 if span is None else span

    def ratio(value: Number) -> Number:
        return float(np.exp(times * value)) if is_defined(value) else value

    low, high = found.interval[::-1] if times < 0 else found.interval
    return {"ratio": ratio(found.estimate), "ratio_low": ratio(low), "ratio_high": ratio(high)}


def _margin(found: Estimate, measure: Measured, kind: str) -> Row:
    """The tests against the declared margin; trends and differences of differences have none."""
    if kind not in (CONTRAST, BETWEEN, SIMPLE):
        return dict.fromkeys(("tost_margin", "tost_p", "noninferior_p"))
    if measure.margin is None:
        gone = Undefined(NO_MARGIN)
        return {"tost_margin": gone, "tost_p": gone, "noninferior_p": gone}
    if measure.ratio and not measure.log:
        gone = Undefined("a ratio of groups is tested of logarithms only")
        return {"tost_margin": measure.margin, "tost_p": gone, "noninferior_p": gone}
    margin = float(np.log(measure.margin)) if measure.log else measure.margin
    above, below, both = within_margin(found, margin)
    worse = below if measure.direction == "more" else above
    return {"tost_margin": measure.margin, "tost_p": both, "noninferior_p": worse}


def _sentences(context: Context, table: Table, measure: Measured, log: bool) -> list[Prose]:
    """What was found, each with its interval; what was not in one line."""
    alpha = context.plan.alpha
    shown = [r for r in table.rows if is_defined(r["p_holm"]) and r["p_holm"] < alpha]
    said = [_sentence(table, r, measure, log) for r in shown[:MOST]]
    if len(shown) > MOST:
        said.append(say(f"{len(shown) - MOST} more contrasts differ: see the table."))
    none = [str(r["label"]) for r in table.rows if r not in shown]
    if len(none) == len(table.rows) > MOST // 2:
        said.append(say(f"{measure.title}: none of {len(none)} "
                        "contrasts with their own error shows a difference, which is no evidence "
                        "of equality."))  # fmt: skip
    elif none:
        more = f" and {len(none) - MOST} more" if len(none) > MOST else ""
        said.append(say(f"No difference shown: {'; '.join(none[:MOST])}{more}. That is no evidence "
                        "of equality."))  # fmt: skip
    return said


MOST = 8
"""Contrasts that sentences tell of; the table has all."""


def _sentence(table: Table, row: Mapping[str, object], measure: Measured, log: bool) -> Prose:
    key = str(row["contrast"])
    p = table.cite(key, "p_holm")
    ratio = log and row["ratio"] is not None
    what = "ratio" if ratio else "estimate"
    ends = ("ratio_low", "ratio_high") if ratio else ("low", "high")
    label, kind = str(row["label"]), str(row["kind"])
    named = label if label.endswith(kind) else f"{label} ({kind})"
    words: list[str | Cited] = [f"{named}: {what} ", table.cite(key, what)]
    if ratio and kind in TRENDS.values():
        words.append(" from the first level to the last")
    if measure.unit and not log:
        words.append(f" {measure.unit}")
    words += [", 95 % CI [", table.cite(key, ends[0]), ", ", table.cite(key, ends[1]), "], t(",
              table.cite(key, "df"), ") = ", table.cite(key, "t"), ", Holm-corrected p ",
              equals(p.text), p, "."]  # fmt: skip
    text = words[0]
    assert isinstance(text, str)
    words[0] = capitalised(text)
    return say("{}", words)
