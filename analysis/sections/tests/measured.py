"""Measures on their own scale or as logarithms: cells, contrasts, and what else is asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import (
    LOG_MORE,
    MORE,
    MORE_TITLE,
    Pair,
    apa_f,
    compare,
    compare_logs,
    corrected,
    decisive,
    pair_of,
)
from seethrough.analysis.design import Contrast, Measured
from seethrough.analysis.equivalence import margin_of, no_difference, no_ratio
from seethrough.analysis.figures.comparison import bars_and_differences
from seethrough.analysis.figures.levels import level_means
from seethrough.analysis.measures import TASK, cells_of, over_tasks
from seethrough.analysis.page.blocks import Block, Prose, Table, more, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import cell_table, missing_note, of_people
from seethrough.analysis.sections.tests.contrasts import contrast_blocks
from seethrough.analysis.sections.tests.omnibus import omnibus
from seethrough.analysis.sections.tests.pairwise import pairwise_blocks
from seethrough.analysis.stats.undefined import is_defined, number_in

RAW = (
    "Times are skewed: where the two levels also differ in spread (s.d. of logarithms .8 and .3, "
    "8 or 16 people), F of raw times rejects in .12 of studies without a difference, for .05, and "
    "the intervals hold the truth in .88, for .95: the logarithms are what to read."
)
OVERALL = "overall"


def pair_key(measure: str, where: str, contrast: Contrast, several: bool) -> str:
    """A row's key: `time_overall`, `time_overall/view=cut` where there are several contrasts."""
    return f"{measure}_{where}" + (f"/{contrast.key}" if several else "")


def pairs_of(
    context: Context, measure: Measured, cells: Cells, logs: Cells | None = None
) -> list[Pair]:
    """Every within contrast of a measure: over its tasks together if they pool, and in each task.

    A task's row has everybody who has that task; the overall one those who have them all.
    """
    design, found = context.design, []
    contrasts = [c for c in design.contrasts() if not c.between]
    several, tasks = len(contrasts) > 1, cells.factors[TASK]
    for contrast in contrasts:
        manifold = len(design.factor(contrast.factor).levels) > 2
        if len(tasks) > 1 and measure.pool:
            family = f"{OVERALL} {contrast.factor}" if manifold else ""
            found.append(_pair(
                context, measure, OVERALL, _label(OVERALL, contrast, several),
                over_tasks(cells), over_tasks(logs) if logs else None, contrast, several, family,
            ))  # fmt: skip
        for task in tasks:
            label = _label(design.task_said(task), contrast, several)
            alone = len(design.tasks_with(measure.name)) == 1
            family = measure.name if manifold or not alone else ""
            found.append(_pair(
                context, measure, task, label, cells, logs, contrast, several,
                f"{family} {contrast.factor}" if family else "", task=task,
            ))  # fmt: skip
    return [pair for pair in found if pair is not None]


def _label(where: str, contrast: Contrast, several: bool) -> str:
    if not several:
        return where
    return f"{where}: {contrast.factor} {contrast.baseline} → {contrast.level}"


def _pair(
    context: Context, measure: Measured, where: str, label: str, cells: Cells,
    logs: Cells | None, contrast: Contrast, several: bool, family: str, **at: str,
) -> Pair | None:  # fmt: skip
    key = pair_key(measure.name, where, contrast, several)
    margin = margin_of(measure)
    about = (key, label, measure.unit, measure.digits)
    raw = pair_of(*about, cells, contrast, family, margin, at=at)
    if raw is None:
        return None
    raw = replace(raw, of=measure.name, where=where)
    if logs is None:
        return raw
    log = pair_of(*about, logs, contrast, family, margin, at=at)
    if log is None or len(log.first) != len(raw.first):
        return None
    return replace(raw, logs=(log.first, log.second))


