"""The pages around the trials, one after the other: what is asked, and the rows it becomes.

Each page's rows reach the disk before the next page is shown, so a session that was broken off goes
on at the first page without an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf
from typing import NamedTuple, Protocol
from zlib import crc32

from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.questions.choice.choice_question import ChoiceParameters
from seethrough.experiment.questions.kit import Asking, Row
from seethrough.experiment.questions.ranking.ranking_question import RankingParameters
from seethrough.experiment.record.columns import RESERVED
from seethrough.experiment.session import levels as words
from seethrough.experiment.session.levels import Pairs
from seethrough.experiment.session.moments import QUESTION_STREAM, Asked, Moment, asked_at, in_order
from seethrough.experiment.session.strangers import called
from seethrough.experiment.study.design.design import PARTICIPANT, generator
from seethrough.experiment.study.design.factors import Levels
from seethrough.experiment.study.shown.described import each_of
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.tables.question_table import Wanted
from seethrough.experiment.study.tables.reading import Question
from seethrough.experiment.study.tables.ready import question
from seethrough.renderer.declared import Declares
from seethrough.renderer.scene.look import Look
from seethrough.renderer.techniques.base import Parameters
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.world import WorldParameters

Item = tuple[str, Pairs]  # item, and factor and level of what it is about; the trial, if it is one


class Said(NamedTuple):
    """An answer: its value and its text."""

    value: str
    text: str = ""


Given = Mapping[Item, Said]  # what was answered, in that order
TRIAL = "after_trial"  # the column that says after which one it was asked
COLOR_CHECK = "color_check"  # its stream has no further word


class Asks(Protocol):
    """Whoever fills pages in."""

    def ask(self, page: Page) -> Answers:
        """Show a page until it is answered. Raises Leave if the session is to end."""


@dataclass(frozen=True)
class Step:
    """A page. Its rows are written at once, in order: one of `last` says that it was answered."""

    last: tuple[Item, ...]
    ask: Callable[[Asks, Given], list[Row]]
    shown: Callable[[Given], bool] = lambda given: True


@dataclass(frozen=True)
class Planned:
    """A question that a study asks: `name` is its table's, `use` its kind or ready-made question,
    `about` the levels that it is asked for, by factor, `of` those that it compares, of a `factor`;
    `cells` are those that it is meant for, `mark` what rows say of when it was asked, `given` what
    earlier answers have to be."""

    name: str
    use: str
    about: Mapping[str, str] = field(default_factory=dict)
    of: tuple[str, ...] = ()
    parameters: Declares | None = None
    factor: str = ""
    cells: tuple[Levels, ...] = ()
    mark: Mapping[str, str] = field(default_factory=dict)
    given: Mapping[str, Wanted] = field(default_factory=dict)


def asked(
    steps: Iterator[Step], person: Asks, known: dict[Item, Said] | None = None
) -> Iterator[list[Row]]:
    """The rows of each page once it is answered; those in `known` are left out, and all go into it.
    Raises Leave."""
    known = {} if known is None else known
    for step in steps:
        if any(item in known for item in step.last) or not step.shown(known):
            continue
        # A power failure may have cut a page's rows short: those that are there stand.
        rows = [row for row in step.ask(person, known) if item_of(row) not in known]
        known |= {item_of(row): said_in(row) for row in rows}
        yield rows


def item_of(row: Row) -> Item:
    """What tells a participant's answers apart."""
    about = ((k, v) for k, v in row.items() if v and (k == TRIAL or k not in RESERVED))
    return row["item"], tuple(sorted(about))


def said_in(row: Row) -> Said:
    """The answer in a row."""
    return Said(row["value"], row.get("text", ""))


def of_trials(known: Given, numbers: Collection[int]) -> dict[Item, Said]:
    """What was answered, but for what was asked after other trials than these."""
    return {
        (item, about): said
        for (item, about), said in known.items()
        if int(dict(about).get(TRIAL, 0)) in (0, *numbers)
    }


def before(study: Study, slot: int) -> Iterator[Step]:
    """Every page that the study asks for at the start, in its order."""
    yield from _at("start", study, slot)


def after(study: Study, slot: int = 1) -> Iterator[Step]:
    """Every page that the study asks for at the end, in its order."""
    yield from _at("end", study, slot)


