"""What a sidecar says of the design: enough to analyse the data without the program."""

from __future__ import annotations

from typing import Any

from seethrough.experiment.study.factors import Factor
from seethrough.experiment.study.study import Study
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.measure import TIME


def design_entry(study: Study) -> dict[str, Any]:
    """Factors with their levels in order, cells left out, tasks with what they measure, what is
    expected; plain JSON types."""
    analysis = study.resolved()["analysis"]
    margins = {k: v for k, v in analysis["margins"].items() if v is not None}
    return {
        "factors": [_factor(study, factor) for factor in study.factors],
        "excluded": [dict(levels) for levels in study.excluded],
        "tasks": [_task(task, margins) for task in study.tasks()],
        "predictions": [
            {k: v for k, v in said.items() if v not in (None, "")}
            for said in analysis["predictions"]
        ],
    }


def _factor(study: Study, factor: Factor) -> dict[str, Any]:
    """The factor; `tasks` of each level where levels bring their own."""
    at = study.factors.index(factor)
    tasks: dict[str, list[str]] = {name: [] for name in factor.names}
    for cell, part in study.parts.items():
        own = tasks[cell[at]]
        own += [task for task in part.design.tasks if task not in own]
    said = {**factor.described(), "order": factor.order or study.design.order}
    if any(own != tasks[factor.names[0]] for own in tasks.values()):
        said["tasks"] = tasks
    return said


def _task(name: str, margins: dict[str, float]) -> dict[str, Any]:
    task = TASKS[name]
    measures = [measure.as_dict() for measure in (TIME, *task.measures)]
    for measure in measures:
        measure["margin"] = margins.get(measure["name"], measure["margin"])
    return {"name": name, "code": task.code, "measures": measures}
