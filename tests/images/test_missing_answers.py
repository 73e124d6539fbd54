"""A page that is not complete says what is missing, to mouse and keyboard alike."""

import numpy as np
import pytest
from screen import Screen, button, fields, seen

from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.page_blocks import COLORS
from seethrough.experiment.pages.pages import Choice, Page, Paragraph, TextField
from seethrough.experiment.questions.tlx.tlx_question import TLX
from seethrough.experiment.study.tables.ready import one_page

TLX_ITEMS = tuple(f"tlx_{name}" for name in TLX)

RED = np.array([COLORS["wrong"] >> shift & 255 for shift in (0, 8, 16)])
AGE = Page(
    "demographics",
    "demographics.title",
    (
        TextField("age", "demographics.age", lines=1, most=120, wrong="demographics.wrong"),
        Choice("gender", "demographics.gender", ("gender.female", "gender.male"), optional=True),
    ),
)


@pytest.fixture
def screen(context):
    made = Screen(context, (800, 600))
    yield made
    made.stage.interface.close()


def red(picture):
    """(rows, columns) of red ink."""
    return np.nonzero((np.abs(picture.astype(int) - RED) < 12).all(axis=2))


def pale_button(picture):
    """The middle of a button that is drawn pale: a blue between the full one's and the paper's."""
    near = (np.abs(picture.astype(int) - (126, 162, 208)) < 6).all(axis=2)
    rows, columns = np.nonzero(near)
    return np.median(rows), np.median(columns)


@pytest.mark.parametrize("by", ["mouse", "keyboard"])
def test_going_on_too_early_marks_what_is_open_and_goes_nowhere(screen, by):
    form = Form(one_page("ratings", transparency="dynamic", scenario="abstract"))
    first = screen.draw(form)
    assert len(red(first)[0]) == 0
    if by == "mouse":
        screen.click(form, *pale_button(first))
    else:
        screen.key(form, "enter")
    assert not screen.pressed and form.insisted and "button" not in form.answers
    bars = red(seen(screen, form))
    circles = fields(first)
    # A bar in the margin reaches from each statement to its circles.
    margin = bars[0][bars[1] < 85]
    for row, _ in circles:
        assert (np.abs(margin - row) < 3).any()
    form.answers |= {"efficiency": "1", "ease": "0"}
    left = red(seen(screen, form))
    margin = left[0][left[1] < 85]
    assert margin.min() > circles[9][0]  # of the second statement: its bar and the first's are gone
    form.answers["enjoy"] = "3"
    assert len(red(seen(screen, form))[0]) == 0
    screen.key(form, "enter")
    assert screen.pressed


def test_enter_on_an_open_circle_answers_it_and_is_no_attempt_to_go_on(screen):
    form = Form(one_page("ratings", transparency="dynamic", scenario="abstract"))
    screen.draw(form)
    for name in ("down", "enter"):
        screen.key(form, name)
    assert len(form.answers) == 1 and not form.insisted
    screen.key(form, "enter")  # it is answered: Enter now means the page
    assert form.insisted and not screen.pressed


def test_enter_on_a_slider_opens_it_and_is_no_attempt_to_go_on(screen):
    form = Form(one_page("tlx", transparency="dynamic"))
    screen.draw(form)
    for name in ("down", "enter", "enter", "enter"):  # opened, closed, opened again
        screen.key(form, name)
        assert not form.insisted
    other = Form(one_page("tlx", transparency="dynamic"))
    screen.click(other, *pale_button(screen.draw(other)))
    assert other.insisted and other.missing == TLX_ITEMS


@pytest.mark.parametrize("by", ["mouse", "keyboard"])
def test_a_wrong_age_is_named_beside_its_field_and_nothing_else_is_lost(screen, by):
    form = Form(AGE, {"gender": "1"})
    ((row, column), *_) = fields(screen.draw(form))
    screen.click(form, row, column)
    screen.stage.interface.io.add_input_characters_utf8("abc")
    picture = screen.draw(form)
    if by == "mouse":
        screen.click(form, *pale_button(picture))
    else:
        for name in ("enter", "enter"):  # the first ends the typing
            screen.key(form, name)
    assert not screen.pressed and form.insisted
    assert form.answers == {"age": "abc", "gender": "1"}
    ink = red(seen(screen, form))
    assert (ink[1][np.abs(ink[0] - row) < 15] > column).any()  # to the right of the field
    form.answers["age"] = "34"
    assert len(red(seen(screen, form))[0]) == 0
    screen.click(form, *button(screen.draw(form)))
    assert screen.pressed and form.answers["gender"] == "1"


def test_agreeing_looks_like_what_is_usually_meant_and_refusing_does_not(screen):
    page = Page("x", "consent.title", (Paragraph("A line."),), ("consent.yes", "consent.no"))
    form = Form(page)
    picture = screen.draw(form)
    row, _ = button(picture)
    blue = (np.abs(picture.astype(int) - (41, 102, 179)) < 4).all(axis=2)[int(row)]
    white = (picture[int(row)] == 255).all(axis=1)
    assert 60 < blue.sum() < 300  # one filled button in the line, and beside it an empty one
    assert np.nonzero(white)[0].max() > np.nonzero(blue)[0].max()
    right = fields(picture)[-1]
    screen.click(form, *right)
    assert screen.pressed and form.answers["button"] == "1"


def test_while_waiting_a_page_says_so_and_takes_no_second_answer(screen):
    form = Form(Page("pause", "pause.title", (Paragraph("pause.text"),)))
    screen.click(form, *button(screen.draw(form)))
    assert screen.pressed
    quiet = screen.draw(form).copy()
    screen.pressed = False
    screen.stage.draw_waiting("wait.scene", screen.target, 1 / 60)
    assert form.waiting and (screen.draw(form) != quiet).any()
    for name in ("enter", "space"):
        screen.key(form, name)
    assert not screen.pressed


def test_what_is_missing_far_up_is_scrolled_to(screen):
    lines = tuple(Paragraph("A line.\n" * 20) for _ in range(3))
    choice = Choice("c", "color.question", ("2", "3"))
    form = Form(Page("x", "welcome.title", (lines[0], choice, *lines)))
    screen.draw(form)
    for _ in range(12):
        screen.key(form, "pagedown")
    assert len(fields(seen(screen, form), 300)) == 0
    screen.key(form, "enter")
    assert not screen.pressed and form.insisted
    assert len(fields(seen(screen, form), 300)) == 2
