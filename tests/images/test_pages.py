"""Pages as they are drawn: filled in by mouse alone, by keyboard alone, on screens of any size."""

import numpy as np
import pytest
from screen import Screen, button, fields, seen

from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import ACCENT, PILOT
from seethrough.experiment.pages.pages import (
    Choice,
    Page,
    Paragraph,
    Ranking,
    Scale,
    Several,
    TextField,
)
from seethrough.experiment.questions.tlx.tlx_question import TLX
from seethrough.experiment.study.tables.ready import one_page

TLX_ITEMS = tuple(f"tlx_{name}" for name in TLX)


@pytest.fixture
def screen(context):
    made = Screen(context, (800, 600))
    yield made
    made.stage.interface.close()


def test_scales_by_mouse_alone(screen):
    form = Form(one_page("ratings", transparency="dynamic", scenario="abstract"))
    circles = fields(screen.draw(form))
    assert len(circles) == 15
    for scale, step in enumerate((4, 0, 2)):
        screen.click(form, *circles[5 * scale + step])
    assert not screen.pressed
    screen.click(form, *button(screen.draw(form)))
    assert screen.pressed
    assert form.answers == {"efficiency": "4", "ease": "0", "enjoy": "2", "button": "0"}


def test_scales_by_keyboard_alone(screen):
    form = Form(one_page("ratings", transparency="dynamic", scenario="abstract"))
    screen.draw(form)
    # After a mouse the first key but shows where the keyboard is.
    for keys in (("down", "up", "space"), ("down", "right", "space"), ("down", "enter")):
        assert not form.complete
        for name in keys:
            screen.key(form, name)
    # Enter answered the last open scale, and did not go on as well.
    assert form.complete and not screen.pressed
    screen.key(form, "down")
    screen.key(form, "enter")
    assert screen.pressed


@pytest.mark.parametrize("by", ["mouse", "keyboard"])
def test_text_is_entered_where_the_field_is(screen, by):
    form = Form(Page("x", "remarks.title", (TextField("remarks", "remarks.text"),)))
    ((row, column),) = fields(screen.draw(form))
    if by == "mouse":
        screen.click(form, row, column)
    else:
        screen.key(form, "tab")
    screen.stage.interface.io.add_input_characters_utf8("Grün, „gut“")
    screen.draw(form)
    assert form.answers["remarks"] == "Grün, „gut“"
    if by == "mouse":
        screen.click(form, *button(screen.draw(form)))
    else:
        screen.key(form, "tab")
        screen.key(form, "enter")
    assert screen.pressed


def test_a_page_that_is_too_long_scrolls(screen):
    page = Page("x", "welcome.title", (Paragraph("A line.\n" * 80),))
    form = Form(page)
    before = screen.draw(form)
    assert button(before) is None  # it lies below the screen
    screen.stage.interface.io.add_mouse_pos_event(400, 300)
    for _ in range(60):
        screen.stage.interface.io.add_mouse_wheel_event(0, -5)
        screen.draw(form, 1)
    screen.click(form, *button(screen.draw(form)))
    assert screen.pressed


@pytest.mark.parametrize(("pilot", "color"), [(False, ACCENT), (True, PILOT)])
def test_the_progress_line_is_as_long_as_what_is_done_and_orange_in_a_pilot(screen, pilot, color):
    screen.stage.done, screen.stage.pilot = 0.25, pilot
    line = screen.draw(Form(Page("x", "welcome.title")))[-2].astype(int)
    drawn = (np.abs(line - np.round(np.array(color) * 255)) < 3).all(axis=1)
    assert drawn.sum() == drawn[:201].sum() and abs(drawn.sum() - 200) <= 1


