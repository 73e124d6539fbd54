"""Who took part, what is missing or excluded, and how the analysis departs from its plan."""

from __future__ import annotations

import pandas as pd

from analysis.exclude import REPEATED, RULES
from analysis.measures import design
from analysis.page.blocks import Block, Column, Fold, Prose, Section, Table, say
from analysis.sections.context import Context
from analysis.sections.tables import name_of

COUNTS = (
    Column("participant", "participant"),
    Column("slot", "slot", "int"),
    Column("trials", "trials recorded", "int"),
    Column("counted", "trials counted", "int"),
)


def participants_section(context: Context) -> Section:
    """Counts, exclusions by rule and row, deviations from the frozen plan."""
    trials, plan = context.study.trials, context.plan
    people = trials["participant"].nunique()
    blocks: list[Block] = []
    counts = Table("participants", "Trials per participant", COUNTS, tuple(_counts(context)))
    total = Table(
        "totals",
        "Data",
        (Column("what", "data"), Column("count", "count", "int")),
        (
            {"what": "participants", "count": people},
            {"what": "trials recorded", "count": len(trials)},
            {"what": "trials counted", "count": len(context.trials)},
            {"what": "trials excluded", "count": len(context.excluded)},
            {"what": "questionnaire rows", "count": len(context.study.questionnaire)},
        ),
    )
    blocks.append(
        say(
            "{} participants completed {} trials; {} count and {} are excluded.",
            total.cite("participants", "count"),
            total.cite("trials recorded", "count"),
            total.cite("trials counted", "count"),
            total.cite("trials excluded", "count"),
        )
    )
    counted = [total, _cells(context.trials), *([counts] if people <= 200 else [])]
    blocks += [
        *_deviations(context),
        *_excluded(context),
        *_missing(context),
        Fold("Trials by cell and by participant", tuple(counted)),
    ]
    if plan.exclude:
        said = "; ".join(f"{r}: {RULES[r][0] if r in RULES else 'by name'}" for r in plan.exclude)
        blocks.append(say(f"Exclusion rules: {said}.", kind="note"))
    return Section("participants", "Participants and data", tuple(blocks))


def _counts(context: Context) -> list[dict[str, object]]:
    recorded = context.study.trials.groupby("participant", observed=True)
    counted = context.trials.groupby("participant", observed=True).size()
    slots = recorded["slot"].first()
    return [
        {
            "participant": str(name),
            "slot": int(slots[name]),
            "trials": int(size),
            "counted": int(counted.get(name, 0)),
        }
        for name, size in recorded.size().items()
    ]


def _cells(trials: pd.DataFrame) -> Table:
    sizes = trials.groupby(["task", "transparency"], observed=True).size()
    levels = design(trials)
    order = [(t, c) for t in levels["task"] for c in levels["transparency"] if (t, c) in sizes]
    return Table(
        "trials_by_cell",
        "Trials counted, by task and transparency",
        (
            Column("cell", "cell"),
            Column("task", "task"),
            Column("transparency", "transparency"),
            Column("trials", "trials", "int"),
        ),
        tuple(
            {
                "cell": f"{t}/{c}",
                "task": name_of(t),
                "transparency": c,
                "trials": int(sizes[t, c]),
            }
            for t, c in order
        ),
        ("task", "transparency", "trials"),
    )


def _deviations(context: Context) -> list[Prose]:
    plan = context.plan
    if plan.frozen is None:
        return [
            say(
                "The study froze no analysis plan before collection: the defaults ran.", kind="note"
            )
        ]
    if not plan.deviations:
        return [say("The analysis follows the plan that the study's config froze.", kind="note")]
    return [
        say(f"Deviation from the frozen plan: {line}", kind="warning") for line in plan.deviations
    ]


def _excluded(context: Context) -> list[Block]:
    if not context.excluded:
        return []
    said = {REPEATED: "a later attempt replaced it", **{k: v[0] for k, v in RULES.items()}}
    rows = tuple(
        {
            "row_id": e.row_id,
            "participant": e.participant,
            "rule": e.rule,
            "why": said.get(e.rule, "left out by name"),
            "file": e.file,
            "row": e.row,
        }
        for e in context.excluded
    )
    columns = (
        Column("row_id", "row id"),
        Column("participant", "participant"),
        Column("rule", "rule"),
        Column("why", "why"),
        Column("file", "file"),
        Column("row", "row", "int"),
    )
    return [Table("excluded", "Excluded trials, by rule and row", columns, rows)]


def _missing(context: Context) -> list[Block]:
    """Who lacks a cell that an analysis needs: left out of that analysis, and named."""
    rows = tuple(
        {
            "key": f"{where}/{m.participant}",
            "where": where,
            "participant": m.participant,
            "cells": "; ".join(m.cells),
        }
        for where, missing in context.missing.items()
        for m in missing
    )
    if not rows:
        return [say("No participant lacks a cell of an analysis.", kind="note")]
    columns = (
        Column("key", "key"),
        Column("where", "left out of"),
        Column("participant", "participant"),
        Column("cells", "missing cells"),
    )
    shown = ("where", "participant", "cells")
    return [Table("missing", "Participants left out for missing cells", columns, rows, shown)]
