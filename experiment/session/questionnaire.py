"""The pages around the trials, one after the other: what is asked, and the rows it becomes.

Each page's rows reach the disk before the next page is shown, so a session that was broken off goes
on at the first page without an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any
from zlib import crc32

from seethrough.experiment.display.display import Input
from seethrough.experiment.questions.choice.choice_question import ChoiceParameters
from seethrough.experiment.questions.kit import Asking, Row
from seethrough.experiment.questions.ranking.ranking_question import RankingParameters
from seethrough.experiment.questions.ready import question
from seethrough.experiment.record.columns import RESERVED
from seethrough.experiment.session import levels as words
from seethrough.experiment.session.levels import Pairs
from seethrough.experiment.study.described import each_of
from seethrough.experiment.study.design import PARTICIPANT, generator
from seethrough.experiment.study.factors import Levels
from seethrough.experiment.study.reading import Question
from seethrough.experiment.study.study import Study
from seethrough.renderer.look.look import Look
from seethrough.tasks.catalog import WORLDS

Item = tuple[str, Pairs]  # item, and factor and level of what it is about
Given = Mapping[Item, str]  # values of the items that were answered
QUESTION_STREAM = 999_999  # in the names of questions' streams: no trial has it
COLOR_CHECK = "color_check"  # its stream has no further word


@dataclass(frozen=True)
class Step:
    """A page. Its rows are written at once, in order: one of `last` says that it was answered."""

    last: tuple[Item, ...]
    ask: Callable[[Input, Given], list[Row]]


@dataclass(frozen=True)
class Planned:
    """A question that a study asks: `name` is its table's, `use` its kind or ready-made question,
    `about` the levels that it is asked for, by factor, `of` those that it compares, of a `factor`;
    `cells` are those that it is meant for."""

    name: str
    use: str
    about: Mapping[str, str] = field(default_factory=dict)
    of: tuple[str, ...] = ()
    parameters: Any = None
    factor: str = ""
    cells: tuple[Levels, ...] = ()


def asked(steps: Iterator[Step], person: Input, given: Given | None = None) -> Iterator[list[Row]]:
    """The rows of each page once it is answered, those in `given` left out. Raises Leave."""
    known = dict(given or {})
    for step in steps:
        if any(item in known for item in step.last):
            continue
        # A power failure may have cut a page's rows short: those that are there stand.
        rows = [row for row in step.ask(person, known) if item_of(row) not in known]
        known |= {item_of(row): row["value"] for row in rows}
        yield rows


def item_of(row: Row) -> Item:
    """What tells a participant's answers apart."""
    about = ((k, v) for k, v in row.items() if v and k not in RESERVED)
    return row["item"], tuple(sorted(about))


def before(study: Study, slot: int) -> Iterator[Step]:
    """Every page that the study asks for at the start, in its order."""
    yield from _at("start", study, slot)


def after(study: Study, slot: int = 1) -> Iterator[Step]:
    """Every page that the study asks for at the end, in its order."""
    yield from _at("end", study, slot)


def of_condition(study: Study, slot: int, at: Levels) -> Iterator[Step]:
    """Every page that is asked after a condition: the levels of a trial of it."""
    for name, asked_ in study.part(at).questions.items():
        if asked_.when_asked == "condition" and asked_.meant_for(at):
            about = dict(words.of_blocks(study, at))
            yield from steps(_planned(study, name, asked_, about, (at,)), study, slot)


def _at(when: str, study: Study, slot: int) -> Iterator[Step]:
    plan = study.plan
    cells = [plan.levels(c) for c in plan.groups[plan.group_of(slot)[0]].cells]
    for name, question_ in study.questions.items():
        if question_.when_asked != when:
            continue
        meant = tuple(at for at in cells if study.part(at).questions[name].meant_for(at))
        each = each_of(study, question_)
        for about in dict.fromkeys(tuple((f, at[f]) for f in each) for at in meant):
            there = tuple(at for at in meant if set(about) <= set(at.items()))
            yield from steps(_planned(study, name, question_, dict(about), there), study, slot)


def _planned(
    study: Study, name: str, asked_: Question, about: Mapping[str, str], cells: tuple[Levels, ...]
) -> Planned:
    """The question as it is asked about these levels."""
    use, parameters, factor = asked_.use, asked_.parameters, ""
    of: tuple[str, ...] = ()
    compared = [f for f in study.factors if f.name == asked_.table.of]
    if use == "comparison" and not compared:
        compared = [f for f in study.factors if f.block][:1]
    if compared:
        factor, first = compared[0].name, compared[0].baseline
        of = (first, *(level for level in compared[0].names if level != first))
    if use == "comparison" and len(of) > 2:
        use, parameters = (
            "ranking",
            RankingParameters(text="comparison.ranking", title="comparison.any"),
        )
    elif use == "comparison" and not (of and words.known(study, f"{factor}.{of[1]}")):
        use, parameters, name = "choice", _preference(of), "preference"
    return Planned(name, use, about, of, parameters, factor, cells)


def _preference(of: tuple[str, ...]) -> ChoiceParameters:
    """Which of two levels one would rather work with, 1 for the second."""
    first, second = of
    return ChoiceParameters(
        text="comparison.preference",
        options=(f"name.{second}", "name.neutral", f"name.{first}"),
        names=(second, "neutral", first),
        right=second,
        title="comparison.any",
    )


def steps(planned: Planned, study: Study, slot: int) -> Iterator[Step]:
    """The pages of a question."""
    kind = question(planned.use)
    parameters = kind.Parameters() if planned.parameters is None else planned.parameters
    further = () if planned.use == COLOR_CHECK else (crc32(planned.name.encode()),)
    stream = (PARTICIPANT, slot, QUESTION_STREAM, *further)
    asking = Asking(
        planned.name,
        planned.about,
        planned.of,
        stream=partial(generator, study.study.seed, stream),
        study=StudyPlaces(study, planned.cells),
    )
    cell = tuple(sorted(planned.about.items()))
    pairs = [*planned.about.items(), *((planned.factor, level) for level in planned.of)]

    def step(number: int) -> Step:
        def ask(person: Input, given: Given) -> list[Row]:
            known = {item: value for (item, at), value in given.items() if at == cell}
            now = replace(asking, given=known)
            page = words.named(study, kind.pages(parameters, now)[number], pairs)
            page = replace(page, simulate=partial(kind.simulate, parameters, page))
            rows = kind.rows(parameters, now, number, person.ask(page))
            return [{**row, **planned.about} for row in rows]

        last = kind.last(parameters, asking, number)
        return Step(tuple((item, cell) for item in last), ask)

    for number in range(kind.count(parameters)):
        yield step(number)


@dataclass(frozen=True)
class StudyPlaces:
    """What questions may know of a study, asked for some of its cells."""

    study: Study
    cells: tuple[Levels, ...]

    @property
    def seed(self) -> int:
        """The study's seed."""
        return self.study.study.seed

    def place(self, world: str) -> Any:
        """The study's parameters of a world, or its defaults."""
        kind = WORLDS[world].Parameters
        own = (place for place in self.study.places() if isinstance(place, kind))
        return next(own, None) or self.study.parameters("world", world) or kind()

    def technique(self, about: Mapping[str, str]) -> Any:
        """What frames are drawn with at these levels."""
        return self.study.part(self.cells[-1]).technique

    def look(self, about: Mapping[str, str]) -> Look:
        """How scenes look at these levels."""
        return self.study.part(self.cells[-1]).look
