"""Accuracy: counting errors (T1, T4), patterns found (T2), marks on the plan (T3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from seethrough.analysis.comparison import (
    MORE,
    MORE_TITLE,
    Measure,
    add_holm,
    apa_f,
    compare,
    corrected,
    decisive,
    measure,
)
from seethrough.analysis.equivalence import no_difference
from seethrough.analysis.figures.comparison import bars_and_differences
from seethrough.analysis.measures import distance, over_tasks, relative_error, share_correct
from seethrough.analysis.page.blocks import Block, Prose, Section, Table, more, say
from seethrough.analysis.sections.context import Context
from seethrough.analysis.sections.ordinal import friedman_row, friedman_sentence, friedman_table
from seethrough.analysis.sections.tables import cell_table, keep, name_of, of_people
from seethrough.analysis.stats.undefined import is_defined

CELLS_SHOWN = ("task", "transparency", "n", "trials", "mean", "sd", "median")


def error_measures(context: Context, signed: bool = True) -> list[Measure]:
    """Relative count error, combined (mean of the counting tasks) and by task."""
    cells = relative_error(context.trials, signed)
    context.lacking("relative error" if signed else "absolute relative error", cells)
    tasks = cells.factors["task"]
    prefix = "error" if signed else "absolute_error"
    found = []
    if len(tasks) > 1:
        both = over_tasks(cells)
        found.append(measure(f"{prefix}_combined", "T1 + T4", "", 3, both, kind="count_error"))
    found += [
        measure(f"{prefix}_{t}", name_of(t), "", 3, cells, "counting", "count_error", task=t)
        for t in tasks
    ]
    return keep(found)


def measured(key: str, label: str) -> str:
    """What a row of the accuracy tables measures, in words."""
    for start, words in (
        ("error", "relative error"),
        ("absolute_error", "absolute relative error"),
    ):
        if key.startswith(start):
            return f"{words}, {label}"
    return "right answers in T2" if key == "correct_pattern" else label


def accuracy_section(context: Context) -> tuple[Section, list[Table]]:
    """The section, and the tables that the second prediction is answered from."""
    measures = error_measures(context)
    place = distance(context.trials)
    context.lacking("distance", place)
    marks = measure("distance_unique", "T3 distance", "units", 2, place, kind="distance")
    every = keep([*measures, marks])
    blocks: list[Block] = []
    tables: list[Table] = []
    if every:
        note = (
            "Relative error: abs(Σ answer − Σ true) / Σ true over a participant's trials of a "
            "condition, as the paper has it: over- and undercounts cancel."
        )
        tests = _tests("tests_accuracy", "Accuracy, standard against dynamic", note, every, context)
        tables.append(tests)
        blocks += [_sentence(tests, m, context) for m in every]
        blocks += [tests, more(tests, MORE_TITLE, MORE)]
        if measures:
            title = "Relative count error"
            blocks.append(bars_and_differences("errors", title, "relative error", measures, tests))
    absolute = error_measures(context, signed=False)
    if absolute:
        title = "Absolute relative error, in which over- and undercounts do not cancel"
        note = "Σ abs(answer − true) / Σ true over a participant's trials of a condition."
        tests = _tests("tests_absolute_error", title, note, absolute, context)
        tables.append(tests)
        blocks += [*(_sentence(tests, m, context) for m in absolute), tests]
    correct, right = _correct(context)
    blocks += correct
    if not blocks:
        blocks.append(say("Nobody has an accuracy measure under both transparency levels."))
    return Section("accuracy", "Accuracy", tuple(blocks)), [*tables, *([right] if right else [])]


def _tests(key: str, title: str, note: str, measures: Sequence[Measure], context: Context) -> Table:
    return replace(compare(measures, context.plan.margins), key=key, title=title, note=note)


def _sentence(tests: Table, m: Measure, context: Context) -> Prose:
    row = tests.row(m.key)
    what = measured(m.key, m.label)
    if not is_defined(row["F"]):
        return say(
            f"{what[0].upper()}{what[1:]}{{}}: M = {{}} standard, {{}} dynamic; no test: {{}}.",
            of_people(tests, m.key, context),
            tests.cite(m.key, "mean_standard"),
            tests.cite(m.key, "mean_dynamic"),
            tests.cite(m.key, "F"),
        )
    start = say(
        f"{what[0].upper()}{what[1:]}{{}}: M = {{}} (SD = {{}}) standard, {{}} (SD = {{}}) "
        "dynamic, {}.",
        of_people(tests, m.key, context),
        tests.cite(m.key, "mean_standard"),
        tests.cite(m.key, "sd_standard"),
        tests.cite(m.key, "mean_dynamic"),
        tests.cite(m.key, "sd_dynamic"),
        [*apa_f(tests, m.key), *corrected(tests, m.key)],
    )
    p = decisive(row)[1]
    if not is_defined(p) or p < context.plan.alpha:
        return start
    return Prose((*start.runs, *no_difference(tests, m.key, context.plan.alpha)))


def _correct(context: Context) -> tuple[list[Block], Table | None]:
    """Shares of right answers; the blocks, and the table of Friedman's tests."""
    cells = share_correct(context.trials)
    context.lacking("share correct", cells)
    table = cell_table("correct_cells", "Share of right answers", cells, CELLS_SHOWN, kind="bound")
    tasks = cells.factors["task"]
    rows, found = [], []
    for i, task in enumerate(tasks):
        m = measure(f"correct_{task}", name_of(task), "", 3, cells, "tasks", "correct", task=task)
        if m is not None:
            found.append(m)
            rows.append(friedman_row(m, context, 10 + i))
    if not rows:
        return [table], None
    add_holm(rows, found, "p_exact")
    tests = friedman_table("friedman_correct", "Right answers: Friedman tests", rows, True)
    said = [friedman_sentence(tests, str(r["measure"]), _said(r), context) for r in rows]
    return [*said, table, tests], tests


def _said(row: dict[str, object]) -> str:
    return f"Right answers, {row['label']}"
