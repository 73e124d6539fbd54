"""Every kind of question is answered by the keyboard alone, and by the mouse alone."""

import numpy as np
import pytest
from scipy import ndimage
from screen import BUTTON, Screen, fields

from seethrough import registry
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Page, Paragraph, Picture, PlatePicture
from seethrough.experiment.questions.kit import Asking
from seethrough.experiment.questions.likert.likert_question import LikertParameters
from seethrough.experiment.questions.number.number_question import NumberParameters
from seethrough.experiment.study.tables.ready import question

SMALL, LARGE = (800, 600), (1920, 1080)
OTHERS = {  # parameters that ask most of a hand
    "number": NumberParameters(text="How many?", high=60, required=True),
    "likert": LikertParameters(items=("One.", "Two."), points=7),
}
KINDS = [k for k in registry.known("question") if k not in ("color_check", "depth_test", "text")]


def page_of(kind, number=0):
    """A page of a kind's, without what costs time to draw."""
    asked = question(kind)
    pages = asked.pages(OTHERS.get(kind, asked.example), Asking("x", of=("plain", "xray")))
    blocks = tuple(b for b in pages[number].blocks if not isinstance(b, Picture | PlatePicture))
    return Page("x", "A page", blocks)


def typed(screen, form, text):
    for letter in text:
        screen.stage.interface.io.add_input_characters_utf8(letter)
        screen.draw(form)


def by_keyboard(screen, form):
    """Tab from one thing to the next, Space and arrows at each, digits where they are taken."""
    screen.draw(form)
    for _ in range(40):
        screen.key(form, "tab")
        before = dict(form.answers)
        if screen.stage.interface.io.want_text_input:
            typed(screen, form, "7")
            continue
        screen.key(form, "space")
        if screen.pressed or form.complete:
            break
        if form.answers == before:
            continue
        # A ranking wants another rank of the next option: one to the right in each line.
        screen.key(form, "down")
        screen.key(form, "right")
        screen.key(form, "space")
        if form.complete:
            break
    for _ in range(3):
        if not screen.pressed:
            screen.key(form, "enter")


def continue_button(picture):
    """The middle of the largest blue thing: what was chosen is blue as well."""
    labels, count = ndimage.label((np.abs(picture[:-10].astype(int) - BUTTON) < 4).all(axis=2))
    sizes = ndimage.sum_labels(np.ones_like(labels), labels, range(1, count + 1))
    return ndimage.center_of_mass(labels, labels, 1 + int(np.argmax(sizes)))


def by_mouse(screen, form):
    """Click what is white, one thing after the other, until nothing is missing."""
    places = fields(screen.draw(form))
    for _ in range(3):
        for row, column in places:
            if not form.complete:
                screen.click(form, int(row), int(column))
                screen.key(form, "escape")  # leaves a field or slider that a click opened
        if form.complete:
            break
    screen.click(form, *continue_button(screen.draw(form, 6)))


@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
@pytest.mark.parametrize("hand", [by_keyboard, by_mouse])
def test_a_ranking_is_made(context, hand, size):
    screen, form = Screen(context, size), Form(page_of("ranking"))
    hand(screen, form)
    assert screen.pressed and sorted(form.answers["x"].split(",")) == ["1", "2", "3"]


@pytest.mark.parametrize("hand", [by_keyboard, by_mouse])
@pytest.mark.parametrize("kind", [k for k in KINDS if k != "ranking"])
def test_each_kind_is_answered(context, kind, hand):
    for number in range(question(kind).count(OTHERS.get(kind, question(kind).example))):
        screen, form = Screen(context, SMALL), Form(page_of(kind, number))
        hand(screen, form)
        assert screen.pressed and form.complete, form.answers
        assert set(form.page.required) <= set(form.answers)


def test_a_number_grows_while_its_button_is_held(context):
    """By ones and by tens, up to what is allowed and down to what is."""
    screen, form = Screen(context, SMALL), Form(page_of("number"))
    picture = screen.draw(form)
    places = sorted(fields(picture), key=lambda at: at[1])
    assert len(places) == 5  # the field, −10, −, +, +10
    down10, down, up, up10 = ((int(r), int(c)) for r, c in places[1:])
    seen = []
    for at in (up, up, up10, down, *[up10] * 7, *[down10] * 8, down):
        screen.click(form, *at)
        seen.append(form.answers["x"])
    assert seen[:4] == ["0", "1", "11", "10"] and "60" in seen and seen[-1] == "0"
    assert np.all([0 <= int(value) <= 60 for value in seen])


def test_a_statement_is_read_and_gone_on_from(context):
    screen, form = Screen(context, SMALL), Form(Page("x", "A page", (Paragraph("Sit upright."),)))
    by_keyboard(screen, form)
    assert screen.pressed
