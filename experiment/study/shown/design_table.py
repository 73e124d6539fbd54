"""A study's design as tables and lines: what is worked out from its file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from seethrough.experiment.study.design.balance import cycle
from seethrough.experiment.study.design.design import TaskSet, Trial, session_for
from seethrough.experiment.study.design.factors import CHANGED, WITHIN, Factor
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.cells import every_combination
from seethrough.experiment.study.tables.merge import leaves

PACE = 45.0  # s of a trial, pages not counted, where nobody has been timed yet [ours]
PAGES = 600.0  # s of pages and instructions of a session [ours]
MOST = 24  # lines of cells or orders; more are counted


def columns_of(study: Study) -> list[str]:
    """The columns of the table of trials."""
    return ["slot", "group", "trial", "block", "task_set", "trial_in_set", *study.plan.names,
            "world", "task", "scene"]  # fmt: skip


def rows_of(study: Study, count: int) -> Iterator[list[object]]:
    """A row for each trial of the first people."""
    plan = study.plan
    for slot in plan.slots(count):
        which, _ = plan.group_of(slot)
        group = "/".join(plan.groups[which].levels.values())
        for task_set in session_for(slot, plan):
            for t in task_set.trials:
                yield [slot, group, t.number, t.block, t.task_set, t.in_set, *t.levels.values(),
                       t.world, t.task, t.scene]  # fmt: skip


def lines_of(study: Study, count: int) -> list[str]:
    """The design for who plans the study."""
    plan = study.plan
    lines = [f"study      {study.general.name}: {count} people, seed {plan.seed}"]
    lines += [line for factor in study.factors for line in _factor(factor, study)]
    gone = every_combination(study.factors) - len(plan.cells)
    which_gone = "; ".join("/".join(left.values()) for left in study.excluded)
    said = f", {gone} left out: {which_gone}" if gone else ""
    lines.append(f"cells      {len(plan.cells)}{said}")
    lines += _short(["/".join(cell) or "(one)" for cell in plan.cells])
    for which in range(len(plan.groups)):
        lines += _group(study, which)
    return lines


def _factor(factor: Factor, study: Study) -> list[str]:
    how = factor.kind + (f", {factor.order}" if factor.order else "")
    scenes = "changes scenes" if factor.scenes == CHANGED else "leaves scenes alone"
    people = f", people {list(factor.people)}" if factor.people else ""
    head = f"factor     {factor.name}: {how}, {scenes}{people}; baseline {factor.baseline}"
    sets = [
        f"             {level.name}: "
        + (", ".join(f"{'.'.join(p)} = {v}" for p, v in leaves(level.part)) or "nothing is set")
        for level in factor.levels
    ]
    return [head, *sets]


def _short(names: Sequence[str]) -> list[str]:
    shown = [f"             {name}" for name in names[:MOST]]
    return shown + [f"             … and {len(names) - MOST} more"] * (len(names) > MOST)


def _group(study: Study, which: int) -> list[str]:
    plan = study.plan
    group = plan.groups[which]
    name = "/".join(group.levels.values())
    session = session_for(plan.slot_of(which, 1), plan)
    trials = [t for s in session for t in s.trials]
    training = [t for s in session for t in s.training]
    practice = len(training)
    least = "up to " if any(study.part(t.levels).practice.until for t in training) else ""
    amount = f"{len(trials)} trials and {least}{practice} to practise"
    orders = dict.fromkeys(
        " → ".join(conditions_of(study, session_for(plan.slot_of(which, n), plan)))
        for n in range(1, min(plan.rows(which), MOST + 1) + 1)
    )
    said = f"{len(plan.conditions(which))} conditions, {plan.rows(which)} orders"
    tasks = dict.fromkeys(t.task for t in trials)
    return [
        f"group      {name or 'everybody'}: {group.people} people, {said}; all that is promised "
        f"is even after {cycle(plan, which)} people",
        *_short(list(orders)),
        f"           {len(session)} task sets, {amount}: {', '.join(tasks)}",
        f"items      {_items(trials)}",
        f"minutes    about {minutes(len(trials), practice):.0f} a session, if a trial takes "
        f"{PACE:g} s; the limit is {study.session.limit / 60:.0f}",
    ]


def minutes(trials: int, practice: int) -> float:
    """What a session may take; a dry run (`simulate`) says it better."""
    return (PAGES + (trials + practice) * PACE) / 60


def _items(trials: Sequence[Trial]) -> str:
    shared = sorted({t.scene for t in trials if not t.scene.startswith("stream-")})
    own = len({t.scene for t in trials if t.scene.startswith("stream-")})
    if not shared:
        return f"{own} scenes of each person's own"
    first = ", ".join(shared[:4]) + (" …" if len(shared) > 4 else "")
    return f"{len(shared)} that everybody meets ({first}), {own} of each person's own"


def conditions_of(study: Study, session: Sequence[TaskSet]) -> list[str]:
    """The conditions of a session in its order, as standard/abstract."""
    names = [f.name for f in study.factors if f.kind == WITHIN and not f.mixed]
    found: dict[int, Mapping[str, str]] = {s.trials[0].block: s.trials[0].levels for s in session}
    return ["/".join(levels[n] for n in names) or "(one)" for levels in found.values()]
