"""What a sidecar says of the design: enough to analyse the data without the program."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from typing import Any

from seethrough.experiment.questions.kit import Asking, Weighs
from seethrough.experiment.questions.likert.likert_question import LikertParameters
from seethrough.experiment.study import selection
from seethrough.experiment.study.design.factors import ALONE, Factor
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.question_table import STARTS
from seethrough.experiment.study.tables.reading import Question
from seethrough.experiment.study.tables.ready import Ready, question
from seethrough.renderer.declared import Declares
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.measure import CONFIDENCE, TIME


def design_entry(study: Study) -> dict[str, Any]:
    """Factors with their levels in order, cells left out, tasks with what they measure, what is
    expected, and by which rule scenes were selected, if they were; plain JSON types."""
    analysis = json.loads(study.analysis.model_dump_json())
    margins = {k: v for k, v in analysis["margins"].items() if v is not None}
    selected = selection.said(study)
    return {
        "factors": [_factor(study, factor) for factor in study.factors],
        "excluded": [dict(levels) for levels in study.excluded],
        "tasks": [_task(study, task, margins) for task in study.tasks()],
        "predictions": [
            {k: v for k, v in said.items() if v not in (None, "")}
            for said in analysis["predictions"]
        ],
        "items": [item for name, asked in study.questions.items()
                  for item in items_of(study, name, asked)],
        **({"selected": selected} if selected else {}),
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


def items_of(study: Study, name: str, asked: Question) -> list[dict[str, object]]:
    """A question's items, but of what is asked at the start: for which levels, together with which,
    of how many points. What is added up stands for its parts; items of one scale are together."""
    if asked.use in STARTS:
        return []
    kind = question(asked.use)
    said = kind.items(_with_options(study, asked), name)
    parts = {p.score: list(p.asked(name)) for p in _scales(asked, name) if p.score}
    added = {item for own in parts.values() for item in own}
    added |= {*kind.behind(asked.parameters)} if isinstance(kind, Weighs) else set()
    known = {item: words for item, words in said.items() if item not in added}
    turned = [item for p in _scales(asked, name) for item in p.reverse]
    each = list(each_of(study, asked))
    compared = asked.table.of or next((f.name for f in study.factors if f.block), "")
    items = []
    scales = {item: re.search(r"\((-?\d+)–(-?\d+)\)$", words) for item, words in known.items()}
    spans = [scale and scale[0] for scale in scales.values()]
    first = next((span for span in spans if span), None)
    for (item, scale), span in zip(scales.items(), spans, strict=True):
        items.append({
            "name": item,
            "label": item.replace("_", " "),
            "each": each,
            "group": name if len(known) > 1 and span in (None, first) else "",
            "of": compared if asked.use == "comparison" and item == "preference" else "",
            **({"points": int(scale[2]) - int(scale[1]) + 1, "low": int(scale[1])}
               if scale else {}),
            **({"parts": parts[item]} if item in parts else {}),
            **({"reverse": own} if (own := [t for t in turned if t in parts.get(item, [item])])
               else {}),
        })  # fmt: skip
    return items


def _with_options(study: Study, asked: Question) -> Declares:
    """A question's parameters; what is asked of a factor's levels has those for options."""
    p, of = asked.parameters, asked.table.of
    if not of or getattr(p, "options", None) != ():
        return p
    levels = next(f.names for f in study.factors if f.name == of)
    return replace(p, options=tuple(levels), **({"of": ""} if hasattr(p, "of") else {}))


def _scales(asked: Question, name: str) -> list[LikertParameters]:
    """The Likert scales of a question."""
    kind = question(asked.use)
    found = [part.parameters for part in kind.parts(Asking(name))] if isinstance(kind, Ready) else [
        asked.parameters
    ]  # fmt: skip
    return [p for p in found if isinstance(p, LikertParameters)]


def _factor(study: Study, factor: Factor) -> dict[str, object]:
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


def _task(study: Study, name: str, margins: dict[str, float]) -> dict[str, object]:
    task = TASKS[name]
    asked = any(part.task_options.of(name).confidence for part in study.parts.values())
    measures = []
    for measure in (TIME, *task.measures, *[CONFIDENCE] * asked):
        own = margins.get(measure.column, measure.margin)
        measures.append(measure.as_dict() | {"margin": margins.get(measure.name, own)})
    return {"name": name, "code": task.code, "measures": measures}