def test_text_scales_with_the_screen(context):
    """On a screen of twice the size, the page's ink begins and ends at the same parts of it."""
    extents = []
    for size in ((800, 600), (1600, 1200)):
        screen = Screen(context, size)
        picture = screen.draw(
            Form(one_page("ratings", transparency="dynamic", scenario="abstract"))
        )
        screen.stage.interface.close()
        ink = np.nonzero(picture.max(axis=2)[: -size[1] // 50] < 140)
        assert len(ink[0]) > 1000
        extents.append([(i.min() / size[1], i.max() / size[1]) for i in ink])
    # ImGui puts letters on whole pixels: one or two for each of a page's ten lines.
    np.testing.assert_allclose(extents[0], extents[1], atol=0.02)


@pytest.mark.parametrize(("key", "most"), [("pagedown", 0.88), ("down", 0.35), ("enter", 0.88)])
def test_a_long_text_is_read_to_its_end_by_keyboard_alone(screen, key, most):
    lines = "\n".join(f"Line {n}: " + "word " * (n % 9) for n in range(80))
    buttons = ("consent.yes", "consent.no")
    form = Form(Page("x", "consent.title", (Paragraph(lines),), buttons))
    height, last = screen.size[1], seen(screen, form)
    for _ in range(40):
        screen.key(form, key)
        now = seen(screen, form)
        if (now == last).all() or screen.pressed:
            break
        # Nothing is skipped: what was lowest is still on the screen, farther up.
        strip = last[int(most * height) : int((most + 0.04) * height), 60:400]
        assert any(
            (now[top : top + len(strip), 60:400] == strip).all()
            for top in range(int(most * height))
        )
        last = now
    else:
        raise AssertionError("there is no end")
    assert button(last) is not None
    assert screen.pressed == (key == "enter")
    if key != "enter":
        screen.key(form, "pageup")
        assert (seen(screen, form) != last).any()


def test_a_number_typed_into_a_slider_stays_on_its_scale(screen):
    form = Form(one_page("tlx", transparency="dynamic"))
    screen.draw(form)
    for name in ("down", "enter"):
        screen.key(form, name)
    screen.stage.interface.io.add_input_characters_utf8("99")
    screen.draw(form)
    screen.key(form, "enter")
    assert [form.answers.get(item) for item in TLX_ITEMS if item in form.answers] == ["20"]


def test_sliders_by_keyboard_alone(screen):
    form = Form(one_page("tlx", transparency="standard"))
    screen.draw(form)
    screen.key(form, "down")
    screen.key(form, "up")
    for steps, _ in enumerate(TLX_ITEMS):
        for name in ("space", *["right"] * steps, "space", "down"):
            screen.key(form, name)
    assert form.answers == {item: str(10 + n) for n, item in enumerate(TLX_ITEMS)}
    screen.key(form, "enter")
    assert screen.pressed


def test_keys_of_a_trial_do_not_scroll_the_page_after_it(screen):
    def page():
        return Form(Page("x", "consent.title", (Paragraph("A line.\n" * 80),)))

    top = seen(screen, page())
    for name in ("pagedown", "down", "down"):  # walking, while the last page drawn was a long text
        for down in (True, False):
            screen.stage.interface.key(name, down)
    assert (seen(screen, page()) == top).all()


BLOCKS = {
    "scale": lambda text: Scale("x", text, "low", "high", 5),
    "choice": lambda text: Choice("x", text, ("one", "two")),
    "several": lambda text: Several("x", text, ("one", "two")),
    "ranking": lambda text: Ranking("x", text, ("one", "two")),
    "text": lambda text: TextField("x", text),
}


@pytest.mark.parametrize("kind", BLOCKS)
def test_a_question_s_words_are_drawn(screen, kind):
    """Fewer strokes, less ink: one question is an I, the other many Ms."""
    ink = []
    for text in ("I", "MMMMMMMMMMMMMMMM"):
        picture = screen.draw(Form(Page("x", "remarks.title", (BLOCKS[kind](text),))))
        ink.append((np.asarray(picture, float).max(axis=2) < 100).sum())
    assert ink[1] > ink[0] + 200
