"""A paragraph of methods, as a paper has it: what the data and their sidecars say, and no more."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from seethrough.analysis.design import Factor
from seethrough.analysis.load.plan import digest
from seethrough.analysis.load.study import config_of
from seethrough.analysis.measures import answers, cells_of, groups_of
from seethrough.analysis.page.blocks import Block, Column, Prose, Section, Table, say
from seethrough.analysis.page.numbers import fixed
from seethrough.analysis.sections.base.context import Context

AGE, GENDER = "age", "gender"
"""Items of the session's own page of demographics."""
FLOW = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("rows", "rows used"),
    Column("recorded", "trials recorded", "int", "of its tasks"),
    Column("counted", "that count", "int"),
    Column("used", "with a value", "int", "that enter its cells"),
    Column("people", "participants", "int", "with any value"),
    Column("complete", "complete", "int", "with every cell"),
)
SAID = {"all": "all trials", "right": "trials answered right"}


def methods_section(context: Context) -> Section:
    """Participants, design, apparatus and analysis; and which trials each measure used."""
    paragraphs = [_participants(context), _design(context), _apparatus(context), _analysis(context)]
    blocks: list[Block] = [p for p in paragraphs if p is not None]
    return Section("methods", "Method", (*blocks, _flow(context)))


def _participants(context: Context) -> Prose:
    simulated = context.study.source == "simulated"
    words = "simulated participants, who are no people" if simulated else "participants"
    if context.people == 1:
        words = words.replace("participants, who are no people", "participant, who is nobody")
        words = words.removesuffix("s") if not simulated else words
    said = f"{context.people} {words}"
    groups = [_group(context, f) for f in context.design.groups]
    if groups:
        said += f" ({'; '.join(groups)})"
    asked = context.study.questionnaire
    ages = answers(asked, AGE) if len(asked) else np.empty(0)
    if len(ages):
        spread = f", SD = {fixed(float(np.std(ages, ddof=1)), 1)}" if len(ages) > 1 else ""
        said += (
            f", aged {ages.min():g} to {ages.max():g} (M = {fixed(float(ages.mean()), 1)}{spread}"
        )
        said += f", n = {len(ages)})"
    genders = asked.loc[asked["item"] == GENDER, "text"].astype("str") if len(asked) else None
    if genders is not None and len(genders):
        counts = genders.value_counts()
        said += f"; gender as they gave it: {', '.join(f'{k} {v}' for k, v in counts.items())}"
    return say(f"Participants: {said}.")


def _group(context: Context, factor: Factor) -> str:
    """`training: none 9, criterion 5`."""
    names = sorted({str(n) for n in context.study.trials["participant"]})
    own = groups_of(context.study.trials, factor, names)
    sizes = ", ".join(f"{level} {own.count(level)}" for level in factor.levels)
    how = "brought along" if factor.kind == "measured" else "assigned"
    return f"{factor.name}, {how}: {sizes}"


def _design(context: Context) -> Prose:
    design = context.design
    parts = []
    for factor in design.factors:
        kind = {"within": "within participants", "between": "between participants",
                "measured": "between participants, not assigned"}[factor.kind]  # fmt: skip
        order = f", order {factor.order}" if factor.order and factor.within else ""
        parts.append(f"{factor.name} ({', '.join(factor.levels)}; {kind}{order})")
    left = [" × ".join(cell.values()) for cell in design.excluded]
    out = f" Left out for everybody: {'; '.join(left)}." if left else ""
    met = {str(t) for t in context.study.trials["task"]}
    tasks = ", ".join(t.said for t in design.tasks if t.name in met)
    each = context.study.trials.drop_duplicates(["participant", "trial"]).groupby(
        "participant", observed=True).size()  # fmt: skip
    span = f"{each.min()}" if each.min() == each.max() else f"{each.min()} to {each.max()}"
    what = "; ".join(parts) or "no factor"
    rule = f" Scenes selected: {design.selected}." if design.selected else ""
    said = f"{what}.{out}{rule} Tasks: {tasks}; {span} trials a participant."
    return say("Design: {}", said)  # a rule is the researcher's own words, braces included


def _apparatus(context: Context) -> Prose | None:
    """What the sessions' sidecars say of machine, display and program."""
    made = [s.get("provenance") for s in context.study.sidecars.values()]
    known = [m for m in made if isinstance(m, Mapping)]
    display = [m["display"] for m in known if isinstance(m.get("display"), Mapping)]
    parts = [
        ("window", _once(d.get("size") for d in display)),
        ("refresh", _once(d.get("refresh_declared") for d in display)),
        ("graphics", _once(d.get("renderer") for d in display)),
        ("system", _once(m.get("system") for m in known)),
        ("Seethrough", _once((m.get("versions") or {}).get("seethrough") for m in known)),
    ]
    said = "; ".join(f"{name} {value}" for name, value in parts if value)
    return say(f"Apparatus, as the sessions recorded it: {said}.") if said else None


def _once(values: Iterable[object]) -> str:
    """The distinct values, the first three."""
    return " or ".join(sorted({str(v) for v in values if v})[:3])


def _analysis(context: Context) -> Prose:
    plan = context.plan
    configs = [config_of(s) for s in context.study.sidecars.values()]
    hashes = sorted({digest(c) for c in configs if c})
    rules = f"exclusion rules {', '.join(plan.exclude)}" if plan.exclude else "no exclusion rule"
    number = len(context.design.predictions)
    stated = {0: "no prediction", 1: "1 prediction"}.get(number, f"{number} predictions")
    frozen = "was frozen in the study" if plan.frozen is not None else "is the default"
    named = f" (hash of the study as it ran: {', '.join(hashes)})" if hashes else ""
    gone = len(context.excluded)
    out = f"{gone or 'no'} {'trial was' if gone == 1 else 'trials were'} excluded"
    return say(
        f"Analysis: the plan {frozen}{named}: α = {plan.alpha:g}, {rules}, {stated}; {out}. Type "
        "III analysis of variance with Greenhouse and Geisser's correction; contrasts with their "
        "own error, corrected by Holm within a measure and factor; analysis.R has the same in R."
    )


def _flow(context: Context) -> Table:
    """From recorded trials to each measure's cells."""
    design, recorded, counted = context.design, context.study.trials, context.trials
    rows = []
    for m in design.measures():
        tasks = list(design.tasks_with(m.name))
        own = counted[counted["task"].isin(tasks)]
        cells = cells_of(counted, design, m)
        there = np.isfinite(cells.values.reshape(len(cells.values), -1))
        met = there.any(axis=0)
        rows.append(
            {
                "measure": m.name,
                "label": m.said,
                "rows": SAID[m.rows],
                "recorded": int(recorded["task"].isin(tasks).sum()),
                "counted": len(own),
                "used": int(cells.counts.sum()),
                "people": int(there.any(axis=1).sum()),
                "complete": int(there[:, met].all(axis=1).sum()) if met.any() else 0,
            }
        )
    return Table("flow", "Trials that each measure used", FLOW, tuple(rows),
                 tuple("label rows recorded counted used people complete".split()))  # fmt: skip
