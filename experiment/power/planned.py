"""What a study's report will decide, from its design alone: predictions, tests, their scores."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import log

from seethrough.analysis.design import Contrast, Design, Measured, Prediction
from seethrough.analysis.sections.summary import asked
from seethrough.analysis.sections.tests.measured import OVERALL
from seethrough.analysis.tradeoff import price_of
from seethrough.experiment.power.decisions import Part, Planned, Test

SIGNS = {"less": 1.0, "more": -1.0, "different": 0.0}  # of baseline − level


@dataclass(frozen=True)
class Score:
    """A column of scores: of a measure in a task, or over its tasks, by a contrast; or of an item.

    `first` and `second` weigh baseline and level: (1, −1) is their difference.
    """

    measure: Measured | None
    where: str
    contrast: Contrast | None
    first: float = 1.0
    second: float = -1.0
    item: str = ""


@dataclass
class Plans:
    """What is decided, the scores it needs, and what of it can't be asked and why."""

    planned: list[Planned] = field(default_factory=list)
    scores: list[Score] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    def column(self, score: Score) -> int:
        """The column of a score, a new one if need be."""
        if score not in self.scores:
            self.scores.append(score)
        return self.scores.index(score)


def groups_of(design: Design) -> list[dict[str, str]]:
    """Every group of people: a level of each factor between them; one group where there is none."""
    names = [f.name for f in design.groups]
    return [
        dict(zip(names, at, strict=True))
        for at in itertools.product(*(f.levels for f in design.groups))
    ]


def plans_of(design: Design) -> Plans:
    """The study's predictions; where it states none, its contrasts, Holm-corrected over tasks."""
    plans = Plans()
    for prediction in design.predictions or tuple(_unstated(design)):
        tests = tuple(_tests(plans, design, prediction))
        if tests:
            several = prediction.combine == "any"
            said = prediction.said or _said(prediction)
            plans.planned.append(Planned(prediction.name, said, tests, several))
        elif not any(line.startswith(prediction.name) for line in plans.left_out):
            plans.left_out.append(f"{prediction.name}: the study has no test of it")
    return plans


def _said(prediction: Prediction) -> str:
    level = f" ({prediction.level})" if prediction.level else ""
    by = f" by {prediction.contrast}{level}" if prediction.contrast else ""
    return f"{', '.join(prediction.measures)} {prediction.expect}{by}"


def _unstated(design: Design) -> Iterator[Prediction]:
    for measure in design.measures():
        for contrast in design.contrasts():
            name = f"{measure.said}, {contrast.key}"
            yield Prediction(name, "", (measure.name,), contrast.factor, "different",
                             contrast.level, combine="any")  # fmt: skip


def _tests(plans: Plans, design: Design, prediction: Prediction) -> Iterator[Test]:
    if prediction.expect == "at least":
        item = next(iter(prediction.measures), "")
        if prediction.value is None:
            plans.left_out.append(f"{prediction.name}: no value to reach is stated")
            return
        column = plans.column(Score(None, "", None, item=item))
        weights = _weights(design, None)
        parts = (Part(column, 1.0, -prediction.value),)
        yield Test(item, column, parts=parts, weights=weights, single=True)
        return
    for measure in (m for m in design.measures() if prediction.about(m)):
        for contrast in asked(design, prediction):
            for where in _wheres(design, prediction, measure):
                test = _test(plans, design, prediction, measure, contrast, where)
                if test is not None:
                    yield test


def _wheres(design: Design, prediction: Prediction, measure: Measured) -> Sequence[str]:
    """Where a prediction is tested, as the report has it."""
    tasks = design.tasks_with(measure.name)
    pooled = measure.pool and len(tasks) > 1
    if prediction.expect != "not worse":
        return [OVERALL] if pooled else tasks
    if measure.ranked:  # right or wrong, where nothing finer is measured
        own = {t.name: price_of(t) for t in design.tasks}
        tasks = tuple(t for t in tasks if (p := own[t]) is not None and p.name == measure.name)
    return [OVERALL, *tasks] if pooled else tasks


def _test(
    plans: Plans, design: Design, prediction: Prediction, measure: Measured, contrast: Contrast,
    where: str,
) -> Test | None:  # fmt: skip
    difference = Score(measure, where, contrast)
    place = where if where == OVERALL else design.task_said(where)
    several = len(design.contrasts()) > 1
    name = f"{measure.said} {place}" + (f", {contrast.key}" if several else "")
    if measure.ranked and contrast.between:
        plans.left_out.append(f"{prediction.name}: {name}: ranks between groups are not played")
        return None
    column = plans.column(difference)
    test = Test(name, column, weights=_weights(design, contrast), ranked=measure.ranked,
                log=measure.log, unit=measure.unit)  # fmt: skip
    if prediction.expect in SIGNS:
        return replace(test, sign=SIGNS[prediction.expect])
    parts = _parts(plans, prediction.expect, measure, difference)
    if not parts:
        plans.left_out.append(f"{prediction.name}: {name}: no margin is declared for it")
        return None
    return replace(test, name=f"{name} {prediction.expect}", parts=parts)


def _parts(plans: Plans, expect: str, measure: Measured, of: Score) -> tuple[Part, ...]:
    """One-sided tests against the declared margin (analysis/equivalence.py)."""
    margin = measure.margin
    if margin is None or (measure.ratio and of.contrast is not None and of.contrast.between):
        return ()
    if measure.ratio and not measure.log:
        # second < θ · first, and second > first / θ
        above = Part(plans.column(replace(of, first=margin, second=-1.0)))
        below = Part(plans.column(replace(of, first=-1 / margin, second=1.0)))
    else:
        shift = log(margin) if measure.log else margin
        column = plans.column(of)
        above, below = Part(column, 1.0, shift), Part(column, -1.0, shift)
    if expect == "equivalent":
        return above, below
    return (below,) if measure.direction == "more" else (above,)


def _weights(design: Design, contrast: Contrast | None) -> tuple[float, ...]:
    groups = groups_of(design)
    if contrast is None or not contrast.between:
        return (1 / len(groups),) * len(groups)
    at = [g[contrast.factor] for g in groups]
    return tuple(
        (level == contrast.baseline) / at.count(contrast.baseline)
        - (level == contrast.level) / at.count(contrast.level)
        for level in at
    )
