"""The pages around the trials, one after the other: what is asked, and the rows it becomes.

Each page's rows reach the disk before the next page is shown, so a session that was broken off goes
on at the first page without an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from seethrough.experiment.display.display import Input, Leave
from seethrough.experiment.pages import blocks
from seethrough.experiment.pages.color_plates import DIGITS, Plate, plates
from seethrough.experiment.pages.depth_test import PAIRS, depth_test
from seethrough.experiment.pages.pages import Choice, Page, Paragraph, PlatePicture, TextField
from seethrough.experiment.record.columns import RESERVED
from seethrough.experiment.session import levels as words
from seethrough.experiment.session.levels import Pairs
from seethrough.experiment.study.design import PARTICIPANT, generator
from seethrough.experiment.study.factors import ALONE, Levels
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.study_tables import QuestionTable

Row = Mapping[str, str]
Item = tuple[str, Pairs]  # item, and factor and level of what it is about
Given = Mapping[Item, str]  # values of the items that were answered
OLDEST = 120  # years; what is above is a slip of the finger
STARTS = ("consent", "demographics", "color_check")
NEUTRAL = "neutral"
COLOR_STREAM = 999_999  # last word of the plates' stream: no trial has it


@dataclass(frozen=True)
class Step:
    """A page. Its rows are written at once, in order: one of `last` says that it was answered."""

    last: tuple[Item, ...]
    ask: Callable[[Input, Given], list[Row]]


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
    part = study.session_part(slot)
    for name in study.questions:
        question = part.questions[name]
        if question.off or _when(question) != "start":
            continue
        yield from _at_start(study, slot, name, question)


def _at_start(study: Study, slot: int, name: str, question: QuestionTable) -> Iterator[Step]:
    if question.use == "consent" and f"{name}.text" in study.texts:
        yield Step((("consent", ()),), _consent)
    elif question.use == "demographics":
        yield Step((("age", ()), ("gender", ())), _demographics)
    elif question.use == "color_check":
        rng = generator(study.study.seed, (PARTICIPANT, slot, COLOR_STREAM))
        for number, plate in enumerate(plates(rng), start=1):
            yield _plate(f"color_plate_{number}", plate)
    else:
        yield from _of_levels(study, question, ())


def of_condition(study: Study, at: Levels) -> Iterator[Step]:
    """Every page that is asked after a condition: the levels of a trial of it."""
    part = study.part(at)
    for name in study.questions:
        question = part.questions[name]
        if not question.off and _when(question) == "condition" and _meant(question, dict(at)):
            yield from _of_levels(study, question, words.of_blocks(study, at))


def after(study: Study, slot: int) -> Iterator[Step]:
    """Every page that the study asks for at the end, in its order."""
    cells = [study.plan.levels(c) for c in study.plan.groups[study.plan.group_of(slot)[0]].cells]
    for name, question in study.questions.items():
        if _when(question) != "end":
            continue
        asked = [
            levels for levels in cells
            if not study.part(levels).questions[name].off and _meant(question, levels)
        ]  # fmt: skip
        each = _each(study, question)
        for about in dict.fromkeys(tuple((f, at[f]) for f in each) for at in asked):
            if question.use == "depth_test":
                for number in range(PAIRS):
                    yield _pair(study, number, asked[0])
            else:
                yield from _of_levels(study, question, about)


def _when(question: QuestionTable) -> str:
    return question.when or ("start" if question.use in STARTS else "end")


def _meant(question: QuestionTable, at: Levels) -> bool:
    """Whether a cell is among the levels that a question is only for."""
    return all(
        at[factor] in ((wanted,) if isinstance(wanted, str) else wanted)
        for factor, wanted in question.only.items()
    )


def _each(study: Study, question: QuestionTable) -> tuple[str, ...]:
    """The factors for each of whose levels a question is asked once."""
    if question.each is not None:
        return question.each
    if question.use == "ratings":
        return tuple(f.name for f in study.factors if f.block)
    if question.use in ("tlx", "sus"):
        return tuple(f.name for f in study.factors if f.block and f.scenes == ALONE)
    return ()


def _of_levels(study: Study, question: QuestionTable, about: Pairs) -> Iterator[Step]:
    """A page about some levels, or about the whole session."""
    if question.use == "ratings":
        page = blocks.ratings(words.title(study, "rating", about), about)
        yield _scales(page, blocks.RATINGS, about)
    elif question.use == "tlx":
        yield _scales(
            blocks.tlx(words.title(study, "tlx", about), about), blocks.TLX, about, "tlx_"
        )
    elif question.use == "sus":
        yield _sus(words.title(study, "sus", about), about)
    elif question.use == "comparison":
        yield _comparison(study, question)
    elif question.use == "remarks":
        yield Step((("remarks", ()),), _remarks)


def _consent(person: Input, given: Given) -> list[Row]:
    buttons = ("consent.yes", "consent.no")
    page = Page("consent", "consent.title", (Paragraph("consent.text"),), buttons)
    if person.ask(page)["button"] == "1":
        raise Leave
    return [_row("consent", "1")]


def _demographics(person: Input, given: Given) -> list[Row]:
    genders = ("gender.female", "gender.male", "gender.other")
    fields = (
        TextField("age", "demographics.age", lines=1, most=OLDEST, wrong="demographics.wrong"),
        Choice("gender", "demographics.gender", genders, optional=True),
    )
    answers = person.ask(Page("demographics", "demographics.title", fields))
    age = answers.get("age", "").strip()
    rows = [_row("age", age)] if age else []
    if "gender" in answers:
        rows.append(
            _row("gender", "", text=genders[int(answers["gender"])].removeprefix("gender."))
        )
    return rows


def _plate(item: str, plate: Plate) -> Step:
    """A plate of the participant's own stream; value 1 where the digit was read."""
    options = (*map(str, sorted(DIGITS)), "color.nothing")

    def ask(person: Input, given: Given) -> list[Row]:
        choice = Choice("digit", "color.question", options)
        answers = person.ask(Page("color check", "color.title", (PlatePicture(plate), choice)))
        answer = options[int(answers["digit"])]
        text = f"{answer.removeprefix('color.')}, shown {plate.digit}"
        return [_row(item, str(int(answer == str(plate.digit))), text=text)]

    return Step(((item, ()),), ask)


