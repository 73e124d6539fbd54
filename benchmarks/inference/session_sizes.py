"""Whole sessions without an effect, for the tests that need trials in their order."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import pandas as pd
from numpy.random import Generator

from seethrough.analysis.before import design_before
from seethrough.analysis.measures import cells_of, over_tasks
from seethrough.analysis.mixed import mixed_model
from seethrough.analysis.stats.paired import Paired, one_sample
from seethrough.analysis.stats.undefined import is_defined
from seethrough.analysis.validity import learning_slopes, order_tests

ORDERS = ((0, 1, 3, 2), (1, 2, 0, 3), (2, 3, 1, 0), (3, 0, 2, 1))  # a Williams square
CONDITIONS = tuple((t, s) for t in ("standard", "dynamic") for s in ("abstract", "walkthrough"))
TASKS = {"abstract": ("count", "pattern"), "walkthrough": ("unique", "count_in_building")}
ALPHA = 0.05
DESIGN = design_before({})
TIME = DESIGN.measures()[0]


@cache
def frame(people: int, scenarios: int, trials: int) -> pd.DataFrame:
    """The trials of `people` in their order, without times."""
    rows = []
    for p in range(people):
        order = [i for i in ORDERS[p % 4] if CONDITIONS[i][1] in tuple(TASKS)[:scenarios]]
        for block, index in enumerate(order, start=1):
            level, scenario = CONDITIONS[index]
            for task in TASKS[scenario]:
                rows += [(f"p{p:02d}", 1, block, f"{block}{task}", k, level, scenario, task)
                         for k in range(trials)]  # fmt: skip
    names = "participant session block task_set trial_in_set transparency scenario task".split()
    return pd.DataFrame(rows, columns=names)


def timed(rng: Generator, table: pd.DataFrame) -> pd.DataFrame:
    """With log-normal times: people, their tasks and their effects differ, the technique has none.

    Period, carry-over, order and practice have none either.
    """
    person = np.unique(table["participant"], return_inverse=True)[1]
    task = np.unique(table["task"], return_inverse=True)[1]
    dynamic = (table["transparency"] == "dynamic").to_numpy(float) - 0.5
    people, tasks = person.max() + 1, task.max() + 1
    y = 3 + rng.normal(0, 0.4, people)[person] + rng.normal(0, 0.2, (people, tasks))[person, task]
    y += dynamic * rng.normal(0, 0.2, people)[person]
    y += dynamic * rng.normal(0, 0.2, (people, tasks))[person, task]
    return table.assign(time=np.exp(y + rng.normal(0, 0.4, len(table))))


def sessions(rng: Generator) -> Mapping[str, bool | None]:
    """Order tests, learning, and the log ratio over all tasks, of 16 people."""
    table = timed(rng, frame(16, 2, 3))
    found = {t.name: bool(t.p < ALPHA) if is_defined(t.p) else None
             for t in order_tests(table, DESIGN)}  # fmt: skip
    slope = one_sample(learning_slopes(table))
    cells = over_tasks(cells_of(table, DESIGN, TIME, log=True)).values
    ratio = one_sample(cells[:, 0] - cells[:, 1])
    return {
        **found,
        "learning": _found(slope),
        "interval of learning": _held(slope, 0),
        "F of log times": _found(ratio),
        "interval of a log ratio": _held(ratio, 0),
    }


def _found(test: Paired) -> bool:
    assert is_defined(test.p)
    return bool(test.p < ALPHA)


def _held(test: Paired, value: float) -> bool:
    low, high = test.interval
    assert is_defined(low) and is_defined(high)
    return bool(low <= value <= high)


def mixed_sessions(rng: Generator) -> Mapping[str, bool | None]:
    """The mixed model, of 12 people with two tasks."""
    fit = mixed_model(timed(rng, frame(12, 1, 2)), DESIGN)[0]
    if not is_defined(fit.p):
        return {"mixed model": None, "interval, mixed model": None}
    low, high = fit.interval
    assert is_defined(low) and is_defined(high)
    return {"mixed model": fit.p < ALPHA, "interval, mixed model": bool(low <= 1 <= high)}
