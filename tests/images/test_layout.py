"""Every page and every HUD at every size, in every language: nothing is cut off, nothing overlaps.

What is drawn is written down as it is drawn: ImGui's own rectangle of each widget, and the box
about what each element of a HUD puts on the draw list.
"""

from functools import cache
from itertools import combinations

import numpy as np
import pytest
from every_page import pages, views
from imgui_bundle import imgui

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages import page_blocks, page_drawing
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import HudDrawing
from seethrough.experiment.pages.pages import (
    Choice,
    Page,
    Paragraph,
    Ranking,
    Scale,
    Several,
    TextField,
)
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.tables.ready import one_page

SIZES = [(800, 600), (1024, 768), (1920, 1080), (2560, 1080), (3840, 2160)]
LANGUAGES = ["en", "de"]
WIDGETS = {
    "text_wrapped", "text_disabled", "radio_button", "checkbox", "slider_int", "input_text",
    "input_text_multiline", "button", "image", "dummy",
}  # fmt: skip
LINE = 0.994  # the progress line lies below that part of the window
TOUCHING = 1.0  # pixel: neighbours may share a border, and ImGui rounds to whole pixels


class Watched:
    """imgui, writing down where each widget of a page lies."""

    def __init__(self):
        self.boxes, self.page = [], False

    def __getattr__(self, name):
        found = getattr(imgui, name)
        return self.noting(name, found) if name in WIDGETS else found

    def begin(self, name, *rest):
        self.page = name.startswith("page")
        self.boxes.clear()
        return imgui.begin(name, *rest)

    def noting(self, name, draw):
        def drawn(*words, **more):
            result = draw(*words, **more)
            low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            if self.page and high.x > low.x and high.y > low.y:
                what = f"{name} {words[0] if isinstance(words[0], str) else ''}"
                self.boxes.append((what, low.x, low.y, high.x, high.y))
            return result

        return drawn


class Ink:
    """A draw list that only writes down how far it is drawn on."""

    def __init__(self):
        self.low, self.high = np.full(2, np.inf), np.full(2, -np.inf)
        self.texts = []

    def reach(self, *points, by=0.0):
        for p in points:
            self.low = np.minimum(self.low, [p.x - by, p.y - by])
            self.high = np.maximum(self.high, [p.x + by, p.y + by])

    def add_text(self, at, color, text):
        size = imgui.calc_text_size(text)
        end = imgui.ImVec2(at.x + size.x, at.y + size.y)
        self.texts.append((at.x, at.y, end.x, end.y))
        self.reach(at, end)

    def add_rect_filled(self, low, high, *rest):
        self.reach(low, high)

    def add_rect(self, low, high, *rest, **more):
        self.reach(low, high)

    def add_line(self, start, end, *rest):
        self.reach(start, end)

    def add_image(self, texture, low, high, *rest):
        self.reach(low, high)

    def add_circle(self, center, radius, *rest):
        self.reach(center, by=radius)

    def add_circle_filled(self, center, radius, *rest):
        self.reach(center, by=radius)

    def add_ngon_filled(self, center, radius, *rest):
        self.reach(center, by=radius)

    @property
    def box(self):
        return (*self.low, *self.high)


def faults(boxes, width, height, left=0.0):
    """What lies outside of the window, and what on something else."""
    found = []
    for what, x0, y0, x1, y1 in boxes:
        if x0 < left - 0.5 or y0 < 0 or x1 > width + 0.5 or y1 > LINE * height:
            found.append(f"{what} at {x0:.0f}, {y0:.0f} to {x1:.0f}, {y1:.0f}: outside")
    for a, b in combinations(boxes, 2):
        across = min(a[3], b[3]) - max(a[1], b[1])
        down = min(a[4], b[4]) - max(a[2], b[2])
        if across > TOUCHING and down > TOUCHING:
            found.append(f"{a[0]} and {b[0]}: overlap by {across:.0f} × {down:.0f}")
    return found


@cache
def every_page():
    alike = {}  # one plate is laid out like the next
    for page in pages(4 / 3):
        words = tuple(getattr(block, "text", "") for block in page.blocks)
        alike.setdefault((page.name.split(" ")[0], page.title, words), page)
    return list(alike.values())


@pytest.fixture
def stage_of(context):
    """Makes stages that draw no scenes, for a page's picture costs more than all of the page."""
    made = []

    def stage(size, language, pixels=None):
        stage = Stage(context, size, Texts(language))
        small = context.texture((4, 3), 4)
        stage.interface.overlay.adopt_texture(1 << 21, small)
        stage._picture = stage._inset = lambda *words, **more: 1 << 21
        made.append(stage)
        # Pixels are not looked at, but for one test: a small target costs next to nothing.
        return stage, context.framebuffer([context.texture(pixels or (8, 6), 4)])

    yield stage
    for stage in made:
        stage.interface.close()


def laid_out(monkeypatch, stage, target, form):
    """The boxes of a form's widgets once its layout has settled."""
    watched = Watched()
    monkeypatch.setattr(page_drawing, "imgui", watched)
    monkeypatch.setattr(page_blocks, "imgui", watched)
    for _ in range(3):
        stage.draw_form(form, target, 1 / 60)
    return list(watched.boxes)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("size", SIZES)
def test_every_page_lies_in_the_window_and_no_widget_on_another(
    stage_of, monkeypatch, size, language
):
    stage, target = stage_of(size, language)
    bad = []
    for page in every_page():
        for state in ("new", "insisted", "waiting"):
            form = Form(page)
            form.answers = {b.name: "x" for b in page.blocks if isinstance(b, TextField)}
            form.insisted = state == "insisted"
            form.waiting = "wait.scene" if state == "waiting" else ""
            boxes = laid_out(monkeypatch, stage, target, form)
            assert len(boxes) > len(page.blocks)
            bad += [f"{page.name}, {state}: {f}" for f in faults(boxes, *size)]
    assert bad == []


