"""The first page: the study's questions, answered in plain sentences."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

from seethrough.analysis.comparison import apa_f, decisive
from seethrough.analysis.equivalence import no_ratio
from seethrough.analysis.page.blocks import Cited, Prose, Section, Table, say
from seethrough.analysis.plan import Plan
from seethrough.analysis.sections.accuracy import measured
from seethrough.analysis.sections.context import Context
from seethrough.analysis.sections.participants import reach, reach_sentence
from seethrough.analysis.sections.tables import INTERACTION, cited_f
from seethrough.analysis.stats.undefined import is_defined

PLANNING = " (simulated participants)"


def summary_section(
    context: Context, times: Sequence[Table], accuracy: Sequence[Table], single: Table | None
) -> Section:
    """P1 faster, P2 not less accurate, P3 depth perception, by name; then where numbers are.

    `times`: the log tests and, where there is one, the ANOVA of transparency × task.
    """
    note = PLANNING if context.study.source == "simulated" else ""
    blocks = [
        *_few(context),
        _faster(context, times, note),
        _accurate(context.plan, accuracy, note),
        _depth(single, note),
    ]
    return Section("summary", "In short", (*blocks, *places(blocks)))


def _few(context: Context) -> list[Prose]:
    """A warning where there are few participants."""
    if context.people == 1:
        return [say("Only 1 participant: nothing can be tested.", kind="warning")]
    found = reach(context)
    said = reach_sentence(found) if found else None
    return [said] if said is not None and said.kind == "warning" else []


def _faster(context: Context, times: Sequence[Table], note: str) -> Prose:
    start = f"P1, dynamic transparency is faster{note}: "
    if not times or not times[0].rows:
        return say(f"{start}not answered, nobody has times under both levels.", kind="answer")
    logs, plan = times[0], context.plan
    key = str(logs.rows[0]["measure"])
    row = logs.row(key)
    if not is_defined(row["p"]):
        return say(f"{start}{{}}.", logs.cite(key, "p"), kind="answer")
    tasks = [r for r in logs.rows if r["p_holm"] is not None and is_defined(r["p_holm"])]
    differ = _interaction(times[1:], plan.alpha)
    said = say(
        f"{start}{_verdict_of_time(row, tasks, bool(differ), plan.alpha)}. The geometric mean of "
        "times with it is {} of that without, 95 % CI [{}, {}], {}.",
        logs.cite(key, "ratio"),
        logs.cite(key, "ratio_low"),
        logs.cite(key, "ratio_high"),
        apa_f(logs, key),
        kind="answer",
    )
    shown = row["p"] < plan.alpha
    runs = said.runs if shown else (*said.runs, *no_ratio(logs, key, plan.alpha))
    return Prose((*runs, *differ, *_by_task(logs, tasks, plan.alpha)), "answer")


def _verdict_of_time(row: Any, tasks: Sequence[Any], differ: bool, alpha: float) -> str:
    """The overall test's verdict, and whether the tasks bear it out."""
    if row["p"] >= alpha:
        return "not shown"
    if row["ratio"] > 1:
        return "contradicted: it is slower"
    slower = [r for r in tasks if r["p_holm"] < alpha and r["ratio"] > 1]
    unshown = [r for r in tasks if r["p_holm"] >= alpha]
    if slower or (differ and unshown):
        return "supported over all tasks together, not in each"
    return "supported"


def _interaction(anova: Sequence[Table], alpha: float) -> list[str | Cited]:
    """Where the technique's effect differs between tasks, an overall ratio is no task's effect."""
    if not anova:
        return []
    table, effect = anova[0], INTERACTION
    row = table.row(effect)
    if not is_defined(row["p_gg"]) or row["p_gg"] >= alpha:
        return []
    return [
        " The ratio differs between tasks (",
        *cited_f(table, effect),
        "), so the one over all tasks is a mean of unlike effects, and the tasks' own are what "
        "to read.",
    ]


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
        runs += ["" if p.text.startswith(("<", ">")) else "= ", p]
        if words == "no difference shown" and is_defined(row["tost_p"]):
            runs += _p(logs, row, "tost_p")
    return [*runs, "."]


ACCURACY = (
    "less accurate",
    "less accurate, though by less than the margin",
    "more accurate",
    "no worse within the margin",
    "not shown to be no worse",
    "without a margin and so untested, no difference being shown",
)
"""What can be said of a measure of accuracy, worst first."""


def _accurate(plan: Plan, tables: Sequence[Table], note: str) -> Prose:
    """Non-inferiority in every measure, so that the largest p decides and none is corrected."""
    start = f"P2, dynamic transparency does not cost accuracy{note}: "
    parts: dict[str, list[str | Cited]] = {words: [] for words in ACCURACY}
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
    runs = [f"{start}{_verdict_of_accuracy(told)}. It is "]
    for i, (words, own) in enumerate(told.items()):
        runs += [". It is " if i else "", f"{words} in ", *own]
    return say(f"{{}}. {_declared(plan)}", runs, kind="answer")


def _verdict_of_accuracy(told: Collection[str]) -> str:
    if "less accurate" in told:
        return "contradicted"
    if ACCURACY[5] in told:
        return "not answered, for want of a margin declared before the data"
    return "not shown everywhere" if ACCURACY[4] in told else "supported"


def _declared(plan: Plan) -> str:
    """The margins that accuracy is judged by."""
    names = {"count_error": "relative error", "correct": "share right", "distance": "distance"}
    own = [f"{names[k]} {v:g}" for k, v in plan.margins.items() if k in names]
    if not own:
        return "The study declared no margin of accuracy."
    return (
        f"Margins, declared before the data: {', '.join(own)}. It must be no worse in every "
        "measure, so the largest p decides."
    )


def _verdict(row: Any, alpha: float) -> tuple[str, str]:
    """What a row says of accuracy, and the column of the p behind it; "" where nothing can be.

    Errors and distances are better when smaller, shares of right answers (with a permutation p)
    when larger; a measure that everybody has alike says nothing here.
    """
    share = "p_exact" in row
    column, p = decisive(row)
    # T1's, T3's and T4's answers are judged by how far off they are, T2's by right or wrong
    if (share and row["measure"] != "correct_pattern") or not is_defined(p):
        return "", ""
    no_worse = row["noninferior_p"]
    within = is_defined(no_worse) and no_worse < alpha
    if p < alpha and (row["difference"] < 0) == share:
        return "more accurate", column
    if p < alpha:
        return (ACCURACY[1], "noninferior_p") if within else ("less accurate", column)
    if not is_defined(no_worse):
        return ACCURACY[5], column
    return (ACCURACY[3] if within else ACCURACY[4]), "noninferior_p"


def _p(table: Table, row: Any, column: str) -> list[str | Cited]:
    """` (p = .03)`, ` (Holm-corrected p = .03)` or ` (TOST p = .2)`."""
    p = table.cite(str(row["measure"]), column)
    names = {"tost_p": "TOST p", "p_holm": "Holm-corrected p", "noninferior_p": "one-sided p"}
    name = names.get(column, "p")
    equals = "" if p.text.startswith(("<", ">", "undefined")) else "= "
    return [f" ({name} {equals}", p, ")"]


def _depth(single: Table | None, note: str) -> Prose:
    start = f"P3, static depth perception does not suffer{note}: "
    rows = {str(r["item"]) for r in single.rows} if single else set()
    if single is None or "depth_test" not in rows:
        return say(f"{start}not asked.", kind="answer")
    return say(
        f"{start}not testable. {{}} of 3 right on average with the technique (n = {{}}); nobody "
        "takes the test without it, so this describes and does not compare.",
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
