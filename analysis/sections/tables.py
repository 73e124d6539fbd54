"""Tables that several sections make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from seethrough.analysis.cells import Cells, Missing
from seethrough.analysis.comparison import Measure
from seethrough.analysis.load.schema import TASK_CODES
from seethrough.analysis.page.blocks import Cited, Column, Prose, Table, say
from seethrough.analysis.page.numbers import bounded
from seethrough.analysis.sections.context import Context
from seethrough.analysis.stats.anova import Effect, repeated_measures
from seethrough.analysis.stats.distributions import bayes_factor_f, negligible_p
from seethrough.analysis.stats.undefined import ONE_PARTICIPANT, Number, Undefined, is_defined

EFFECTS = (
    Column("effect", "effect"),
    Column("n", "n", "int"),
    Column("df1", "df₁", "int"),
    Column("df2", "df₂", "int"),
    Column("F", "F", "fixed2"),
    Column("p", "p", "p"),
    Column("eps", "ε", "bound3", "Greenhouse–Geisser"),
    Column("p_gg", "p (ε)", "p", "corrected"),
    Column("mauchly_w", "Mauchly W", "bound3"),
    Column("mauchly_p", "Mauchly p", "p"),
    Column("ges", "η²G", "bound3", "generalised η²"),
    Column("pes", "η²p", "bound2", "90 % interval", "pes_low", "pes_high"),
    Column("pes_low", "from", "bound3", "90 % interval"),
    Column("pes_high", "to", "bound3", "90 % interval"),
    Column("bf10", "BF₁₀", "sig3", "JZS, Cauchy scale √½"),
    Column("negligible_p", "p (negligible)", "p", "of η²p ≥ .06"),
    Column("ss_effect", "SS", "sig4"),
    Column("ss_error", "SS error", "sig4"),
)
INTERACTION = "task × transparency"
"""The row of the ANOVA of times that asks whether the technique's effect differs between tasks."""
NEGLIGIBLE = 0.06
"""Partial η² below which an effect of several conditions is called negligible (Cohen: medium)."""

BAYES_NOTE = (
    "BF₁₀: a multivariate Cauchy prior (scale √½) on the effect's standardised orthonormal "
    "contrasts, participants' levels projected out; for one degree of freedom that is the JZS "
    "factor of the paired t. For more it is not that of BayesFactor's anovaBF, which gives the "
    "participants' levels a prior of their own: the two can differ by a tenth and "
    "more. It assumes sphericity: where ε is far below 1, read the corrected p."
)
EFFECTS_SHOWN = tuple("effect df1 df2 F p eps p_gg ges pes bf10".split())


SHORT = {
    "count": "count",
    "pattern": "pattern",
    "unique": "unique",
    "count_in_building": "in building",
}


def name_of(task: str) -> str:
    """`T1 count`, as the paper numbers its tasks."""
    return f"{TASK_CODES[task]} {SHORT[task]}" if task in TASK_CODES else task


def effect_row(effect: Effect) -> dict[str, Any]:
    """An effect as a row of `EFFECTS`."""
    return {
        "effect": effect.name,
        "n": effect.n,
        "df1": effect.df1,
        "df2": effect.df2,
        "F": effect.f,
        "p": effect.p,
        "eps": effect.eps,
        "p_gg": effect.p_gg,
        "mauchly_w": effect.mauchly_w,
        "mauchly_p": effect.mauchly_p,
        "ges": effect.ges,
        "pes": effect.pes,
        "pes_low": effect.pes_interval[0],
        "pes_high": effect.pes_interval[1],
        "bf10": _bayes_factor(effect),
        "negligible_p": negligible(effect.f, effect.df1, effect.df2),
        "ss_effect": effect.ss_effect,
        "ss_error": effect.ss_error,
    }


def anova_table(key: str, title: str, cells: Cells, note: str = "") -> Table:
    """The repeated-measures ANOVA of all the cells' factors, over who has every cell."""
    effects = repeated_measures(cells.whole().values, tuple(cells.factors))
    return Table(
        key,
        title,
        EFFECTS,
        tuple(effect_row(e) for e in effects.values()),
        EFFECTS_SHOWN,
        f"{note} {BAYES_NOTE}".strip(),
    )


def testable(cells: Cells) -> bool:
    """Whether an ANOVA has anything to compare: someone complete, two levels of each factor."""
    return min(cells.values.shape[1:]) > 1 and len(cells.whole().values) > 0


def effect_sentence(table: Table, effect: str, what: tuple[str, str], alpha: float) -> Prose:
    """A factorial effect in APA style, Greenhouse–Geisser's correction where df₁ > 1.

    `what` says it with an effect and without.
    """
    row = table.row(effect)
    if not is_defined(row["F"]):
        return say("{}: {}.", what[1], table.cite(effect, "F"))
    words = what[0] if row["p_gg"] < alpha else what[1]
    runs = cited_f(table, effect)
    if row["df1"] > 1:
        runs += [" (Greenhouse–Geisser, ε = ", table.cite(effect, "eps", "bound2"), ")"]
    runs += [", η²G = ", table.cite(effect, "ges")]
    if row["p_gg"] >= alpha:
        runs += ["; ", *not_found(table, effect, alpha)]
    return say("{}, {}.", words, runs)