def between(study: Study, slot: int, now: Moment, every: Sequence[Moment]) -> Iterator[Step]:
    """Every page that is asked at a moment between trials, of `every` one of the session."""
    for name, asked_, about in asked_at(study, slot, now, every):
        planned = _planned(study, name, asked_, about, (now.levels,))
        yield from steps(replace(planned, mark=now.mark), study, slot)


def _at(when: str, study: Study, slot: int) -> Iterator[Step]:
    plan = study.plan
    cells = [plan.levels(c) for c in plan.groups[plan.group_of(slot)[0]].cells]
    every = study.questions.items()
    here: list[Asked] = [(name, q, {}) for name, q in every if q.when_asked == when]
    for name, question_, _ in in_order(study, slot, here):
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
    given = asked_.table.given
    return Planned(name, use, about, of, parameters, factor, cells, given=given)


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
        stream=partial(generator, study.general.seed, stream),
        study=StudyPlaces(study, planned.cells),
    )
    at = {**planned.about, **{k: v for k, v in planned.mark.items() if k == TRIAL}}
    cell = tuple(sorted(at.items()))
    pairs = [*planned.about.items(), *((planned.factor, level) for level in planned.of)]

    language = study.session_part(slot).general.language
    its = partial(called, "question", planned.use)  # the kind may be a stranger's

    def step(number: int) -> Step:
        def ask(person: Asks, given: Given) -> list[Row]:
            known = {item: said.value for (item, at), said in given.items() if at == cell}
            now = replace(asking, given=known)
            page = its("pages", lambda: kind.pages(parameters, now)[number])
            page = words.named(study, page, pairs, language)
            # Whoever is asked because of an earlier answer has something to say to it.
            met = page.insisting() if planned.given else page
            simulate = partial(kind.simulate, parameters, met)
            page = replace(
                page, simulate=lambda someone: its("simulate", partial(simulate, someone))
            )
            answers = person.ask(page)
            more = {**planned.about, **planned.mark}
            return its(
                "rows",
                lambda: [{**row, **more} for row in kind.rows(parameters, now, number, answers)],
            )

        last = its("last", lambda: [(item, cell) for item in kind.last(parameters, asking, number)])
        return Step(tuple(last), ask, partial(holds, planned.given, at))

    for number in its("count", lambda: range(kind.count(parameters))):
        yield step(number)


def holds(wanted: Mapping[str, Wanted], at: Mapping[str, str], given: Given) -> bool:
    """Whether earlier answers are what a question wants: to each item the last one that is about no
    other level than `at` has, nor about another trial."""
    return all(_is(one, _last(item, at, given)) for item, one in wanted.items())


def _last(item: str, at: Mapping[str, str], given: Given) -> Said | None:
    found = [
        said
        for (name, about), said in given.items()
        if name == item and all(at.get(factor, level) == level for factor, level in about)
    ]
    return found[-1] if found else None


def _is(wanted: Wanted, said: Said | None) -> bool:
    """Whether an answer is what is wanted: a number or one between limits, a text, or one of
    several."""
    if said is None:
        return False
    if isinstance(wanted, tuple):
        return any(_is(one, said) for one in wanted)
    if isinstance(wanted, str):
        return wanted in said
    if not said.value:
        return False
    if isinstance(wanted, Mapping):
        return bool(wanted.get("least", -inf) <= float(said.value) <= wanted.get("most", inf))
    return bool(float(said.value) == wanted)


@dataclass(frozen=True)
class StudyPlaces:
    """What questions may know of a study, asked for some of its cells."""

    study: Study
    cells: tuple[Levels, ...]

    @property
    def seed(self) -> int:
        """The study's seed."""
        return self.study.general.seed

    def place(self, world: str) -> WorldParameters:
        """The study's parameters of a world, or its defaults."""
        kind = WORLDS[world].Parameters
        said = self.study.parameters("world", world)
        own = (p for p in (*self.study.places(), said) if isinstance(p, kind))
        return next(own, None) or kind()

    def technique(self, about: Mapping[str, str]) -> Parameters:
        """What frames are drawn with at these levels."""
        return self.study.part(self.cells[-1]).technique

    def look(self, about: Mapping[str, str]) -> Look:
        """How scenes look at these levels."""
        return self.study.part(self.cells[-1]).look
