"""What `check` says of a design: how even it is, as planned and as played."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial

from seethrough.experiment.errors import InputError
from seethrough.experiment.session.levels import of_blocks
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import TaskSet, session_for
from seethrough.experiment.study.shown.design_table import minutes
from seethrough.experiment.verdicts import FAILS, WARNING, Verdicts

MOST_PLAYED = 5_000  # sessions
MOST_ORDERS = 64  # more than a square of the conditions that there can be has rows


def check_design(study: Study, said: Verdicts) -> None:
    """How even the design is for each group, and whether its people fill it."""
    plan = study.plan
    for which, group in enumerate(plan.groups):
        name = "/".join(group.levels.values())
        sessions = [session_for(plan.slot_of(which, n), plan) for n in range(1, group.people + 1)]
        per_session = sum(len(s.trials) for s in sessions[0])
        total, where = group.people * per_session, f"{name}: " if name else ""
        text = f"{where}{group.people} participants × {per_session} trials = {total} trials"
        took = minutes(per_session, sum(len(s.training) for s in sessions[0]))
        most = study.session.limit / 60
        long = [WARNING, f"some {took:.0f} minutes, expected at most session.limit ({most:g})"]
        said.say("design", text, *(long if 0 < most < took else []))
        rows = Counter(map(partial(_conditions, study), sessions))
        for order, number in sorted(rows.items())[:MOST_ORDERS]:
            said.say("design", f"{where}{number} × {' → '.join(order)}")
        if len(rows) > MOST_ORDERS:
            said.say("design", f"{where}… and {len(rows) - MOST_ORDERS} orders more")
        wanted = plan.rows(which)
        uneven = group.people % wanted
        if "random" in (study.design.order, *(f.order for f in study.factors)):
            said.say("design", f"{where}orders are drawn: nothing is promised of them")
        elif not uneven:
            said.say("design", f"{where}each order equally often")
        else:
            why = f"expected a multiple of {wanted} participants"
            said.say("design", f"{where}the orders are not equally often", WARNING, why)


def check_balance(study: Study, count: int | None, said: Verdicts) -> None:
    """Counted from finished tables: after so many people, and where a fifth of them dropped out."""
    from seethrough.experiment.session.balance_check import refilled, table_of, verdicts
    from seethrough.experiment.study.design.balance import cycle

    plan = study.plan
    if count is not None and count < 1:
        raise InputError(f"--slots = {count}: expected at least 1")
    longest = max(cycle(plan, which) for which in range(len(plan.groups)))
    cycles = [plan.slot_of(g, n) for g in range(len(plan.groups))
              for n in range(1, cycle(plan, g) + 1)]  # fmt: skip
    slots = sorted(cycles) if count is None else plan.slots(count)
    if len(slots) > MOST_PLAYED:
        raise InputError(
            f"--slots: missing, expected at most {MOST_PLAYED}: a complete cycle is {longest} "
            "people of each group"
        )
    again = refilled(plan, len(slots), study.general.seed)
    for what, played in (("as they come", slots), ("after drop-outs", again)):
        for found in verdicts(study, table_of(study, played), played):
            text = f"{found.group}, {what}: {found.people} people, {', '.join(found.kept)}"
            why = "; ".join(found.broken[:3])
            said.say("balance", text, *([FAILS, why] if found.broken else []))


def _conditions(study: Study, session: Sequence[TaskSet]) -> tuple[str, ...]:
    """The conditions of a session in its order, as standard/abstract."""
    blocks = {
        s.trials[0].block: "/".join(level for _, level in of_blocks(study, s.trials[0].levels))
        for s in session
    }
    return tuple(blocks.values())