def _comparison(study: Study, question: QuestionTable) -> Step:
    """Which level one would rather work with: of two, the second one first, as published."""
    factor = study.factor(question.of or next(f.name for f in study.factors if f.block))
    offered = factor.names[::-1] if len(factor.names) == 2 else factor.names
    at = 1 if len(offered) == 2 else len(offered)
    answers_ = (*offered[:at], NEUTRAL, *offered[at:])
    options = tuple(
        f"name.{NEUTRAL}" if level == NEUTRAL else words.name(study, factor.name, level)
        for level in answers_
    )
    offers = tuple((factor.name, level) for level in answers_)
    second = factor.level(factor.names[1]).part.get("technique", {}).get("use")
    depth = len(factor.names) == 2 and second == "dynamic"  # what the published page asks
    title = "comparison.title" if depth else "comparison.any"
    items = (*([("depth_self_report", ())] if depth else []), ("preference", ()))

    def ask(person: Input, given: Given) -> list[Row]:
        answers = person.ask(blocks.comparison(options, title, depth, offers))
        chosen = answers_[int(answers["preference"])]
        # the paper's 1 and 0; who prefers neither is told from who prefers the first by the text
        value = str(int(chosen not in (NEUTRAL, factor.baseline)))
        rows = [_row("preference", value, text=chosen)]
        return rows + ([_row("depth_self_report", answers["depth_self_report"])] if depth else [])

    return Step(items[:1], ask)


def _scales(page: Page, items: tuple[str, ...], about: Pairs, prefix: str = "") -> Step:
    def ask(person: Input, given: Given) -> list[Row]:
        answers = person.ask(page)
        return [_row(prefix + item, answers[item], **dict(about)) for item in items]

    return Step(((prefix + items[-1], tuple(sorted(about))),), ask)


def _sus(title: str, about: Pairs) -> Step:
    """Ten statements and their score."""
    items = [f"sus_{n}" for n in range(1, blocks.SUS_ITEMS + 1)]
    where = tuple(sorted(about))

    def ask(person: Input, given: Given) -> list[Row]:
        answers = person.ask(blocks.sus(title, about))
        values = {item: given.get((item, where), answers[item]) for item in items}
        rows = [_row(item, value, **dict(about)) for item, value in values.items()]
        return [*rows, _row("sus", f"{blocks.sus_score(values):g}", **dict(about))]

    return Step((("sus", where),), ask)


def _pair(study: Study, number: int, at: Levels) -> Step:
    """A pair of the depth test; value 1 where it was right. The last brings the score."""
    item = f"depth_pair_{number + 1}"

    def ask(person: Input, given: Given) -> list[Row]:
        test = depth_test(study)
        answers = person.ask(test.pages(study.part(at).technique)[number])
        rows = [_row(item, str(int(test.right(number, answers))))]
        if number == PAIRS - 1:
            before_it = (given[f"depth_pair_{n}", ()] for n in range(1, PAIRS))
            score = sum(value == "1" for value in (*before_it, rows[0]["value"]))
            rows.append(_row("depth_test", str(score)))
        return rows

    return Step((("depth_test" if number == PAIRS - 1 else item, ()),), ask)


def _remarks(person: Input, given: Given) -> list[Row]:
    text = person.ask(blocks.remarks()).get("remarks", "")
    return [_row("remarks", "", text=text)] if text else []


def _row(item: str, value: str, **more: str) -> Row:
    return {"item": item, "value": value, **more}
