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
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design import PARTICIPANT, generator

Row = Mapping[str, str]
Item = tuple[str, str, str]  # item, transparency, scenario; the last two empty where none applies
Given = Mapping[Item, str]  # values of the items that were answered
OLDEST = 120  # years; what is above is a slip of the finger
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
    return row["item"], row.get("transparency", ""), row.get("scenario", "")


def before(study: Study, slot: int) -> Iterator[Step]:
    """Consent, age and gender, colour check."""
    if "consent.text" in study.texts:
        yield Step((("consent", "", ""),), _consent)
    if study.session.demographics:
        yield Step((("age", "", ""), ("gender", "", "")), _demographics)
    if study.session.color_check:
        rng = generator(study.study.seed, (PARTICIPANT, slot, COLOR_STREAM))
        for number, plate in enumerate(plates(rng), start=1):
            yield _plate(f"color_plate_{number}", plate)


def after(study: Study) -> Iterator[Step]:
    """Every block the study asks for, in the order of its config."""
    levels = study.design.transparency
    for block in study.session.questionnaire:
        if block == "ratings":
            for transparency, scenario in study.design.factors().conditions:
                page = blocks.ratings(transparency, scenario)
                yield _scales(page, blocks.RATINGS, transparency, scenario)
        elif block == "comparison" and len(levels) > 1:
            yield Step((("depth_self_report", "", ""),), _comparison)
        elif block == "tlx":
            for level in levels:
                yield _scales(blocks.tlx(level), blocks.TLX, level, prefix="tlx_")
        elif block == "sus":
            for level in levels:
                yield _sus(level)
        elif block == "depth_test":
            for number in range(PAIRS):
                yield _pair(study, number)
        elif block == "remarks":
            yield Step((("remarks", "", ""),), _remarks)


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

    return Step(((item, "", ""),), ask)


def _comparison(person: Input, given: Given) -> list[Row]:
    page = blocks.comparison()
    answers = person.ask(page)
    options = next(b.options for b in page.blocks if isinstance(b, Choice))
    chosen = options[int(answers["preference"])].removeprefix("name.")
    return [
        # the paper's 1 and 0; who prefers neither is told from who prefers the standard by the text
        _row("preference", str(int(chosen == "dynamic")), text=chosen),
        _row("depth_self_report", answers["depth_self_report"]),
    ]


def _scales(
    page: Page, items: tuple[str, ...], transparency: str, scenario: str = "", prefix: str = ""
) -> Step:
    def ask(person: Input, given: Given) -> list[Row]:
        answers = person.ask(page)
        return [
            _row(prefix + item, answers[item], transparency=transparency, scenario=scenario)
            for item in items
        ]

    return Step(((prefix + items[-1], transparency, scenario),), ask)


def _sus(level: str) -> Step:
    """Ten statements and their score."""
    items = [f"sus_{n}" for n in range(1, blocks.SUS_ITEMS + 1)]

    def ask(person: Input, given: Given) -> list[Row]:
        answers = person.ask(blocks.sus(level))
        values = {item: given.get((item, level, ""), answers[item]) for item in items}
        rows = [_row(item, value, transparency=level) for item, value in values.items()]
        return [*rows, _row("sus", f"{blocks.sus_score(values):g}", transparency=level)]

    return Step((("sus", level, ""),), ask)


def _pair(study: Study, number: int) -> Step:
    """A pair of the depth test; value 1 where it was right. The last brings the score."""
    item = f"depth_pair_{number + 1}"

    def ask(person: Input, given: Given) -> list[Row]:
        test = depth_test(study)
        answers = person.ask(test.pages(study.dynamic)[number])
        rows = [_row(item, str(int(test.right(number, answers))))]
        if number == PAIRS - 1:
            before_it = (given[f"depth_pair_{n}", "", ""] for n in range(1, PAIRS))
            score = sum(value == "1" for value in (*before_it, rows[0]["value"]))
            rows.append(_row("depth_test", str(score)))
        return rows

    return Step((("depth_test" if number == PAIRS - 1 else item, "", ""),), ask)


def _remarks(person: Input, given: Given) -> list[Row]:
    text = person.ask(blocks.remarks()).get("remarks", "")
    return [_row("remarks", "", text=text)] if text else []


def _row(item: str, value: str, **more: str) -> Row:
    return {"item": item, "value": value, **more}
