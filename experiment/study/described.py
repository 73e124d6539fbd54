"""What a sidecar says of the design: enough to analyse the data without the program."""

from __future__ import annotations

import re
from typing import Any

from seethrough.experiment.questions.ready import question
from seethrough.experiment.study.factors import ALONE, Factor
from seethrough.experiment.study.reading import STARTS, Question
from seethrough.experiment.study.study import Study
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.measure import CONFIDENCE, TIME


def design_entry(study: Study) -> dict[str, Any]:
    """Factors with their levels in order, cells left out, tasks with what they measure, what is
    expected; plain JSON types."""
    analysis = study.resolved()["analysis"]
    margins = {k: v for k, v in analysis["margins"].items() if v is not None}
    return {
        "factors": [_factor(study, factor) for factor in study.factors],
        "excluded": [dict(levels) for levels in study.excluded],
        "tasks": [_task(study, task, margins) for task in study.tasks()],
        "predictions": [
            {k: v for k, v in said.items() if v not in (None, "")}
            for said in analysis["predictions"]
        ],
        "items": [item for name, asked in study.questions.items()
                  for item in _items(study, name, asked)],
    }  # fmt: skip


def each_of(study: Study, asked: Question) -> tuple[str, ...]:
    """The factors for each of whose levels a question is asked once."""
    if asked.table.each is not None:
        return asked.table.each
    if asked.when_asked in ("task_set", "condition"):
        return tuple(f.name for f in study.factors if f.block)
    if asked.when_asked == "trial":
        return tuple(f.name for f in study.factors if f.block or f.mixed)
    if asked.use == "ratings":
        return tuple(f.name for f in study.factors if f.block)
    if asked.use in ("tlx", "sus"):
        return tuple(f.name for f in study.factors if f.block and f.scenes == ALONE)
    return ()


def _items(study: Study, name: str, asked: Question) -> list[dict[str, Any]]:
    """A question's items, but of what is asked at the start: for which levels, together with which,
    of how many points. Where one has the question's own name, it is made of the others."""
    if asked.use in STARTS:
        return []
    said = question(asked.use).items(asked.parameters, name)
    known = {name: said[name]} if name in said else said
    each = list(each_of(study, asked))
    compared = asked.table.of or next((f.name for f in study.factors if f.block), "")
    items = []
    for item, words in known.items():
        scale = re.search(r"\((-?\d+)–(-?\d+)\)$", words)
        low, high = (int(scale[1]), int(scale[2])) if scale else (0, 0)
        items.append({
            "name": item,
            "label": item.replace("_", " "),
            "each": each,
            "group": name if each and len(known) > 1 else "",
            "of": compared if asked.use == "comparison" and item == "preference" else "",
            **({"points": high - low + 1} if scale else {}),
            **({"low": low} if low else {}),
            **({"against": True} if item in getattr(asked.parameters, "reverse", ()) else {}),
        })  # fmt: skip
    return items


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


def _task(study: Study, name: str, margins: dict[str, float]) -> dict[str, Any]:
    task = TASKS[name]
    asked = any(part.limits.options(name).confidence for part in study.parts.values())
    measures = [m.as_dict() for m in (TIME, *task.measures, *[CONFIDENCE] * asked)]
    for measure in measures:
        own = margins.get(measure["column"], measure["margin"])
        measure["margin"] = margins.get(measure["name"], own)
    return {"name": name, "code": task.code, "measures": measures}
