"""Tasks of a study that its tables and report could not tell apart: codes, columns of measures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from seethrough.experiment.errors import shown
from seethrough.experiment.record.columns import RESERVED
from seethrough.experiment.study.study import Study
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome
from seethrough.tasks.kit.measure import CONFIDENCE, Measure

# What an outcome has a field for has a column for any task.
ANY_TASKS = {field.name for field in fields(Outcome)}


def clashing_tasks(study: Study) -> Iterator[str]:
    """A line for each task that has another's code, or a measure whose column is something else's.

    Only who begins with a study asks: sessions that were played so are replayed as they were.
    """
    codes: dict[str, str] = {}
    known: dict[str, tuple[str, Measure]] = {}
    taken = dict.fromkeys({*RESERVED} - ANY_TASKS, "a column of every study")
    taken |= {factor.name: "a factor" for factor in study.factors}
    for task in study.tasks():
        where, own = f"design.tasks = {shown(task)}", TASKS[task]
        first = codes.setdefault(own.code, task)
        if first != task:
            yield f"{where}: expected a code of its own, {own.code} is that of {first}"
        asked = any(part.task_options.of(task).confidence for part in study.parts.values())
        sure = {CONFIDENCE.name: "what [task] confidence asks for"} if asked else {}
        for measure in own.measures:
            if said := (taken | sure).get(measure.name):
                yield f"{where}: expected another name for its measure {measure.name}, it is {said}"
            other, same = known.setdefault(measure.name, (task, measure))
            if _kept(measure) != _kept(same):
                yield f"{where}: expected the measure {measure.name} to be what it is of {other}"


def _kept(measure: Measure) -> tuple[str, ...]:
    """What a column can be only one of."""
    return measure.unit, measure.direction, measure.scale, measure.of
