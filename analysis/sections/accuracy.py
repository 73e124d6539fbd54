"""Accuracy: counting errors (T1, T4), patterns found (T2), marks on the plan (T3)."""

from __future__ import annotations

from dataclasses import replace

from analysis.comparison import MORE, MORE_TITLE, Measure, apa_f, compare, measure
from analysis.figures.comparison import bars_and_differences
from analysis.measures import distance, over_tasks, relative_error, share_correct
from analysis.page.blocks import Block, Prose, Section, Table, more, say
from analysis.plan import Plan
from analysis.sections.context import Context
from analysis.sections.ordinal import friedman_row, friedman_sentence, friedman_table
from analysis.sections.tables import cell_table, keep, missing_note, name_of
from analysis.stats.undefined import is_defined

CELLS_SHOWN = ("task", "transparency", "n", "trials", "mean", "sd", "median")


def error_measures(context: Context, signed: bool = True) -> list[Measure]:
    """Relative count error, combined (mean of the counting tasks) and by task."""
    cells = relative_error(context.trials, signed)
    context.missing["relative error" if signed else "absolute relative error"] = cells.missing
    tasks = cells.factors["task"]
    prefix = "error" if signed else "absolute_error"
    found = []
    if len(tasks) > 1:
        found.append(measure(f"{prefix}_combined", "T1 + T4", "", 3, over_tasks(cells)))
    found += [measure(f"{prefix}_{t}", name_of(t), "", 3, cells, "counting", task=t) for t in tasks]
    return keep(found)


def accuracy_section(context: Context) -> tuple[Section, Table | None]:
    """The section, and the table of its tests."""
    measures = error_measures(context)
    place = distance(context.trials)
    context.missing["distance"] = place.missing
    mark = measure("distance_unique", "T3 distance", "units", 2, place)
    every = keep([*measures, mark])
    blocks: list[Block] = []
    tests = None
    if every:
        tests = replace(
            compare(every, context.plan.margin),
            key="tests_accuracy",
            title="Accuracy, standard against dynamic",
        )
        blocks += [_sentence(tests, m, context.plan) for m in every]
        blocks += [tests, more(tests, MORE_TITLE, MORE)]
    if measures and tests:
        blocks.append(
            bars_and_differences(
                "errors", "Relative count error", "relative error", measures, tests
            )
        )
    blocks += [*_correct(context), *missing_note(place.missing)]
    absolute = error_measures(context, signed=False)
    if absolute:
        blocks.append(
            replace(
                compare(absolute, context.plan.margin),
                key="tests_absolute_error",
                title="Absolute relative error, in which over- and undercounts do not cancel",
            )
        )
    if not blocks:
        blocks.append(say("Nobody has an accuracy measure under both transparency levels."))
    return Section("accuracy", "Accuracy", tuple(blocks)), tests


def _sentence(tests: Table, m: Measure, plan: Plan) -> Prose:
    row = tests.row(m.key)
    what = f"Relative error, {m.label}" if m.key.startswith("error") else "T3, distance to target"
    start = say(
        f"{what}: M = {{}} (s.d. {{}}) standard, {{}} (s.d. {{}}) dynamic, {{}}.",
        tests.cite(m.key, "mean_standard"),
        tests.cite(m.key, "sd_standard"),
        tests.cite(m.key, "mean_dynamic"),
        tests.cite(m.key, "sd_dynamic"),
        apa_f(tests, m.key),
    )
    if not is_defined(row["p"]) or row["p"] < plan.alpha or not is_defined(row["tost_p"]):
        return start
    inside = row["tost_p"] < plan.alpha
    verdict = (
        "so the two are equivalent within that margin"
        if inside
        else "so this is no evidence of equality either"
    )
    p = tests.cite(m.key, "tost_p")
    end = say(
        f" No difference was shown; equivalence within ± {{}} (20 % of the standard mean): "
        f"p {'' if p.text.startswith('<') else '= '}{{}}, {verdict}.",
        tests.cite(m.key, "tost_margin"),
        p,
    )
    return Prose((*start.runs, *end.runs))


def _correct(context: Context) -> list[Block]:
    cells = share_correct(context.trials)
    context.missing["share correct"] = cells.missing
    table = cell_table("correct_cells", "Share of right answers", cells, CELLS_SHOWN)
    tasks = cells.factors["task"]
    rows = []
    for i, task in enumerate(tasks):
        m = measure(f"correct_{task}", name_of(task), "", 3, cells, task=task)
        if m is not None:
            rows.append(friedman_row(m, context, 10 + i))
    if not rows:
        return [table]
    tests = friedman_table("friedman_correct", "Right answers: Friedman tests", rows)
    return [*(friedman_sentence(tests, str(r["measure"]), _said(r)) for r in rows), table, tests]


def _said(row: dict[str, object]) -> str:
    return f"Right answers, {row['label']}"