def measured_blocks(context: Context, measure: Measured) -> tuple[list[Block], dict[str, Table]]:
    """A measure's blocks, none where the data have none of it; and its tables by what they hold.

    `logs`, `tests`: the contrasts of logarithms and on the raw scale; `contrasts`: those with their
    own error; `anova…`: the omnibus that decides.
    """
    cells = cells_of(context.trials, context.design, measure)
    if not cells.factors[TASK] or not (cells.counts > 0).any():
        return [], {}
    logs = cells_of(context.trials, context.design, measure, log=True) if measure.log else None
    context.lacking(measure.said, cells)
    blocks: list[Block] = [*missing_note(context.missing[measure.said])] if measure.log else []
    table = _cells(context, measure, cells, logs)
    pairs = [] if context.design.groups else pairs_of(context, measure, cells, logs)
    if not pairs and not context.design.groups:
        blocks.append(say(f"{measure.title}: nobody has a task under two levels."))
        return [*blocks, table], {}
    found: dict[str, Table] = {}
    if pairs:
        own, found = _pairs(context, measure, pairs)
        blocks += own
    blocks += [*_figure(context, measure, cells, pairs, found), *_tables(found)]
    factorial, anova = omnibus(context, measure, cells, logs)
    found |= anova
    extra, further = contrast_blocks(context, measure, logs or cells, anova, logs is not None)
    asked = pairwise_blocks(context, measure, logs or cells, logs is not None)
    return [*blocks, table, *factorial, *extra, *asked], found | further


def _cells(context: Context, measure: Measured, cells: Cells, logs: Cells | None) -> Table:
    own = [TASK, *(f.name for f in context.design.groups), *list(cells.factors)[1:]]
    names = " and ".join([", ".join(own[:-1]), own[-1]]) if len(own) > 1 else TASK
    note = "Mean and SD over participants' values of their trials in the cell."
    if logs is not None:
        note = (
            f"{measure.title} in {measure.unit}; mean and SD over participants' means of their "
            "trials; geometric mean over participants' means of the logarithms of their trials."
        )
    kind = "bound" if measure.scale in ("binary", "bounded") else "fixed"
    return cell_table(
        f"{measure.name}_cells", f"{measure.title} by {names}", cells, context, note, kind, logs,
        2 if measure.log or kind == "bound" else measure.digits,
    )  # fmt: skip


def _pairs(
    context: Context, measure: Measured, pairs: Sequence[Pair]
) -> tuple[list[Block], dict[str, Table]]:
    """The sentences and tables of the contrasts; of a log measure those of logarithms decide."""
    tests = replace(
        compare(pairs), key=f"tests_{measure.name}", title=f"{measure.title}: contrasts",
        note=_note(measure) + _shared(context),
    )  # fmt: skip
    if not measure.log:
        said = in_short(
            [(m, tests.row(m.key), _sentence(tests, m, measure, context)) for m in pairs],
            context, measure.title,
        )  # fmt: skip
        return list(said), {"tests": tests}
    unit = f" in {measure.unit}" if measure.unit else ""
    tests = replace(
        tests,
        title=f"{measure.title}{unit}, on the raw scale",
        note=RAW + _shared(context),
    )
    logs = replace(
        compare_logs(pairs), key=f"tests_log_{measure.name}",
        title=f"{measure.title} on the log scale",
    )  # fmt: skip
    logs = replace(logs, note=logs.note + _shared(context))
    said = in_short(
        [(m, logs.row(m.key), _log_sentence(tests, logs, m, context)) for m in pairs],
        context, measure.title,
    )  # fmt: skip
    return list(said), {"logs": logs, "tests": tests}


def _shared(context: Context) -> str:
    """Why a level's mean is not the same in all its contrasts."""
    if not context.design.excluded:
        return ""
    return (
        " The study leaves out cells: each contrast is over those that both its levels have, so "
        "a level's mean may differ from contrast to contrast."
    )


def in_short(
    said: Sequence[tuple[Pair, Mapping[str, object], Prose]], context: Context, what: str
) -> list[Prose]:
    """Each contrast's sentence; of several contrasts only those that show something, and where
    nothing was found one line for all. `what`: the measure."""
    if len({m.contrast for m, _, _ in said}) < 2:
        return [sentence for _, _, sentence in said]
    alpha = context.plan.alpha
    shown, none, equal = [], [], []
    for m, row, sentence in said:
        p = decisive(row)[1]
        if not is_defined(p) or p < alpha:
            shown.append(sentence)
        elif is_defined(row["tost_p"]) and row["tost_p"] < alpha:
            equal.append(m.label)
        else:
            none.append(m.label)
    if equal:
        words = "equivalent within the declared margin"
        shown.append(say(f"{what}, {words}: {'; '.join(equal)}."))
    if none and len(none) == len(said):
        shown.append(say(f"{what}: none of its {len(none)} contrasts with a baseline shows a "
                         "difference, which is no evidence of equality."))  # fmt: skip
    elif none:
        shown.append(say(f"{what}, no difference shown, which is no evidence of equality: "
                         f"{'; '.join(none)}."))  # fmt: skip
    return shown


