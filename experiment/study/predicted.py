"""What a study's predictions are about: measures and levels that there are."""

from __future__ import annotations

from collections.abc import Iterator

from seethrough.experiment.errors import shown
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.question_checks import items_of
from seethrough.renderer.meant import one_of
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.measure import CONFIDENCE, TIME


def unfit_predictions(study: Study) -> Iterator[str]:
    """A line for each measure and level of a prediction that the study has not: the report could
    say nothing of it. Only who begins with a study asks."""
    known, factors = _measured(study), {factor.name: factor for factor in study.factors}
    for number, said in enumerate(study.analysis.predictions):
        where = f"analysis.predictions[{number}]"
        measures = (said.measure,) if isinstance(said.measure, str) else said.measure
        for measure in measures:
            if measure not in known:
                yield f"{where}.measure = {shown(measure)}: expected {one_of(measure, known)}"
        if (
            said.level
            and said.contrast
            and said.level not in (levels := factors[said.contrast].names)
        ):
            yield f"{where}.level = {shown(said.level)}: expected {one_of(said.level, levels)}"
        for measure in said.margin if isinstance(said.margin, dict) else ():
            if measure not in measures:
                expected = one_of(measure, measures)
                yield f"{where}.margin.{measure}: unknown measure, expected {expected}"


def _measured(study: Study) -> tuple[str, ...]:
    """The names of all that is measured or asked."""
    parts = study.parts.values()
    found = {TIME.name: None}
    for task in study.tasks():
        found |= dict.fromkeys(measure.name for measure in TASKS[task].measures)
        if any(part.task_options.of(task).confidence for part in parts):
            found[CONFIDENCE.name] = None
    for questions in [study.questions, *(part.questions for part in parts)]:
        for name, asked in questions.items():
            found |= dict.fromkeys(items_of(study.factors, name, asked))
    return tuple(found)
