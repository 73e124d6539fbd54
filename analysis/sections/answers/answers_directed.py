"""A prediction that a level takes less, or more, of what is analysed as logarithms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from seethrough.analysis.comparison import apa_f
from seethrough.analysis.design import Contrast, Prediction
from seethrough.analysis.equivalence import no_ratio
from seethrough.analysis.measures import TASK
from seethrough.analysis.page.blocks import Cited, Prose, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.answers.answers import Answer, depends, on_average, p_runs
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import cited_f
from seethrough.analysis.stats.undefined import either_in, is_defined, number_in

WORDS = {"less": "slower", "more": "faster"}
"""What a level is called that goes against what was expected."""


def faster(
    context: Context, prediction: Prediction, tables: Mapping[str, Table], contrast: Contrast,
    start: str,
) -> Answer:  # fmt: skip
    """The contrast over all tasks decides; where its effect differs between them, they are read."""
    logs, alpha = tables["logs"], context.plan.alpha
    own = [r for r in logs.rows if r["level"] == contrast.key]
    if not own:
        said = say(f"{start}not answered, nobody has times under both levels.", kind="answer")
        return Answer(prediction, said, "not answered")
    key, row = str(own[0]["measure"]), own[0]
    if not is_defined(row["p"]):
        said = say(f"{start}{{}}.", logs.cite(key, "p"), kind="answer")
        return Answer(prediction, said, "not answered", either_in(row, "p"), 1)
    tasks = [r for r in own if r["p_holm"] is not None and is_defined(r["p_holm"])]
    tasks = [r for r in tasks if r["where"] != "overall"]
    differ = _interaction(tables.get(f"anova_{TASK}"), contrast, alpha)
    unlike = depends(tables, contrast.factor, alpha)
    verdict = _verdict(row, tasks, bool(differ), alpha, prediction.expect)
    verdict = on_average(verdict, bool(unlike))
    factor = context.design.factor(contrast.factor)
    of = [factor.label(level) for level in (contrast.baseline, contrast.level)]
    said = say(
        f"{start}{verdict}. The geometric mean of times with {of[1]} is {{}} of that with {of[0]}, "
        "95 % CI [{}, {}], {}.",
        logs.cite(key, "ratio"),
        logs.cite(key, "ratio_low"),
        logs.cite(key, "ratio_high"),
        apa_f(logs, key),
        kind="answer",
    )
    runs = said.runs if row["p"] < alpha else (*said.runs, *no_ratio(logs, key, alpha))
    said = Prose((*runs, *unlike, *differ, *by_task(logs, tasks, alpha)), "answer")
    return Answer(prediction, said, verdict, row["p"], 1)


def _verdict(
    row: Mapping[str, object],
    tasks: Sequence[Mapping[str, object]],
    differ: bool,
    alpha: float,
    expect: str,
) -> str:
    """The overall test's verdict, and whether the tasks bear it out."""
    against = WORDS[expect]
    sign = 1 if expect == "less" else -1
    if number_in(row, "p") >= alpha:
        return "not shown"
    if sign * (number_in(row, "ratio") - 1) > 0:
        return f"contradicted: it is {against}"
    other = [
        r
        for r in tasks
        if number_in(r, "p_holm") < alpha and sign * (number_in(r, "ratio") - 1) > 0
    ]
    unshown = [r for r in tasks if number_in(r, "p_holm") >= alpha]
    if other or (differ and unshown):
        return "supported over all tasks together, not in each"
    return "supported"


def _interaction(table: Table | None, contrast: Contrast, alpha: float) -> list[str | Cited]:
    """Where the effect differs between tasks, an overall ratio is no task's effect."""
    if table is None:
        return []
    effects = {str(r["effect"]) for r in table.rows}
    effect = next(
        (e for e in (f"{TASK} × {contrast.factor}", f"{contrast.factor} × {TASK}") if e in effects),
        None,
    )
    if effect is None:
        return []
    p = table.row(effect)["p_decisive"]
    if not is_defined(p) or p >= alpha:
        return []
    return [
        " The ratio differs between tasks (",
        *cited_f(table, effect),
        "), so the one over all tasks is a mean of unlike effects, and the tasks' own are what "
        "to read.",
    ]


def by_task(logs: Table, tasks: Sequence[Mapping[str, object]], alpha: float) -> list[str | Cited]:
    """In which tasks it is faster, slower, or neither, by Holm's p."""
    if len(tasks) < 2:
        return []
    runs: list[str | Cited] = [" By task (Holm-corrected): "]
    for i, row in enumerate(tasks):
        words = "no difference shown"
        if number_in(row, "p_holm") < alpha:
            words = "faster" if number_in(row, "ratio") < 1 else "slower"
        p = logs.cite(str(row["measure"]), "p_holm")
        runs += ["; " if i else "", f"{row['label']} {words}, ratio "]
        runs += [logs.cite(str(row["measure"]), "ratio"), ", p "]
        runs += [equals(p.text), p]
        if words == "no difference shown" and is_defined(row["tost_p"]):
            runs += p_runs(logs, row, "tost_p")
    return [*runs, "."]