NOTES = {
    "relative": "abs(Σ error) / Σ truth over a participant's trials of a condition: over- and "
    "underestimates cancel.",
    "relative absolute": "Σ abs(error) / Σ truth over a participant's trials of a condition, in "
    "which over- and underestimates do not cancel.",
}


def _note(measure: Measured) -> str:
    return NOTES.get(measure.adds, "")


def _tables(found: dict[str, Table]) -> list[Block]:
    """The tables of contrasts, each with its further columns behind a fold."""
    if "logs" in found:
        lower = f"{MORE_TITLE[0].lower()}{MORE_TITLE[1:]}"
        logs, tests = found["logs"], found["tests"]
        return [logs, more(logs, f"Logarithms: {lower}", LOG_MORE),
                tests, more(tests, f"Raw values: {lower}", MORE)]  # fmt: skip
    if "tests" in found:
        return [found["tests"], more(found["tests"], MORE_TITLE, MORE)]
    return []


def _figure(
    context: Context, measure: Measured, cells: Cells, pairs: Sequence[Pair],
    found: dict[str, Table],
) -> list[Block]:  # fmt: skip
    axis = f"{measure.said} ({measure.unit})" if measure.unit else measure.said
    if pairs and len({p.names for p in pairs}) == 1:
        title = f"{measure.title} by task"
        return [bars_and_differences(measure.name, title, axis, pairs, found["tests"])]
    return [level_means(measure.name, f"{measure.title}: means and intervals", axis, cells,
                        context)]  # fmt: skip


def _sentence(tests: Table, m: Pair, measure: Measured, context: Context) -> Prose:
    row, (first, second) = tests.row(m.key), m.names
    what = f"{measure.title}, {m.label}"
    if not is_defined(row["F"]):
        return say(
            f"{what}{{}}: M = {{}} {first}, {{}} {second}; no test: {{}}.",
            of_people(tests, m.key, context),
            tests.cite(m.key, "mean_baseline"),
            tests.cite(m.key, "mean_level"),
            tests.cite(m.key, "F"),
        )
    start = say(
        f"{what}{{}}: M = {{}} (SD = {{}}) {first}, {{}} (SD = {{}}) {second}, {{}}.",
        of_people(tests, m.key, context),
        tests.cite(m.key, "mean_baseline"),
        tests.cite(m.key, "sd_baseline"),
        tests.cite(m.key, "mean_level"),
        tests.cite(m.key, "sd_level"),
        [*apa_f(tests, m.key), *corrected(tests, m.key)],
    )
    p = decisive(row)[1]
    if not is_defined(p) or p < context.plan.alpha:
        return start
    return Prose((*start.runs, *no_difference(tests, m.key, context.plan.alpha)))


def _log_sentence(tests: Table, logs: Table, m: Pair, context: Context) -> Prose:
    """Geometric means and their ratio first; the raw test beside."""
    row, alpha = logs.row(m.key), context.plan.alpha
    where, _, _ = m.label.partition(": ")
    name = "Over all tasks" if where == OVERALL else f"In {where}"
    if not is_defined(row["p"]):
        return say(f"{name}: {{}}.", logs.cite(m.key, "p"))
    faster = "faster" if number_in(row, "ratio") < 1 else "slower"
    _, deciding = decisive(row)
    shown = is_defined(deciding) and deciding < alpha
    verdict = f"participants were {faster} with {m.said[1]}"
    verdict = verdict if shown else f"no difference between {m.names[0]} and {m.names[1]} was shown"
    sentence = say(
        f"{name}{{}}, {verdict}: geometric means of {{}} s ({m.names[0]}) and {{}} s "
        f"({m.names[1]}), ratio {{}}, 95 % CI [{{}}, {{}}], {{}}. Raw times: M = {{}} s "
        "(SD = {}) and {} s (SD = {}), {}.",
        of_people(logs, m.key, context),
        logs.cite(m.key, "geometric_baseline"),
        logs.cite(m.key, "geometric_level"),
        logs.cite(m.key, "ratio"),
        logs.cite(m.key, "ratio_low"),
        logs.cite(m.key, "ratio_high"),
        [*apa_f(logs, m.key), *corrected(logs, m.key)],
        tests.cite(m.key, "mean_baseline"),
        tests.cite(m.key, "sd_baseline"),
        tests.cite(m.key, "mean_level"),
        tests.cite(m.key, "sd_level"),
        apa_f(tests, m.key),
    )
    return sentence if shown else Prose((*sentence.runs, *no_ratio(logs, m.key, alpha)))
