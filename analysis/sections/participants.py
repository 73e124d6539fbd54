"""Who took part, what is missing or excluded, and how the analysis departs from its plan."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

from seethrough.analysis.exclude import why
from seethrough.analysis.load.study import config_of
from seethrough.analysis.measures import TASK, groups_of, levels_of
from seethrough.analysis.page.blocks import Block, Column, Fold, Prose, Section, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.distributions import detectable, detectable_between
from seethrough.analysis.stats.ranks import sign_test
from seethrough.analysis.stats.undefined import number_in

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
    simulated = "simulated " if context.study.source == "simulated" else ""
    blocks: list[Block] = []
    counts = Table("participants", "Trials per participant", COUNTS, tuple(_counts(context)))
    total = Table(
        "totals",
        "Data",
        (Column("what", "data"), Column("count", "count", "int", "how many")),
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
            f"{{}} {simulated}{'participant has' if people == 1 else 'participants have'} data of "
            "{} "
            "trials; {} count and {} are excluded.",
            total.cite("participants", "count"),
            total.cite("trials recorded", "count"),
            total.cite("trials counted", "count"),
            total.cite("trials excluded", "count"),
        )
    )
    found = reach(context)
    if found is not None:
        blocks += [reach_sentence(found), *groups_sentence(found)]
    counted = [
        total,
        *([found] if found else []),
        _cells(context),
        *([counts] if people <= 200 else []),
    ]
    blocks += [
        *_deviations(context),
        *_excluded(context),
        *_missing(context),
        Fold("Trials by cell and by participant", tuple(counted)),
    ]
    if plan.exclude:
        said = "; ".join(f"{r}: {why(r, plan.too_fast)}" for r in plan.exclude)
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


def _cells(context: Context) -> Table:
    """Trials that count, by task and the factors that vary inside a task; 0 where all that were
    played are left out."""
    design, trials = context.design, context.trials
    names = [TASK, *(f.name for f in (*design.groups, *design.crossed))]
    sizes = trials.groupby(names, observed=True).size()
    known = dict.fromkeys(map(_key, context.study.trials.groupby(names, observed=True).groups), 0)
    known |= {_key(key): int(size) for key, size in sizes.items()}
    levels = levels_of(context.study.trials, (*design.groups, *design.crossed), design.task_names)
    return Table(
        "trials_by_cell",
        f"Trials counted, by {' and '.join(names)}",
        (
            Column("cell", "cell"),
            *(Column(name, name) for name in names),
            Column("trials", "trials", "int"),
        ),
        tuple(
            {
                "cell": "/".join(key),
                **dict(zip(names, (design.task_said(key[0]), *key[1:]), strict=True)),
                "trials": known[key],
            }
            for key in itertools.product(*(levels[name] for name in names))
            if key in known
        ),
        (*names, "trials"),
    )


def _key(group: object) -> tuple[str, ...]:
    """A group's key as pandas gives it."""
    return tuple(str(x) for x in (group if isinstance(group, tuple) else (group,)))


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
    rows = tuple(
        {
            "row_id": e.row_id,
            "participant": e.participant,
            "rule": e.rule,
            "why": why(e.rule, context.plan.too_fast),
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
    unmet = _unmet(context)
    if not rows:
        return unmet or [say("No participant lacks a cell of an analysis.", kind="note")]
    columns = (
        Column("key", "key"),
        Column("where", "left out of"),
        Column("participant", "participant"),
        Column("cells", "missing cells"),
    )
    shown = ("where", "participant", "cells")
    title = "Participants left out for missing cells"
    note = "Left out of what needs the cell, and of nothing else."
    return [*unmet, Table("missing", title, columns, rows, shown, note)]


def _unmet(context: Context) -> list[Block]:
    """What nobody has a counted trial of, though the study plans it (or another level is met)."""
    design = context.design
    there = levels_of(context.trials, design.crossed, design.task_names)
    plans = [config_of(sidecar).get("design") for sidecar in context.study.sidecars.values()]
    plan = next((p for p in plans if isinstance(p, Mapping)), {})
    tasks = plan.get("tasks") or there[TASK]
    levels = [plan.get(f.name) or f.levels for f in design.crossed]
    names = [TASK, *(f.name for f in design.crossed)]
    own = context.trials[names].astype("str").drop_duplicates()
    met = {tuple(row) for row in own.itertuples(index=False)}
    gone = [
        ", ".join((design.task_said(task), *at))
        for task, *at in itertools.product(tasks, *levels)
        if (task, *at) not in met and not design.left_out(dict(zip(names[1:], at, strict=True)))
    ]
    if not gone:
        return []
    return [say(f"Nobody has a trial that counts of: {'; '.join(gone)}.", kind="warning")]


FEW = 10
"""Participants below which the report warns that they are few."""
POWER = 0.80
REACH = (
    Column("what", "what"),
    Column("n", "n", "int"),
    Column("alpha", "α", "bound3"),
    Column("power", "power", "bound2"),
    Column("dz", "d_z", "fixed2", "the smallest that is found so often; of groups d"),
    Column("sign_p", "least p", "p", "of the exact sign test"),
)


def reach(context: Context) -> Table | None:
    """The smallest standardised difference that as many participants find in 80 % of studies."""
    n, alpha = context.people, context.plan.alpha
    if n < 2:
        return None
    row = {"what": "paired test", "n": n, "alpha": alpha, "power": POWER}
    row["dz"], row["sign_p"] = detectable(n, alpha, POWER), sign_test(n, 0)
    rows = (row, *_between(context))
    title = "What so many participants can find"
    note = "d of groups: in units of the spread within a group, taken to be alike." if (
        len(rows) > 1) else ""  # fmt: skip
    return Table("smallest_effect", title, REACH, rows, note=note)


def _between(context: Context) -> list[dict[str, object]]:
    """The same of each level between people against its baseline."""
    names = sorted({str(n) for n in context.study.trials["participant"]})
    rows: list[dict[str, object]] = []
    for factor in context.design.groups:
        own = groups_of(context.study.trials, factor, names)
        for c in factor.contrasts():
            first, second = own.count(c.baseline), own.count(c.level)
            if min(first, second) < 2:
                continue
            found = detectable_between(first, second, context.plan.alpha, POWER)
            rows.append(
                {"what": f"{c.factor}, {c.baseline} − {c.level}", "n": first + second,
                 "alpha": context.plan.alpha, "power": POWER, "dz": found, "sign_p": None}
            )  # fmt: skip
    return rows


def groups_sentence(found: Table) -> list[Prose]:
    """What so few people in each group can find, which is less than within people."""
    return [
        say(
            f"Between groups ({r['what']}) a difference must be as large as d = {{}} to be found "
            "in a share of {} of studies.",
            found.cite(str(r["what"]), "dz"),
            found.cite(str(r["what"]), "power"),
        )
        for r in found.rows[1:]
    ]


def reach_sentence(found: Table) -> Prose:
    """What that means; a warning where the participants are few."""
    key = "paired test"
    cited = [found.cite(key, "n"), found.cite(key, "dz"), found.cite(key, "power")]
    if number_in(found.row(key), "n") >= FEW:
        return say(
            "With {} participants a paired test finds a difference of d_z = {} in a share of {} of "
            "studies, before Holm's correction, and smaller ones less often: no difference shown "
            "is not none.",
            *cited,
        )
    return say(
        "Only {} participants: a difference must be as large as d_z = {} for a paired test to find "
        "it in a share of {} of studies, and an exact sign test reaches p = {} at best. Intervals "
        "and p rest on normal differences, which so few values cannot show: read every number here "
        "as rough.",
        *cited,
        found.cite(key, "sign_p"),
        kind="warning",
    )
