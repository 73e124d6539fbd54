"""What `check --balance` counts: the finished tables of N sessions, played through the session's
own code by somebody who answers at once, without pictures or eyes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from seethrough.experiment.ledger.ledger_slots import Places, next_slot
from seethrough.experiment.record.recorder import trial_row
from seethrough.experiment.study.design.balance import Met, counted, cycle, repeated
from seethrough.experiment.study.design.design import ORDERS, Design, generator
from seethrough.experiment.study.study import Study

DROPPED = 0.2  # share of people who leave and are replaced


@dataclass(frozen=True)
class Verdict:
    """What was found of a group: counts that are not as promised, in words; and how far rows differ
    in between."""

    group: str
    people: int
    kept: tuple[str, ...]
    broken: tuple[str, ...] = field(default=())


def table_of(study: Study, slots: Iterable[int]) -> list[Met]:
    """The trial tables of these slots' sessions, as the recorder writes them."""
    from seethrough.experiment.session.answering import played

    names = study.plan.names
    found = []
    for slot in slots:
        for trial in (trial_row(record) for record in played(study, slot)):
            levels = {name: str(trial[name]) for name in names}
            block = int(str(trial["block"]))
            found.append(Met(slot, block, levels, str(trial["task"]), str(trial["scene"])))
    return found


def refilled(design: Design, count: int, seed: int) -> list[int]:
    """The slots of so many complete sessions where a fifth of all who began dropped out."""
    rng = generator(seed, (ORDERS, 0, count))
    places = [
        Places(design.rows(which), group.people, group.levels)
        for which, group in enumerate(design.groups)
    ]
    done: set[int] = set()
    while len(done) < count:
        slot = next_slot((), done, places)
        assert slot is not None, "whole rounds open past the target"
        if rng.random() >= DROPPED:
            done.add(slot)
    return sorted(done)


def verdicts(study: Study, met: Sequence[Met], slots: Sequence[int]) -> list[Verdict]:
    """What holds of each group."""
    design, twice = study.plan, repeated(study.plan, met)
    counts = counted(design, met)
    found = []
    for which, group in enumerate(design.groups):
        numbers = [n for s in slots for g, n in [design.group_of(s)] if g == which]
        whole = bool(numbers) and sorted(numbers) == list(range(1, len(numbers) + 1)) and (
            len(numbers) % cycle(design, which) == 0
        )  # fmt: skip
        own = [c for c in counts if c.group == which]
        rows = np.bincount([(n - 1) % design.rows(which) for n in numbers],
                           minlength=design.rows(which))  # fmt: skip
        broken = [f"rows differ by {np.ptp(rows)}"] if np.ptp(rows) > 1 else []
        broken += [f"{c.what} {c.where}: differs by {c.uneven}".replace(" :", ":")
                   for c in own if whole and c.uneven]  # fmt: skip
        broken += twice
        summary: dict[str, int] = {}
        for c in own:
            summary[c.what] = max(summary.get(c.what, 0), c.uneven)
        kept = [f"{what} {'even' if not n else f'within {n}'}" for what, n in summary.items()]
        kept += [f"rows within {np.ptp(rows)}"]
        name = "/".join(group.levels.values()) or "everybody"
        found.append(Verdict(name, len(numbers), tuple(kept), tuple(broken)))
    return found
