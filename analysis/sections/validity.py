"""Order, learning, timing and difficulty: reported, never deciding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from seethrough.analysis.comparison import Pair, apa_f, compare
from seethrough.analysis.design import Factor
from seethrough.analysis.equivalence import no_difference
from seethrough.analysis.figures.validity import learning_figure
from seethrough.analysis.load.plan import Plan
from seethrough.analysis.page.blocks import Block, Cited, Column, Prose, Section, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import negligible, not_found
from seethrough.analysis.sections.difficulty import difficulty_blocks
from seethrough.analysis.stats.paired import one_sample
from seethrough.analysis.stats.ties import difference_signs
from seethrough.analysis.stats.undefined import is_defined
from seethrough.analysis.validity import (
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
    Column("negligible_p", "p (negligible)", "p", "of η²p ≥ .06"),
)
NO_DISPLAY = (
    "Missed frames are not compared: a simulated participant waits for no display, and its clock "
    "says nothing of one."
)
FAULTS_SHOWN = tuple("label n mean_baseline mean_level difference F p".split())


def validity_section(context: Context) -> Section:
    """Everything that could make the comparison unfair."""
    blocks: list[Block] = [
        *_order(context),
        *_learning(context),
        *_faults(context),
        *difficulty_blocks(context),
    ]
    return Section("validity", "Was the comparison fair?", tuple(blocks))


def _order(context: Context) -> list[Block]:
    main = context.design.main
    if main is None or not context.design.measures():
        return [say("Order effects: undefined, nobody met two conditions.", kind="note")]
    tests = order_tests(context.trials, context.design)
    rows = tuple(
        {
            "effect": t.name,
            "df1": t.df1,
            "df2": t.df2,
            "F": t.f,
            "p": t.p,
            "negligible_p": negligible(t.f, t.df1, t.df2),
        }
        for t in tests
    )
    table = Table(
        "order",
        "Order effects on log time",
        ORDER,
        rows,
        note="Period: position of the condition in the session. Carry-over: "
        f"{_carried(main)}. Sequence: between the orders of conditions. Reported, "
        "and never used to choose an analysis: a test that chooses one biases it. All take the "
        "level's effect to be the same for everybody; where it is not, carry-over is found in "
        ".07 of studies without any, for .05.",
    )
    found = [t.name for t in tests if is_defined(t.p) and t.p < context.plan.alpha]
    none = [t.name for t in tests if is_defined(t.p) and t.p >= context.plan.alpha]
    blocks: list[Block] = []
    if found:
        runs: list[str | Cited] = []
        for name in found:
            runs += [" and " if runs else "", f"{name}, ", *_order_f(table, name)]
        blocks.append(
            say(
                "Times depend on {}; the analysis stays as planned, and relies on the design to "
                "put every condition equally often in every position.",
                runs,
            )
        )
    if none:
        runs = []
        for name in none:
            runs += ["; " if runs else "", f"{name}: ", *not_found(table, name, context.plan.alpha)]
        blocks.append(say(f"No effect of {_or(none)} on log times was found; {{}}.", runs))
    gone = [t.name for t in tests if not is_defined(t.p)]
    if gone:
        blocks.append(say(f"Not testable here: {', '.join(gone)} (the table says why)."))
    return [*blocks, table]


def _carried(main: Factor) -> str:
    """What carry-over is of."""
    others = [level for level in main.levels if level != main.baseline]
    if len(others) == 1:
        return f"whether the condition before had {main.label(others[0])}"
    return f"which {main.name} the condition before had"


def _order_f(table: Table, name: str) -> list[str | Cited]:
    p = table.cite(name, "p")
    df1, df2, f = (table.cite(name, column) for column in ("df1", "df2", "F"))
    return ["F(", df1, ",\u00a0", df2, ") = ", f, f", p {equals(p.text)}", p]


def _or(names: list[str]) -> str:
    return " or ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else names[0]


def _learning(context: Context) -> list[Block]:
    slopes = learning_slopes(context.trials)
    if not len(slopes):
        return [say("Learning: undefined, every task set has a single trial.", kind="note")]
    # a slope is made of logarithms: where all of a set's times are alike it is their rounding
    result = one_sample(slopes, float(np.max(np.abs(np.log(context.trials["time"])))))
    low, high = result.interval
    row = {
        "what": "per trial",
        "n": result.n,
        "ratio": float(np.exp(result.difference)),
        "low": float(np.exp(low)) if is_defined(low) else low,
        "high": float(np.exp(high)) if is_defined(high) else high,
        "df": result.n - 1,
        "t": result.t,
        "p": result.p,
    }
    columns = (
        Column("what", "factor on time"),
        Column("n", "n", "int"),
        Column("ratio", "ratio", "fixed3", "95 % interval", "low", "high"),
        Column("low", "from", "fixed3", "95 % interval"),
        Column("high", "to", "fixed3", "95 % interval"),
        Column("df", "df", "int"),
        Column("t", "t", "fixed2"),
        Column("p", "p", "p"),
    )
    shown = ("what", "n", "ratio", "t", "p")
    table = Table("learning", "Learning within a task set", columns, (row,), shown)
    factor = context.design.main or next(iter(context.design.factors), None)
    if factor is None:
        return [_slope(table), table]
    curve = learning_curve(context.trials, factor)
    figure = learning_figure("learning", curve, factor.levels)
    return [_slope(table), figure, table, _curve_table(curve, factor.name)]


def _slope(table: Table) -> Prose:
    """The change from trial to trial, with its test where there is one."""
    key = "per trial"
    p, start = table.cite(key, "p"), "From one trial of a task set to the next, times change by "
    if not is_defined(p.value):
        return say(f"{start}a factor of {{}}; no test: {{}}.", table.cite(key, "ratio"), p)
    cited = [table.cite(key, name) for name in ("ratio", "low", "high", "df", "t")]
    return say(
        f"{start}a factor of {{}}, 95 % CI [{{}}, {{}}], t({{}}) = {{}}, p {equals(p.text)}{{}}.",
        *cited,
        p,
    )


def _curve_table(curve: pd.DataFrame, factor: str) -> Table:
    rows = tuple(
        {
            "cell": f"{r.level}/{int(r.trial_in_set)}",
            factor: str(r.level),
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
            Column(factor, factor),
            Column("position", "trial", "int"),
            Column("time", "geometric mean (s)", "sig4"),
            Column("n", "n", "int"),
        ),
        rows,
        (factor, "position", "time", "n"),
    )


def _faults(context: Context) -> list[Block]:
    trials, plan = context.trials, context.plan
    simulated, main = context.study.source == "simulated", context.design.main
    if main is None:
        return []
    missed = [] if simulated else share_missed(trials, main)
    faults = [*missed, *focus_losses(trials, main), *timeouts(trials, main)]
    notes = [say(NO_DISPLAY, kind="note")] if simulated else []
    if not faults:
        return [*notes]
    table = replace(
        compare(faults),
        key="faults",
        title=f"{'Lost' if simulated else 'Missed frames, lost'} focus and time-outs by condition",
        shown=FAULTS_SHOWN,
    )
    return [
        *notes,
        *_none_apart(table, faults),
        *(_fault(table, m, plan) for m in faults if _apart(m)),
        table,
    ]


def _apart(m: Pair) -> bool:
    return bool(difference_signs(m.first, m.second).any())


def _none_apart(table: Table, faults: Sequence[Pair]) -> list[Prose]:
    """What was the same for everybody, a sentence for each kind and not for each contrast."""
    kinds: dict[str, list[Pair]] = {}
    for m in faults:
        kinds.setdefault(m.label.partition(":")[0], []).append(m)
    said = []
    for kind, own in kinds.items():
        same = [m for m in own if not _apart(m)]
        if not same:
            continue
        name = f"{kind[0].upper()}{kind[1:]}"
        where = "every condition" if len(same) == len(own) > 1 else "both conditions"
        if 0 < len(same) < len(own):
            name += " (" + "; ".join(m.label.partition(": ")[2] for m in same) + ")"
        said.append(say(f"{name}: the same for everybody under {where} (M = {{}}).",
                        table.cite(same[0].key, "mean_baseline")))  # fmt: skip
    return said


def _fault(table: Table, m: Pair, plan: Plan) -> Prose:
    """One kind of fault: different, equivalent, or neither is shown."""
    name = f"{m.label[0].upper()}{m.label[1:]}"
    start = say(
        f"{name}: M = {{}} {m.names[0]}, {{}} {m.names[1]}, {{}}.",
        table.cite(m.key, "mean_baseline"),
        table.cite(m.key, "mean_level"),
        apa_f(table, m.key),
    )
    p = table.row(m.key)["p"]
    if not is_defined(p):
        return start
    if p < plan.alpha:
        return Prose((*start.runs, " This could explain part of a difference in time."))
    return Prose((*start.runs, *no_difference(table, m.key, plan.alpha)))
