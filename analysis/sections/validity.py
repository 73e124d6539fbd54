"""Order, learning, timing and difficulty: reported, never deciding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from analysis.comparison import compare
from analysis.figures.validity import learning_figure
from analysis.page.blocks import Block, Column, Section, Table, say
from analysis.sections.context import Context
from analysis.sections.tables import keep, name_of
from analysis.stats.paired import one_sample
from analysis.stats.undefined import Undefined, is_defined
from analysis.validity import (
    difficulty,
    focus_losses,
    learning_curve,
    learning_slopes,
    order_tests,
    share_missed,
    timeouts,
)

ORDER = (
    Column("effect", "effect"),
    Column("df1", "df₁", "int"),
    Column("df2", "df₂", "int"),
    Column("F", "F", "fixed2"),
    Column("p", "p", "p"),
)
FAULTS_SHOWN = tuple("label n mean_standard mean_dynamic difference F p tost_p".split())


def validity_section(context: Context) -> Section:
    """Everything that could make the comparison unfair."""
    blocks: list[Block] = [*_order(context), *_learning(context), *_faults(context)]
    return Section("validity", "Was the comparison fair?", tuple(blocks))


def _order(context: Context) -> list[Block]:
    tests = order_tests(context.trials)
    rows = tuple({"effect": t.name, "df1": t.df1, "df2": t.df2, "F": t.f, "p": t.p} for t in tests)
    table = Table(
        "order",
        "Order effects on log time",
        ORDER,
        rows,
        note="Period: position of the condition in the session. Carry-over: whether the condition "
        "before had dynamic transparency. Sequence: between the orders of conditions. Reported, "
        "and never used to choose an analysis: a test that chooses one biases it.",
    )
    found = [t.name for t in tests if is_defined(t.p) and t.p < context.plan.alpha]
    said = (
        f"Times depend on {', '.join(found)}; the design balances what it balances, and the "
        "analysis stays as planned."
        if found
        else "No effect of period, carry-over or sequence on log times was found."
    )
    return [say(said), table]


def _learning(context: Context) -> list[Block]:
    slopes = learning_slopes(context.trials)
    if not len(slopes):
        return [say("Learning: undefined, every task set has a single trial.", kind="note")]
    result = one_sample(slopes)
    low, high = result.interval
    row = {
        "what": "per trial",
        "n": result.n,
        "ratio": float(np.exp(result.difference)),
        "low": float(np.exp(low)) if is_defined(low) else low,
        "high": float(np.exp(high)) if is_defined(high) else high,
        "t": result.t,
        "p": result.p,
    }
    columns = (
        Column("what", "factor on time"),
        Column("n", "n", "int"),
        Column("ratio", "ratio", "fixed3", "95 % interval", "low", "high"),
        Column("low", "from", "fixed3", "95 % interval"),
        Column("high", "to", "fixed3", "95 % interval"),
        Column("t", "t", "fixed2"),
        Column("p", "p", "p"),
    )
    shown = ("what", "n", "ratio", "t", "p")
    table = Table("learning", "Learning within a task set", columns, (row,), shown)
    p = table.cite("per trial", "p")
    words = "p " if p.text.startswith(("<", "undefined")) else "p = "
    sentence = say(
        "From one trial of a task set to the next, times change by a factor of {}, 95 % CI "
        f"[{{}}, {{}}], {words}{{}}.",
        table.cite("per trial", "ratio"),
        table.cite("per trial", "low"),
        table.cite("per trial", "high"),
        p,
    )
    curve = learning_curve(context.trials)
    return [sentence, learning_figure("learning", curve), table, _curve_table(curve)]


def _curve_table(curve: pd.DataFrame) -> Table:
    rows = tuple(
        {
            "cell": f"{r.transparency}/{int(r.trial_in_set)}",
            "transparency": str(r.transparency),
            "position": int(r.trial_in_set),
            "time": float(r.time),
            "n": int(r.people),
        }
        for r in curve.itertuples()
    )
    return Table(
        "learning_curve",
        "Time by position in the task set",
        (
            Column("cell", "cell"),
            Column("transparency", "transparency"),
            Column("position", "trial", "int"),
            Column("time", "geometric mean (s)", "sig4"),
            Column("n", "n", "int"),
        ),
        rows,
        ("transparency", "position", "time", "n"),
    )


def _faults(context: Context) -> list[Block]:
    trials = context.trials
    faults = keep([share_missed(trials), focus_losses(trials), timeouts(trials)])
    blocks: list[Block] = []
    if faults:
        table = replace(
            compare(faults, context.plan.margin),
            key="faults",
            title="Missed frames, lost focus and time-outs by condition",
            shown=FAULTS_SHOWN,
        )
        blocks.append(table)
        worse = [
            m.label
            for m in faults
            if not isinstance(p := table.row(m.key)["p"], Undefined) and p < context.plan.alpha
        ]
        blocks.append(
            say(
                f"The conditions differ in {' and '.join(worse)}: this could explain part of a "
                "difference in time."
                if worse
                else "The conditions do not differ demonstrably in missed frames, lost focus or "
                "time-outs."
            )
        )
    harder = difficulty(trials)
    if harder:
        named = [replace(m, label=name_of(m.label)) for m in harder]
        table = replace(
            compare(named, context.plan.margin),
            key="difficulty",
            title="Difficulty: targets in the scenes, by task and condition",
            shown=FAULTS_SHOWN,
        )
        blocks.append(table)
    return blocks
