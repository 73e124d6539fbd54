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
from seethrough.experiment.questions.kit import Asking, Row
from seethrough.experiment.questions.ready import question
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design import PARTICIPANT, generator
from seethrough.tasks.catalog import WORLDS

Item = tuple[str, str, str]  # item, transparency, scenario; the last two empty where none applies
Given = Mapping[Item, str]  # values of the items that were answered
QUESTION_STREAM = 999_999  # in the names of questions' streams: no trial has it
COLOR_CHECK = "color_check"  # its stream has no further word
FACTORS = ("transparency", "scenario")


@dataclass(frozen=True)
class Step:
    """A page. Its rows are written at once, in order: one of `last` says that it was answered."""

    last: tuple[Item, ...]
    ask: Callable[[Input, Given], list[Row]]


@dataclass(frozen=True)
class Planned:
    """A question that a study asks: `name` is its table's, `use` its kind or ready-made question,
    `about` the levels that it is asked for, by factor, `of` those that it compares."""

    name: str
    use: str
    about: Mapping[str, str] = field(default_factory=dict)
    of: tuple[str, ...] = ()
    parameters: Any = None


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
    return row["item"], row.get("transparency", ""), row.get("scenario", "")


def before(study: Study, slot: int) -> Iterator[Step]:
    """Consent, age and gender, colour check."""
    if "consent.text" in study.texts:
        yield from steps(Planned("consent", "consent"), study, slot)
    if study.session.demographics:
        yield from steps(Planned("demographics", "demographics"), study, slot)
    if study.session.color_check:
        yield from steps(Planned(COLOR_CHECK, COLOR_CHECK), study, slot)


def after(study: Study, slot: int = 1) -> Iterator[Step]:
    """Every block the study asks for, in the order of its config."""
    for block in study.session.questionnaire:
        for planned in _after(block, study):
            yield from steps(planned, study, slot)


def _after(block: str, study: Study) -> Iterator[Planned]:
    levels = study.design.transparency
    if block == "ratings":
        for cell in study.design.factors().conditions:
            yield Planned(block, block, dict(zip(FACTORS, cell, strict=True)))
    elif block in ("tlx", "sus"):
        for level in levels:
            yield Planned(block, block, {FACTORS[0]: level})
    elif block != "comparison":
        yield Planned(block, block)
    elif len(levels) > 1:
        yield Planned(block, block, of=tuple(sorted(levels, key=lambda lv: lv != "standard")))


def steps(planned: Planned, study: Study, slot: int) -> Iterator[Step]:
    """The pages of a question."""
    kind = question(planned.use)
    parameters = kind.Parameters() if planned.parameters is None else planned.parameters
    words = () if planned.use == COLOR_CHECK else (crc32(planned.name.encode()),)
    stream = (PARTICIPANT, slot, QUESTION_STREAM, *words)
    asking = Asking(
        planned.name,
        planned.about,
        planned.of,
        stream=partial(generator, study.study.seed, stream),
        study=StudyPlaces(study),
    )
    cell = tuple(planned.about.get(factor, "") for factor in FACTORS)

    def step(number: int) -> Step:
        def ask(person: Input, given: Given) -> list[Row]:
            known = {item: value for (item, *at), value in given.items() if tuple(at) == cell}
            now = replace(asking, given=known)
            page = kind.pages(parameters, now)[number]
            page = replace(page, simulate=partial(kind.simulate, parameters, page))
            rows = kind.rows(parameters, now, number, person.ask(page))
            return [{**row, **planned.about} for row in rows]

        last = kind.last(parameters, asking, number)
        return Step(tuple((item, *cell) for item in last), ask)

    for number in range(kind.count(parameters)):
        yield step(number)


@dataclass(frozen=True)
class StudyPlaces:
    """What questions may know of a study."""

    study: Study

    @property
    def seed(self) -> int:
        """The study's seed."""
        return self.study.study.seed

    def place(self, world: str) -> Any:
        """The study's parameters of a world."""
        return getattr(self.study, WORLDS[world].scenario)

    def technique(self, about: Mapping[str, str]) -> Any:
        """What frames are drawn with at these levels; the last one's, where none is named."""
        return self.study.dynamic
