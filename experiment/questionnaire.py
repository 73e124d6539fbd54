"""The pages around the trials: asked, and turned into rows of the questionnaire table."""

from __future__ import annotations

from collections.abc import Mapping

from experiment import blocks
from experiment.config import Study
from experiment.depth_test import depth_test
from experiment.design import PARTICIPANT, generator
from experiment.display import Input, Leave
from experiment.pages import Choice, Page, Paragraph, PlatePicture, TextField
from experiment.plates import DIGITS, plates

Row = Mapping[str, str]
OLDEST = 120  # years; what is above is a slip of the finger
COLOR_STREAM = 999_999  # last word of the plates' stream: no trial has it


def before(study: Study, slot: int, person: Input) -> list[Row]:
    """Consent, age and gender, colour check. Raises Leave where consent is not given."""
    rows: list[Row] = []
    if "consent.text" in study.texts:
        page = Page(
            "consent", "consent.title", (Paragraph("consent.text"),), ("consent.yes", "consent.no")
        )
        if person.ask(page)["button"] == "1":
            raise Leave
        rows.append(_row("consent", "1"))
    if study.session.demographics:
        rows += _demographics(person)
    if study.session.color_check:
        rows += _color_check(study, slot, person)
    return rows


def after(study: Study, person: Input, aspect: float) -> list[Row]:
    """Every block the study asks for, in the order of its config."""
    rows: list[Row] = []
    levels = study.design.transparency
    for block in study.session.questionnaire:
        if block == "ratings":
            for transparency, scenario in study.design.factors().conditions:
                answers = person.ask(blocks.ratings(transparency, scenario))
                rows += _items(answers, blocks.RATINGS, transparency, scenario)
        elif block == "comparison" and len(levels) > 1:
            rows += _comparison(person)
        elif block == "tlx":
            for level in levels:
                answers = person.ask(blocks.tlx(level))
                rows += _items(answers, blocks.TLX, level, prefix="tlx_")
        elif block == "sus":
            for level in levels:
                answers = person.ask(blocks.sus(level))
                items = [f"sus_{n}" for n in range(1, blocks.SUS_ITEMS + 1)]
                rows += _items(answers, items, level)
                rows.append(_row("sus", f"{blocks.sus_score(answers):g}", transparency=level))
        elif block == "depth_test":
            test = depth_test(study, aspect)
            answers = {}
            for page in test.pages(study.dynamic):
                answers |= person.ask(page)
            rows.append(_row("depth_test", str(test.score(answers))))
        elif block == "remarks":
            text = person.ask(blocks.remarks()).get("remarks", "")
            rows += [_row("remarks", "", text=text)] if text else []
    return rows


def _demographics(person: Input) -> list[Row]:
    note: tuple[Paragraph, ...] = ()
    while True:
        genders = ("gender.female", "gender.male", "gender.other")
        fields = (
            TextField("age", "demographics.age", lines=1),
            Choice("gender", "demographics.gender", genders, optional=True),
        )
        page = Page("demographics", "demographics.title", (*note, *fields))
        answers = person.ask(page)
        age = answers.get("age", "").strip()
        if not age or (age.isascii() and age.isdigit() and int(age) <= OLDEST):
            break
        note = (Paragraph("demographics.wrong", (("age", age[:20]), ("most", str(OLDEST)))),)
    rows = [_row("age", age)] if age else []
    if "gender" in answers:
        rows.append(
            _row("gender", "", text=genders[int(answers["gender"])].removeprefix("gender."))
        )
    return rows


def _color_check(study: Study, slot: int, person: Input) -> list[Row]:
    """Plates of the participant's own stream; value 1 where the digit was read."""
    rng = generator(study.study.seed, (PARTICIPANT, slot, COLOR_STREAM))
    options = (*map(str, sorted(DIGITS)), "color.nothing")
    rows = []
    for number, plate in enumerate(plates(rng), start=1):
        choice = Choice("digit", "color.question", options)
        answers = person.ask(Page("color check", "color.title", (PlatePicture(plate), choice)))
        answer = options[int(answers["digit"])]
        text = f"{answer.removeprefix('color.')}, shown {plate.digit}"
        rows.append(_row(f"color_plate_{number}", str(int(answer == str(plate.digit))), text=text))
    return rows


def _comparison(person: Input) -> list[Row]:
    answers = person.ask(blocks.comparison())
    return [
        _row("preference", str(int(answers["preference"] == "0"))),
        _row("depth_self_report", answers["depth_self_report"]),
    ]


def _items(
    answers: Mapping[str, str],
    items: tuple[str, ...] | list[str],
    transparency: str,
    scenario: str = "",
    prefix: str = "",
) -> list[Row]:
    return [
        _row(prefix + item, answers[item], transparency=transparency, scenario=scenario)
        for item in items
    ]


def _row(item: str, value: str, **more: str) -> Row:
    return {"item": item, "value": value, **more}