def cited_f(table: Table, effect: str) -> list[str | Cited]:
    """`F(3, 45) = 2.10, p = .113` of an effect, its p with Greenhouse–Geisser's correction."""
    p = table.cite(effect, "p_gg")
    return [
        "F(",
        table.cite(effect, "df1"),
        ",\u00a0",
        table.cite(effect, "df2"),
        ") = ",
        table.cite(effect, "F"),
        ", p " if p.text.startswith(("<", ">")) else ", p = ",
        p,
    ]


def negligible(f: Number, df1: int, df2: int) -> Number:
    """p of partial η² being `NEGLIGIBLE` or more."""
    return negligible_p(f, df1, df2, NEGLIGIBLE) if is_defined(f) else f


def not_found(table: Table, key: str, alpha: float) -> list[str | Cited]:
    """Where an omnibus F shows nothing: `η²p below .06: p = .21, not shown either`."""
    p = table.cite(key, "negligible_p")
    shown = "shown" if is_defined(p.value) and p.value < alpha else "not shown either"
    equals = "" if p.text.startswith(("<", ">", "undefined")) else "= "
    return [f"that η²p is below {bounded(NEGLIGIBLE, 2)} is {shown} (p {equals}", p, ")"]


def _bayes_factor(effect: Effect) -> Number:
    return bayes_factor_f(effect.f, effect.df1, effect.n) if is_defined(effect.f) else effect.f


CELL_COLUMNS = (
    Column("cell", "cell"),
    Column("task", "task"),
    Column("transparency", "transparency"),
    Column("n", "n", "int"),
    Column("trials", "trials", "int"),
    Column("mean", "mean", "own"),
    Column("sd", "SD", "own"),
    Column("geometric", "geometric mean", "own"),
    Column("median", "median", "own"),
    Column("minimum", "min", "own"),
    Column("maximum", "max", "own"),
)


def cell_table(
    key: str,
    title: str,
    cells: Cells,
    shown: Sequence[str],
    note: str = "",
    kind: str = "fixed",
    logs: Cells | None = None,
) -> Table:
    """Mean and s.d. of each task × transparency cell, over those who have it.

    `kind` as in `Column`; `logs`: the same cells' mean logarithms, for the geometric mean.
    """
    rows = []
    for i, task in enumerate(cells.factors["task"]):
        for j, level in enumerate(cells.factors["transparency"]):
            has = np.isfinite(cells.values[:, i, j])
            values = cells.values[has, i, j]
            log = logs.values[has, i, j] if logs else None
            rows.append(
                {
                    "cell": f"{task}/{level}",
                    "task": name_of(task),
                    "transparency": level,
                    "digits": 2,
                    "kind": kind,
                    "n": len(values),
                    "trials": int(cells.counts[has, i, j].sum()),
                    **_spread(values),
                    "geometric": _geometric(log),
                }
            )
    return Table(key, title, CELL_COLUMNS, tuple(rows), tuple(shown), note)


def _spread(values: Any) -> Mapping[str, Any]:
    n = len(values)
    if n == 0:
        gone = Undefined("nobody has this cell")
        return dict.fromkeys(("mean", "sd", "median", "minimum", "maximum"), gone)
    return {
        "mean": float(values.mean()),
        "sd": float(np.std(values, ddof=1)) if n > 1 else Undefined(ONE_PARTICIPANT),
        "median": float(np.median(values)),
        "minimum": float(values.min()),
        "maximum": float(values.max()),
    }


def _geometric(log: Any) -> Number:
    """exp of the mean over participants of their trials' mean logarithm."""
    if log is None:
        return Undefined("only times have a geometric mean here")
    return float(np.exp(log.mean())) if len(log) else Undefined("nobody has this cell")


def of_people(table: Table, key: str, context: Context) -> list[str | Cited]:
    """` (n = 15 of 16)` where a row leaves somebody out; nothing where it has everybody."""
    everybody = context.people
    if table.row(key)["n"] == everybody:
        return []
    return [" (n = ", table.cite(key, "n"), f" of {everybody})"]


def missing_note(missing: Sequence[Missing]) -> list[Prose]:
    """Who lacks a cell of an analysis, by name, and what that leaves them out of."""
    if not missing:
        return []
    named = "; ".join(f"{m.participant} ({', '.join(m.cells)})" for m in missing[:20])
    more = f"; and {len(missing) - 20} more, see missing.csv" if len(missing) > 20 else ""
    one = len(missing) == 1
    start = "1 participant lacks" if one else f"{len(missing)} participants lack"
    left = "is" if one else "are"
    return [
        say(
            f"{start} a cell: {named}{more}. Whoever lacks one {left} left out of what needs it, "
            "and of nothing else: the tests of that task, the mean over tasks, the factorial "
            "analyses.",
            kind="note",
        )
    ]


def keep(measures: Sequence[Measure | None]) -> list[Measure]:
    """Those that exist."""
    return [m for m in measures if m is not None]
