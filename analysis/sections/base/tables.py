"""Tables that several sections make."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.cells import Cells, Missing
from seethrough.analysis.comparison import Pair, sd_of
from seethrough.analysis.design import Design, Factor
from seethrough.analysis.measures import groups_of
from seethrough.analysis.page.blocks import Cited, Column, Prose, Table, say
from seethrough.analysis.page.numbers import bounded, equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.anova import Effect
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import bayes_factor_f, negligible_p
from seethrough.analysis.stats.paired import mean_interval
from seethrough.analysis.stats.undefined import (
    Number,
    Undefined,
    is_defined,
    number_in,
)

EFFECTS = (
    Column("effect", "effect"),
    Column("n", "n", "int"),
    Column("df1", "df₁", "int"),
    Column("df2", "df₂", "int"),
    Column("F", "F", "fixed2"),
    Column("p", "p", "p"),
    Column("eps", "ε", "bound3", "Greenhouse–Geisser"),
    Column("p_gg", "p (ε)", "p", "corrected"),
    Column("eps_hf", "ε", "bound3", "Huynh–Feldt"),
    Column("p_hf", "p (HF)", "p", "by Huynh and Feldt's ε"),
    Column("p_lower", "p (bound)", "p", "by the least that ε can be"),
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
NEGLIGIBLE = 0.06
"""Partial η² below which an effect of several conditions is called negligible (Cohen: medium)."""

BAYES_NOTE = (
    "BF₁₀: a multivariate Cauchy prior (scale √½) on the effect's standardised orthonormal "
    "contrasts, participants' levels projected out; for one degree of freedom that is the JZS "
    "factor of the paired t. For more it is not that of BayesFactor's anovaBF, which gives the "
    "participants' levels a prior of their own: the two can differ by a tenth and "
    "more. It assumes sphericity: where ε is far below 1, read the corrected p."
)
EFFECTS_SHOWN = tuple("effect df1 df2 F p eps p_gg eps_hf p_hf ges pes bf10".split())


def effect_row(effect: Effect) -> dict[str, object]:
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
        "eps_hf": effect.eps_hf,
        "p_hf": effect.p_hf,
        "p_lower": effect.p_lower,
        "p_decisive": effect.decisive,
        "few": effect.few,
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


def effect_sentence(table: Table, effect: str, what: tuple[str, str], alpha: float) -> Prose:
    """A factorial effect in APA style, Greenhouse–Geisser's correction where df₁ > 1.

    `what` says it with an effect and without.
    """
    row = table.row(effect)
    if not is_defined(row["F"]):
        return say("{}: {}.", what[1], table.cite(effect, "F"))
    words = what[0] if number_in(row, "p_decisive") < alpha else what[1]
    runs = cited_f(table, effect)
    if number_in(row, "df1") > 1 and not row["few"]:
        runs += [" (Greenhouse–Geisser, ε = ", table.cite(effect, "eps", "bound2"), ")"]
    runs += [", η²G = ", table.cite(effect, "ges")]
    if number_in(row, "p_decisive") >= alpha:
        runs += ["; ", *not_found(table, effect, alpha)]
    return say("{}, {}.", words, runs)


def cited_f(table: Table, effect: str) -> list[str | Cited]:
    """`F(3, 45) = 2.10, p = .113` of an effect, its p with Greenhouse–Geisser's correction."""
    few = table.row(effect)["few"]
    p = table.cite(effect, "p_lower" if few else "p_gg")
    return [
        "F(",
        table.cite(effect, "df1"),
        ",\u00a0",
        table.cite(effect, "df2"),
        ") = ",
        table.cite(effect, "F"),
        f", p {equals(p.text)}",
        p,
        *([" by the lower bound, for participants are too few to estimate ε"] if few else []),
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
    if effect.error_df != effect.n - 1:
        return Undefined("only without groups")
    return bayes_factor_f(effect.f, effect.df1, effect.n) if is_defined(effect.f) else effect.f


def cell_columns(factors: Sequence[str]) -> tuple[Column, ...]:
    """The columns of a table of cells of these factors."""
    return (
        Column("cell", "cell"),
        *(Column(name, name) for name in factors),
        Column("n", "n", "int"),
        Column("trials", "trials", "int"),
        Column("mean", "mean", "own", "95 % interval over participants", "low", "high"),
        Column("sd", "SD", "own"),
        Column("low", "from", "own", "95 % interval of the mean"),
        Column("high", "to", "own", "95 % interval of the mean"),
        Column("geometric", "geometric mean", "own"),
        Column("median", "median", "own"),
        Column("minimum", "min", "own"),
        Column("maximum", "max", "own"),
    )


def cell_table(
    key: str,
    title: str,
    cells: Cells,
    context: Context,
    note: str = "",
    kind: str = "fixed",
    logs: Cells | None = None,
    digits: int = 2,
) -> Table:
    """Mean and s.d. of each cell, group by group, over those who have it.

    `kind` as in `Column`; `logs`: the same cells' mean logarithms, for the geometric mean.
    """
    groups = groups_in(context, cells.participants)
    names = [f.name for f in context.design.groups] if groups else []
    rows = []
    for where, members in groups or [({}, np.ones(len(cells.participants), bool))]:
        for index in np.ndindex(*cells.values.shape[1:]):
            at = dict(zip(cells.factors, (known[i] for known, i in zip(
                cells.factors.values(), index, strict=True)), strict=True))  # fmt: skip
            if context.design.left_out({**where, **at}) or not has_task(context, where, at):
                continue
            values = cells.values[(slice(None), *index)]
            has = np.isfinite(values) & members
            log = logs.values[(slice(None), *index)][has] if logs else None
            said = {k: context.design.task_said(v) if k == "task" else v for k, v in at.items()}
            rows.append(
                {
                    "cell": "/".join((*where.values(), *at.values())),
                    **where,
                    **said,
                    "digits": digits,
                    "kind": kind,
                    "n": int(has.sum()),
                    "trials": int(cells.counts[(slice(None), *index)][has].sum()),
                    **_spread(values[has]),
                    "geometric": _geometric(log),
                }
            )
    factors = [*names, *cells.factors]
    shown = [*factors, "n", "trials", "mean", "sd", *(["geometric"] if logs else []), "median"]
    whole_note = " ".join(
        words for words in (note, *_rough(rows, kind == "bound", logs is not None)) if words
    )
    return Table(key, title, cell_columns(factors), tuple(rows), tuple(shown), whole_note)


SHARES = (
    "The intervals are t intervals: of a share of .95 in three trials they hold the truth in .71 "
    "of studies of 8 people, and in .91 of 16, for .95."
)
SKEWED = (
    "The intervals are t intervals: of log-normal times (s.d. of logarithms .5) they hold the true "
    "mean in .92 of studies of 8 people, and in .93 of 16, for .95."
)


def _rough(rows: Sequence[Mapping[str, object]], share: bool, times: bool) -> Iterator[str]:
    """How far the intervals of means can be trusted, and where one leaves what values can be."""
    yield SHARES if share else SKEWED if times else ""
    known = [r for r in rows if is_defined(r["low"]) and is_defined(r["minimum"])]
    under = [r for r in known if number_in(r, "low") < 0 <= number_in(r, "minimum")]
    over = [r for r in known if share and number_in(r, "high") > 1]
    if ends := [*(["below 0"] if under else []), *(["above 1"] if over else [])]:
        many = len({str(r["cell"]) for r in (*under, *over)})
        yield (
            f"{f'{many} intervals reach' if many > 1 else 'An interval reaches'} "
            f"{' or '.join(ends)}, where no value is: too few people, or too uneven, for one."
        )


def has_task(context: Context, group: Mapping[str, str], at: Mapping[str, str]) -> bool:
    """Whether a group was given a cell's task. Its people have rows then, be they left out; nobody
    says of a group that has no people yet."""
    trials = context.study.trials
    for name, level in group.items():
        trials = trials[trials[name].astype(str) == level]
    return (
        trials.empty or "task" not in at or bool((trials["task"].astype(str) == at["task"]).any())
    )


def design_at(context: Context, cells: Cells) -> Design:
    """The design as those have it who have any of these cells: a factor between people of which
    they have a single level drops out (a task that only one group does)."""
    design = context.design
    there = np.any(np.isfinite(cells.values.reshape(len(cells.values), -1)), axis=1)
    names = [p for p, t in zip(cells.participants, there, strict=True) if t]
    left: list[Factor] = []
    for factor in design.factors:
        if factor.within:
            left.append(factor)
            continue
        own = set(groups_of(context.study.trials, factor, names))
        levels = tuple(level for level in factor.levels if level in own)
        if len(levels) > 1:
            base = factor.baseline if factor.baseline in levels else levels[0]
            left.append(replace(factor, levels=levels, baseline=base, numbers=None))
    return replace(design, factors=tuple(left))


def groups_in(
    context: Context, names: Sequence[str]
) -> list[tuple[dict[str, str], NDArray[np.bool_]]]:
    """The levels of the factors between people, and who of `names` has them; none without any."""
    factors = context.design.groups
    if not factors:
        return []
    own = [groups_of(context.study.trials, f, names) for f in factors]
    found = []
    for cell in context.design.cells(factors):
        members = np.logical_and.reduce(
            [np.array([x == cell[f.name] for x in got], dtype=bool)
             for f, got in zip(factors, own, strict=True)]
        )  # fmt: skip
        found.append((cell, members))
    return found


def _spread(values: Array) -> Mapping[str, object]:
    n = len(values)
    if n == 0:
        gone = Undefined("nobody has this cell")
        return dict.fromkeys(("mean", "sd", "low", "high", "median", "minimum", "maximum"), gone)
    low, high = mean_interval(values)
    return {
        "low": low,
        "high": high,
        "mean": float(values.mean()),
        "sd": sd_of(values),
        "median": float(np.median(values)),
        "minimum": float(values.min()),
        "maximum": float(values.max()),
    }


def _geometric(log: Array | None) -> Number:
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


def keep(measures: Sequence[Pair | None]) -> list[Pair]:
    """Those that exist."""
    return [m for m in measures if m is not None]
