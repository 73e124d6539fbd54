"""What a kind of question has to be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product

import numpy as np

from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.people.forms import Opinions
from seethrough.experiment.people.persons.person import Person
from seethrough.experiment.questions.kit import Asking, Question, Row
from seethrough.experiment.suites.finding import NothingToTest
from seethrough.experiment.suites.played import no_clock
from seethrough.experiment.suites.suite import (
    Rule,
    describes_itself,
    parameters_declared,
    texts_in_every_language,
    unknown_texts,
)
from seethrough.renderer.declared import Declares
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.skills.profile import AVERAGE
from seethrough.tasks.kit.world import WorldParameters

LEVELS = ("plain", "xray", "cutaway")


class _Study:
    """What a question may know of a study: one with every default."""

    seed = 1

    def place(self, world: str) -> WorldParameters:
        return WORLDS[world].Parameters()

    def technique(self, about: Mapping[str, str]) -> Parameters:
        from seethrough.renderer.techniques.standard.opaque import Standard

        return Standard()

    def look(self, about: object) -> Look:
        return PLAIN


def _askings() -> Iterator[Asking]:
    yield Asking("mine", of=LEVELS, study=_Study())
    yield Asking("mine", {"view": "plain"}, of=LEVELS, study=_Study())


def _tried(question: Question) -> Iterator[Declares]:
    """Its example, and where it may be left open the example that has to be answered.

    Raises NothingToTest where there is no page.
    """
    if not question.count(question.example):
        raise NothingToTest("its example has no page")
    yield question.example
    if getattr(question.example, "required", True) is False:
        yield replace(question.example, required=True)


def _answered(
    question: Question, p: Declares, asking: Asking, seed: int
) -> Iterator[tuple[int, Page, Answers, list[Row]]]:
    """(number, page, answers, rows) of each page, by a simulated person."""
    opinions = Opinions(Person(np.random.default_rng(seed), AVERAGE))
    for number in range(question.count(p)):
        page = question.pages(p, asking)[number]
        answers = question.simulate(p, page, opinions)
        rows = question.rows(p, asking, number, answers)
        asking = replace(asking, given={**asking.given, **{r["item"]: r["value"] for r in rows}})
        yield number, page, answers, rows


def says_what_it_is(question: Question) -> Iterator[str]:
    """It says what it is: name, source, an example of itself."""
    yield from describes_itself(question, ())
    if not isinstance(question.example, question.Parameters):
        yield f"example = {question.example!r}: expected its Parameters"


def refuses_wrong_parameters(question: Question) -> Iterator[str]:
    """Its parameters are declared, and wrong ones refused by name."""
    yield from parameters_declared(question.Parameters)


def has_its_texts(question: Question) -> Iterator[str]:
    """All that it says is in every language."""
    if not question.texts:
        raise NothingToTest("it brings no texts")
    yield from texts_in_every_language(question, (question.name,))
    own = {key for texts in question.texts.values() for key in texts}
    yield from unknown_texts(own)


def asks_the_same_again(question: Question) -> Iterator[str]:
    """One participant meets the same pages whenever they are made; their number is known."""
    for p, asking in product(_tried(question), _askings()):
        with no_clock(question):
            one, two = (question.pages(p, asking) for _ in range(2))
        if len(one) != question.count(p):
            yield f"count = {question.count(p)}: but there are {len(one)} pages"
        if [page.asked for page in one] != [page.asked for page in two]:
            yield "made twice, its pages differ"


def is_answered_by_simulated_people(question: Question) -> Iterator[str]:
    """A simulated person's answers complete every page, and the rows follow from them alone."""
    for p, asking, seed in product(_tried(question), _askings(), (1, 2)):
        for number, page, answers, _ in _answered(question, p, asking, seed):
            form = Form(page, dict(answers))
            if not form.complete:
                yield f"page {number}: {', '.join(form.missing)}: not answered"
            if "button" not in answers:
                yield f"page {number}: expected a button to be pressed"


def writes_rows_that_it_declares(question: Question) -> Iterator[str]:
    """Rows have items that it declares, values that are numbers or nothing; one says it is done."""
    written = 0
    for p, asking in product(_tried(question), _askings()):
        declared = set(question.items(p, asking.name))
        for number, page, _, rows in _answered(question, p, asking, 1):
            items = [row["item"] for row in rows]
            written += len(rows) + bool(page.required)
            extra = set(items) - declared
            if extra:
                yield f"page {number}: items {sorted(extra)}: not declared"
            if len(set(items)) < len(items):
                yield f"page {number}: items {items}: expected each once"
            for row in rows:
                if not all(isinstance(cell, str) for cell in row.values()):
                    yield f"page {number}: {row}: expected texts"
                elif row["value"]:
                    float(row["value"])
            last = question.last(p, asking, number)
            if page.required and not set(last) & set(items):
                yield f"page {number}: last = {last}: expected one of {items}"
    if not written:
        raise NothingToTest("it writes no rows, and no page has to be answered")


RULES: tuple[Rule[Question], ...] = (
    says_what_it_is,
    refuses_wrong_parameters,
    has_its_texts,
    asks_the_same_again,
    is_answered_by_simulated_people,
    writes_rows_that_it_declares,
)
