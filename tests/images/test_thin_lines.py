"""On a display of many pixels every line is as much thicker as the text is larger."""

import numpy as np
import pytest
from every_page import pages, views
from scipy.ndimage import find_objects, grey_closing, grey_opening, label

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import HudDrawing
from seethrough.experiment.pages.texts import Texts

SIZE = (3840, 2160)  # a line of 1 pixel in a window of 800 × 600 has 3.6 here
THIN = 3  # pixels: what is thinner is taken away by an opening or a closing
LONG = 24  # pixels: corners of letters are shorter
RING = (242, 140, 13)  # about what the keyboard is on
FAINT = 40  # of 255: what is taken away stood out at least so much


def thin_lines(picture):
    """(x, y, width, height) of each line that is thinner than THIN, dark on light or light on
    dark; `picture` (height, width, 3) of whole numbers."""
    grey = (picture.astype(np.uint16).sum(axis=2) // 3).astype(np.uint8)
    dark = grey_closing(grey, (THIN, THIN)) - grey
    light = grey - grey_opening(grey, (THIN, THIN))
    parts, _ = label(np.maximum(dark, light) > FAINT, np.ones((3, 3)))
    boxes = [(x.start, y.start, x.stop - x.start, y.stop - y.start) for y, x in find_objects(parts)]
    return [box for box in boxes if max(box[2:]) >= LONG]


@pytest.fixture
def screen(context):
    stage = Stage(context, SIZE, Texts("en"))
    small = context.texture((4, 3), 4, bytes(48))
    stage.interface.overlay.adopt_texture(1 << 21, small)
    stage._picture = stage._inset = lambda *words, **more: 1 << 21
    target = context.framebuffer([context.texture(SIZE, 4)])
    yield stage, target
    stage.interface.close()


def shown(target):
    data = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    return data.reshape(SIZE[1], SIZE[0], 3)[::-1]


def different_pages():
    """A page for each set of kinds of blocks."""
    return list({frozenset(map(type, page.blocks)): page for page in pages(16 / 9)}.values())


def test_no_page_has_a_thin_line_with_the_keyboard_on_any_of_its_parts(screen):
    stage, target = screen
    bad = []
    for page in different_pages():
        form = Form(page, insisted=True)
        for step in range(2):
            for down in (True, False):
                stage.interface.key("tab", down)
                for _ in range(2):
                    stage.draw_form(form, target, 1 / 60)
            picture = shown(target)
            # The first key may only bring the keyboard to a new page.
            assert step == 0 or (picture == RING).all(axis=2).any(), page.name
            bad += [(page.name, step, box) for box in thin_lines(picture)]
    assert bad == []


def test_no_hud_has_a_thin_line(screen):
    stage, target = screen
    bad = []
    alike = {frozenset(map(type, view.hud)): (name, view) for name, view, _ in views(16 / 9)}
    for name, view in alike.values():
        target.use()
        target.clear(0.6, 0.6, 0.6, 1.0)
        stage.interface.begin(SIZE, 1 / 60)
        hud = HudDrawing(stage.interface, stage.texts, SIZE[1], lambda *_: 1 << 21)
        hud.draw(view.hud)
        hud.draw_pointer((0.9, 0.5))
        stage.interface.end(target)
        bad += [(name, box) for box in thin_lines(shown(target))]
    assert bad == []


def test_a_thin_line_is_found_and_a_thick_one_is_not():
    picture = np.full((100, 100, 3), 240, np.uint8)
    picture[20:22, 10:90] = 20
    picture[40:43, 10:90] = 20
    assert thin_lines(picture) == [(10, 20, 80, 2)]
    assert thin_lines(255 - picture) == [(10, 20, 80, 2)]
