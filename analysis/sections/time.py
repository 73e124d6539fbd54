"""Completion time overall, by task, by scenario: logarithms first, the paper's scale beside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import (
    LOG_MORE,
    MORE,
    MORE_TITLE,
    Measure,
    apa_f,
    compare,
    compare_logs,
    corrected,
    decisive,
    measure,
)
from seethrough.analysis.equivalence import no_ratio
from seethrough.analysis.figures.comparison import bars_and_differences
from seethrough.analysis.measures import (
    by_scenario,
    log_time_by_task,
    over_tasks,
    scenario_of,
    time_by_task,
)
from seethrough.analysis.page.blocks import Block, Fold, Prose, Section, Table, more, say
from seethrough.analysis.sections.context import Context
from seethrough.analysis.sections.tables import (
    INTERACTION,
    anova_table,
    cell_table,
    effect_sentence,
    keep,
    missing_note,
    name_of,
    of_people,
    testable,
)
from seethrough.analysis.stats.undefined import is_defined

RAW = (
    "Times are skewed: where the two levels also differ in spread (s.d. of logarithms .8 and .3, "
    "8 or 16 people), F of raw times rejects in .12 of studies without a difference, for .05, and "
    "the intervals hold the truth in .88, for .95: the logarithms are what to read."
)


def time_measures(cells: Cells, logs: Cells) -> list[Measure]:
    """Overall (plain mean of the tasks) and each task, with the mean logarithms beside.

    A task's row has everybody who has that task; the overall one those who have them all.
    """
    found = []
    if len(cells.factors["task"]) > 1:
        found.append(_timed("time_overall", "overall", "", over_tasks(cells), over_tasks(logs)))
    for task in cells.factors["task"]:
        found.append(_timed(f"time_{task}", name_of(task), "tasks", cells, logs, task=task))
    return keep(found)


def _timed(
    key: str, label: str, family: str, cells: Cells, logs: Cells, **at: str
) -> Measure | None:
    raw = measure(key, label, "s", 2, cells, family, "time", **at)
    log = measure(key, label, "s", 2, logs, family, "time", **at)
    return replace(raw, logs=(log.standard, log.dynamic)) if raw and log else None


def time_section(context: Context) -> tuple[Section, Sequence[Table]]:
    """The section, and the tables that the first prediction is answered from.

    They are the log tests and, where there is one, the ANOVA of transparency × task.
    """
    cells, log_cells = time_by_task(context.trials), log_time_by_task(context.trials)
    context.lacking("completion time", cells)
    blocks: list[Block] = [*missing_note(cells.missing)]
    table = cell_table(
        "time_cells",
        "Completion time by task and transparency",
        cells,
        ("task", "transparency", "n", "trials", "mean", "sd", "geometric", "median"),
        "Seconds; mean and SD over participants' means of their trials; geometric mean over "
        "participants' means of the logarithms of their trials.",
        logs=log_cells,
    )
    measures = time_measures(cells, log_cells)
    if not measures:
        blocks.append(say("Nobody has a task under both transparency levels."))
        return Section("time", "Completion time", (*blocks, table)), ()
    tests = replace(
        compare(measures, context.plan.margins),
        key="tests_time",
        title="Completion times in seconds, as the paper has them",
        note=RAW,
    )
    logs = compare_logs(measures, context.plan.margins)
    blocks += [_sentence(tests, logs, m, context) for m in measures]
    blocks.append(
        bars_and_differences("time", "Completion time by task", "time (s)", measures, tests)
    )
    anova, factorial = _factorial(context, cells, log_cells)
    blocks += [
        logs,
        more(logs, f"Log times: {MORE_TITLE[0].lower()}{MORE_TITLE[1:]}", LOG_MORE),
        tests,
        more(tests, f"Raw times: {MORE_TITLE[0].lower()}{MORE_TITLE[1:]}", MORE),
        table,
        *factorial,
    ]
    return Section("time", "Completion time", tuple(blocks)), (logs, *anova)


def _sentence(tests: Table, logs: Table, m: Measure, context: Context) -> Prose:
    """Geometric means and their ratio first; the raw test as the paper printed it."""
    row, alpha = logs.row(m.key), context.plan.alpha
    name = "Over all tasks" if m.key == "time_overall" else f"In {m.label}"
    if not is_defined(row["p"]):
        return say(f"{name}: {{}}.", logs.cite(m.key, "p"))
    faster = "faster" if row["ratio"] < 1 else "slower"
    _, deciding = decisive(row)
    shown = is_defined(deciding) and deciding < alpha
    verdict = f"participants were {faster} with dynamic transparency"
    verdict = verdict if shown else "no difference between the conditions was shown"
    sentence = say(
        f"{name}{{}}, {verdict}: geometric means of {{}} s (standard) and {{}} s "
        "(dynamic), ratio {}, 95 % CI [{}, {}], {}. Raw times: M = {} s (SD = {}) and {} s (SD = "
        "{}), {}.",
        of_people(logs, m.key, context),
        logs.cite(m.key, "geometric_standard"),
        logs.cite(m.key, "geometric_dynamic"),
        logs.cite(m.key, "ratio"),
        logs.cite(m.key, "ratio_low"),
        logs.cite(m.key, "ratio_high"),
        [*apa_f(logs, m.key), *corrected(logs, m.key)],
        tests.cite(m.key, "mean_standard"),
        tests.cite(m.key, "sd_standard"),
        tests.cite(m.key, "mean_dynamic"),
        tests.cite(m.key, "sd_dynamic"),
        apa_f(tests, m.key),
    )
    return sentence if shown else Prose((*sentence.runs, *no_ratio(logs, m.key, alpha)))


def _factorial(context: Context, cells: Cells, logs: Cells) -> tuple[list[Table], list[Block]]:
    """Transparency × task with Greenhouse–Geisser, and transparency × scenario on means.

    The first table by itself, and all blocks.
    """
    blocks: list[Block] = []
    anova: list[Table] = []
    if testable(cells):
        note = (
            "Tasks are nested in scenarios, so task is one factor. Logarithms of trials' seconds."
        )
        log = anova_table("anova_time_task_log", "Transparency × task, log time", logs, note)
        raw = anova_table("anova_time_task", "Transparency × task, seconds", cells)
        what = (
            "The technique's effect (a ratio of times) differs between tasks",
            "The technique's effect (a ratio of times) does not demonstrably differ between tasks",
        )
        anova = [log]
        sentence = effect_sentence(log, INTERACTION, what, context.plan.alpha)
        blocks += [sentence, log, Fold("On the raw scale", (raw,))]
    nested = scenario_of(context.trials)
    scenarios, log_scenarios = by_scenario(cells, nested), by_scenario(logs, nested)
    if testable(scenarios):
        log = anova_table(
            "anova_time_scenario_log",
            "Transparency × scenario, log time",
            log_scenarios,
            "Means of the two tasks nested in each scenario.",
        )
        raw = anova_table("anova_time_scenario", "Transparency × scenario, seconds", scenarios)
        blocks += [log, Fold("On the raw scale", (raw,))]
    return anova, blocks
