"""Completion time overall, by task, by scenario: logarithms first, the paper's scale beside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analysis.cells import Cells
from analysis.comparison import (
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
from analysis.figures.comparison import bars_and_differences
from analysis.measures import by_scenario, over_tasks, scenario_of, time_by_task
from analysis.page.blocks import Block, Fold, Prose, Section, Table, more, say
from analysis.sections.context import Context
from analysis.sections.summary import no_ratio
from analysis.sections.tables import (
    anova_table,
    cell_table,
    effect_sentence,
    keep,
    missing_note,
    name_of,
    testable,
)
from analysis.stats.undefined import is_defined


def time_measures(cells: Cells) -> list[Measure]:
    """Overall (plain mean of the tasks) and each task, with logarithms."""
    if not len(cells.values):
        return []
    logs = replace(cells, values=np.log(cells.values))
    overall = measure("time_overall", "overall", "s", 2, over_tasks(cells))
    found: list[tuple[Measure | None, Cells, dict[str, str]]] = []
    if len(cells.factors["task"]) > 1:
        found.append((overall, over_tasks(logs), {}))
    for task in cells.factors["task"]:
        own = measure(f"time_{task}", name_of(task), "s", 2, cells, "tasks", task=task)
        found.append((own, logs, {"task": task}))
    return keep(
        [
            m
            and replace(
                m,
                logs=(
                    source.at(transparency="standard", **at),
                    source.at(transparency="dynamic", **at),
                ),
            )
            for m, source, at in found
        ]
    )


def time_section(context: Context) -> tuple[Section, Table | None]:
    """The section, and the table of log tests that the first prediction is answered from."""
    cells = time_by_task(context.trials)
    context.missing["completion time"] = cells.missing
    blocks: list[Block] = [*missing_note(cells.missing)]
    table = cell_table(
        "time_cells",
        "Completion time by task and transparency",
        cells,
        ("task", "transparency", "n", "trials", "mean", "sd", "geometric", "median"),
        "Seconds; mean and SD over participants' means of their trials.",
    )
    measures = time_measures(cells)
    if not measures:
        blocks.append(say("No participant has every task under both transparency levels."))
        return Section("time", "Completion time", (*blocks, table)), None
    tests = replace(compare(measures, context.plan.margin), key="tests_time")
    logs = compare_logs(measures, context.plan.margin)
    blocks += [_sentence(tests, logs, m, context.plan.alpha) for m in measures]
    blocks.append(
        bars_and_differences("time", "Completion time by task", "time (s)", measures, tests)
    )
    blocks += [
        logs,
        more(logs, f"Log times: {MORE_TITLE[0].lower()}{MORE_TITLE[1:]}", LOG_MORE),
        tests,
        more(tests, f"Raw times: {MORE_TITLE[0].lower()}{MORE_TITLE[1:]}", MORE),
        table,
        *_factorial(context, cells),
    ]
    return Section("time", "Completion time", tuple(blocks)), logs


def _sentence(tests: Table, logs: Table, m: Measure, alpha: float) -> Prose:
    """Geometric means and their ratio first; the raw test as the paper printed it."""
    row = logs.row(m.key)
    name = "Over all tasks" if m.key == "time_overall" else f"In {m.label}"
    if not is_defined(row["p"]):
        return say(f"{name}: {{}}.", logs.cite(m.key, "p"))
    faster = "faster" if row["ratio"] < 1 else "slower"
    _, deciding = decisive(row)
    shown = is_defined(deciding) and deciding < alpha
    verdict = f"participants were {faster} with dynamic transparency"
    verdict = verdict if shown else "no difference between the conditions was shown"
    sentence = say(
        f"{name}, {verdict}: geometric means of {{}} s (standard) and {{}} s "
        "(dynamic), ratio {}, 95 % CI [{}, {}], {}. Raw times: M = {} s (SD = {}) and {} s (SD = "
        "{}), {}.",
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


def _factorial(context: Context, cells: Cells) -> list[Block]:
    """Transparency × task with Greenhouse–Geisser, and transparency × scenario on means."""
    blocks: list[Block] = []
    if testable(cells):
        note = "Tasks are nested in scenarios, so task is one factor. Logarithms of seconds."
        log = anova_table("anova_time_task_log", "Transparency × task, log time", cells, True, note)
        raw = anova_table("anova_time_task", "Transparency × task, seconds", cells)
        effect = "task × transparency"
        what = (
            "The technique's effect (a ratio of times) differs between tasks",
            "The technique's effect (a ratio of times) does not demonstrably differ between tasks",
        )
        sentence = effect_sentence(log, effect, what, context.plan.alpha)
        blocks += [sentence, log, Fold("On the raw scale", (raw,))]
    scenarios = by_scenario(cells, scenario_of(context.trials))
    if testable(scenarios):
        log = anova_table(
            "anova_time_scenario_log",
            "Transparency × scenario, log time",
            scenarios,
            True,
            "Means of the two tasks nested in each scenario.",
        )
        raw = anova_table("anova_time_scenario", "Transparency × scenario, seconds", scenarios)
        blocks += [log, Fold("On the raw scale", (raw,))]
    return blocks
