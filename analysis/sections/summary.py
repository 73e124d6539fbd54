"""The first page: the study's questions, answered in plain sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from analysis.comparison import apa_f, decisive
from analysis.page.blocks import Cited, Prose, Section, Table, say
from analysis.plan import Plan
from analysis.sections.accuracy import measured
from analysis.sections.context import Context
from analysis.stats.undefined import is_defined

PLANNING = " (simulated participants)"


def summary_section(
    context: Context, logs: Table | None, accuracy: Sequence[Table], single: Table | None
) -> Section:
    """P1 faster, P2 not less accurate, P3 depth perception, by name; then where numbers are."""
    note = PLANNING if context.study.source == "simulated" else ""
    blocks = [
        _faster(context, logs, note),
        _accurate(context.plan, accuracy, note),
        _depth(single, note),
    ]
    return Section("summary", "In short", (*blocks, *places(blocks)))


def _faster(context: Context, logs: Table | None, note: str) -> Prose:
    start = f"P1, dynamic transparency is faster{note}: "
    if logs is None or not logs.rows:
        return say(f"{start}not answered, nobody has complete times.", kind="answer")
    key = str(logs.rows[0]["measure"])
    row = logs.row(key)
    if not is_defined(row["p"]):
        return say(f"{start}{{}}.", logs.cite(key, "p"), kind="answer")
    plan = context.plan
    supported = row["p"] < plan.alpha
    tasks = [r for r in logs.rows if r["p_holm"] is not None and is_defined(r["p_holm"])]
    slower = [r for r in tasks if r["p_holm"] < plan.alpha and r["ratio"] > 1]
    verdict = "supported" if not slower else "supported over all tasks together, not in each"
    if not supported or row["ratio"] > 1:
        verdict = "contradicted: it is slower" if supported else "not shown"
    said = say(
        f"{start}{verdict}. The geometric mean of times with it is {{}} of that without, 95 % CI "
        "[{}, {}], {}.",
        logs.cite(key, "ratio"),
        logs.cite(key, "ratio_low"),
        logs.cite(key, "ratio_high"),
        apa_f(logs, key),
        kind="answer",
    )
    runs = said.runs if supported else (*said.runs, *no_ratio(logs, key, plan.alpha))
    return Prose((*runs, *_by_task(logs, tasks, plan.alpha)), "answer")


def _by_task(logs: Table, tasks: Sequence[Any], alpha: float) -> list[str | Cited]:
    """In which tasks it is faster, slower, or neither, by Holm's p."""
    if len(tasks) < 2:
        return []
    runs: list[str | Cited] = [" By task (Holm-corrected): "]
    for i, row in enumerate(tasks):
        words = "no difference shown"
        if row["p_holm"] < alpha:
            words = "faster" if row["ratio"] < 1 else "slower"
        p = logs.cite(str(row["measure"]), "p_holm")
        runs += ["; " if i else "", f"{row['label']} {words}, ratio "]
        runs += [logs.cite(str(row["measure"]), "ratio"), ", p "]
        runs += ["" if p.text.startswith("<") else "= ", p]
        if words == "no difference shown":
            runs += _p(logs, row, "tost_p")
    return [*runs, "."]


def no_ratio(logs: Table, key: str, alpha: float) -> tuple[str | Cited, ...]:
    """Where no difference of log times is shown: is equivalence?"""
    p = logs.cite(key, "tost_p")
    if not is_defined(p.value):
        return say(" Whether the times are equivalent is {}.", p).runs
    verdict = "equivalence is shown" if p.value < alpha else "equivalence is not shown either"
    return say(
        f" For a ratio between 1 / {{}} and {{}}, p {'' if p.text.startswith('<') else '= '}{{}} "
        f"(TOST): {verdict}.",
        logs.cite(key, "tost_margin"),
        logs.cite(key, "tost_margin"),
        p,
    ).runs


def _accurate(plan: Plan, tables: Sequence[Table], note: str) -> Prose:
    start = f"P2, dynamic transparency does not cost accuracy{note}: "
    parts: dict[str, list[str | Cited]] = {
        "less accurate": [],
        "more accurate": [],
        "equivalent within the margin": [],
        "neither different nor shown to be equivalent": [],
    }
    for table in tables:
        for row in table.rows:
            words, column = _verdict(row, plan.alpha)
            if words:
                runs = parts[words]
                name = measured(str(row["measure"]), str(row["label"]))
                runs += ["; " if runs else "", name, *_p(table, row, column)]
    told = {words: runs for words, runs in parts.items() if runs}
    if not told:
        return say(f"{start}not answered, no accuracy measure can be tested.", kind="answer")
    verdict = (
        "contradicted"
        if "less accurate" in told
        else "not contradicted, and not shown everywhere"
        if "neither different nor shown to be equivalent" in told
        else "supported"
    )
    runs = [f"{start}{verdict}. It is "]
    for i, (words, own) in enumerate(told.items()):
        runs += [". It is " if i else "", f"{words} in ", *own]
    return say(f"{{}}. Margin: {100 * plan.margin:g} % of the standard mean.", runs, kind="answer")


def _verdict(row: Any, alpha: float) -> tuple[str, str]:
    """What a row says of accuracy, and the column of the p behind it; "" where nothing can be.

    Errors and distances are better when smaller, shares of right answers (with an exact p) when
    larger; a measure that everybody has alike says nothing here.
    """
    share = "p_exact" in row
    column, p = decisive(row)
    # T1's, T3's and T4's answers are judged by how far off they are, T2's by right or wrong
    if (share and row["measure"] != "correct_pattern") or not is_defined(p):
        return "", ""
    if p < alpha:
        better = (row["difference"] < 0) == share
        return ("more accurate" if better else "less accurate"), column
    if is_defined(row["tost_p"]) and row["tost_p"] < alpha:
        return "equivalent within the margin", "tost_p"
    return "neither different nor shown to be equivalent", "tost_p"


def _p(table: Table, row: Any, column: str) -> list[str | Cited]:
    """` (p = .03)`, ` (Holm-corrected p = .03)` or ` (TOST p = .2)`."""
    p = table.cite(str(row["measure"]), column)
    name = {"tost_p": "TOST p", "p_holm": "Holm-corrected p"}.get(column, "p")
    equals = "" if p.text.startswith(("<", "undefined")) else "= "
    return [f" ({name} {equals}", p, ")"]


def _depth(single: Table | None, note: str) -> Prose:
    start = f"P3, static depth perception does not suffer{note}: "
    rows = {str(r["item"]) for r in single.rows} if single else set()
    if single is None or "depth_test" not in rows:
        return say(f"{start}not asked.", kind="answer")
    return say(
        f"{start}not testable. {{}} of 3 right on average with the technique, from {{}} "
        "participants; nobody takes the test without it, so this describes and does not compare.",
        single.cite("depth_test", "mean"),
        single.cite("depth_test", "n"),
        kind="answer",
    )


def places(blocks: Sequence[Prose]) -> list[Prose]:
    """In which files and rows the numbers above are, at full precision."""
    rows: dict[str, list[str]] = {}
    for cited in (run for block in blocks for run in block.runs if isinstance(run, Cited)):
        own = rows.setdefault(cited.file, [])
        if cited.row not in own:
            own.append(cited.row)
    if not rows:
        return []
    said = "; ".join(
        f"tables/{file}, {'row' if len(own) == 1 else 'rows'} {', '.join(own)}"
        for file, own in rows.items()
    )
    return [
        say(
            f"Every number above stands at full precision in {said}. Point at a number anywhere "
            "in the text for its file, row and column.",
            kind="note",
        )
    ]