CROWDED = [
    Page("a", "sus.dynamic", tuple(
        Scale(f"s{n}", "sus.item4", "tlx.mental", "tlx.physical", steps=steps)
        for n, steps in enumerate((2, 7, 10, 21)))),
    Page("b", "tlx.mental", (
        Choice("c", "sus.item4", tuple(f"sus.item{n}" for n in range(1, 8))),
        TextField("t", "sus.item7", lines=1, most=9, wrong="demographics.wrong")),
        ("menu.on", "menu.repeat", "menu.leave")),
    Page("c", "tlx.mental", (
        Several("m", "sus.item4", ("sus.item1", "tlx.mental", "demographics.wrong", "wait.scene")),
        Scale("s", "sus.item4", "1", "2", steps=10, first=99_991))),
]  # fmt: skip


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("size", [*SIZES, (600, 800)])
@pytest.mark.parametrize("page", CROWDED, ids=["scales", "choices", "boxes"])
def test_pages_with_long_words_at_their_ends_fit_as_well(
    stage_of, monkeypatch, size, language, page
):
    stage, target = stage_of(size, language)
    form = Form(page, insisted=True)
    assert faults(laid_out(monkeypatch, stage, target, form), *size) == []


@pytest.mark.parametrize("size", [*SIZES, (600, 800)])
def test_all_ranks_of_many_options_can_be_reached(stage_of, monkeypatch, size):
    """Below each other where they do not fit beside each other; the page scrolls down alone."""
    options = tuple(f"sus.item{n}" for n in (*range(1, 11), 1, 2, 3, 4))
    stage, target = stage_of(size, "en")
    form = Form(Page("r", "tlx.mental", (Ranking("r", "sus.item4", options),)))
    boxes = laid_out(monkeypatch, stage, target, form)
    assert sum(what.startswith("radio_button") for what, *_ in boxes) == 14 * 14
    tall = (size[0], 100 * size[1])
    assert faults(boxes, *tall) == []


def test_a_page_that_is_too_long_says_so_below_it_and_nothing_lies_there(stage_of, monkeypatch):
    size = (800, 600)
    stage, target = stage_of(size, "en", size)
    form = Form(Page("x", "welcome.title", (Paragraph("A line.\n" * 80),)))
    said = []
    monkeypatch.setattr(
        page_drawing.PageDrawing,
        "_say_that_there_is_more",
        lambda self, width, height: said.append(height),
    )
    laid_out(monkeypatch, stage, target, form)
    data = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    foot = data.reshape(600, 800, 3)[::-1][int(600 * 0.935) : int(600 * LINE)]
    assert said and (foot == foot[0, 0]).all()


def hud_boxes(stage, target, view):
    """(what, box) of each element, and the texts that leave the button they stand on."""
    stage.interface.begin(stage.size, 1 / 60)
    boxes, spilt = [], []
    for element in view.hud:
        hud = HudDrawing(stage.interface, stage.texts, stage.size[1], lambda *_: 1)
        hud.list = Ink()
        hud.draw((element,))
        boxes.append((f"{type(element).__name__} {getattr(element, 'text', '')}", *hud.list.box))
        if (rect := getattr(element, "rect", None)) is not None:
            s = stage.size[1]
            x0, y0, x1, y1 = (rect.x * s, rect.y * s, (rect.x + rect.width) * s,
                              (rect.y + rect.height) * s)  # fmt: skip
            spilt += [
                boxes[-1][0] for a, b, c, d in hud.list.texts
                if a < x0 or b < y0 - 1 or c > x1 or d > y1 + 1
            ]  # fmt: skip
    stage.interface.end(target)
    return boxes, spilt


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("size", SIZES)
def test_every_hud_lies_in_the_window_and_leaves_the_middle_free(stage_of, size, language):
    stage, target = stage_of(size, language)
    width, height = size
    bad = []
    for name, view, plan in views(width / height):
        boxes, spilt = hud_boxes(stage, target, view)
        bad += [f"{name}: {fault}" for fault in faults(boxes, *size)]
        bad += [f"{name}: {what}: text beside its field" for what in spilt]
        for what, x0, y0, x1, y1 in [] if plan else boxes:
            if x1 > 0.3 * width and x0 < 0.7 * width and y1 > 0.3 * height and y0 < 0.7 * height:
                bad.append(f"{name}: {what} covers the middle")
    assert bad == []


def test_a_widget_outside_and_two_that_overlap_are_found():
    inside, out, on = ("a", 10, 10, 50, 50), ("b", 780, 10, 810, 50), ("c", 40, 40, 60, 60)
    assert faults([inside], 800, 600) == []
    assert len(faults([inside, out], 800, 600)) == 1
    assert len(faults([inside, on], 800, 600)) == 1
    assert len(faults([("d", 10, 590, 50, 599)], 800, 600)) == 1


def test_the_list_of_pages_is_complete():
    """Every text of a page in the language file is on one of the pages, or on the HUD."""
    names = {page.name.split(" ")[0] for page in every_page()}
    assert {
        "welcome", "consent", "demographics", "color", "instruction", "feedback", "ready", "pause",
        "time", "thanks", "leave", "menu", "ratings", "tlx", "sus", "comparison", "depth",
        "remarks",
    } == names  # fmt: skip
    assert {
        len(one_page("tlx", transparency="dynamic").blocks),
        len(one_page("sus", transparency="dynamic").blocks),
    } == {6, 10}
