"""A stage without a window, with a hand on its mouse and keyboard, and eyes for its pages."""

import numpy as np
from scipy import ndimage

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.texts import Texts

BUTTON = (41, 102, 179)
FRAME = 1 / 60


class Screen:
    """A stage and what is on it."""

    def __init__(self, context, size):
        self.size = size
        self.stage = Stage(context, size, Texts("en"))
        self.target = context.framebuffer([context.texture(size, 4)])
        self.pressed = False

    def draw(self, form, frames=3):
        """Some frames: ImGui settles its layout over two, and takes one event a frame."""
        for _ in range(frames):
            self.pressed |= self.stage.draw_form(form, self.target, FRAME)
        data = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return data.reshape(self.size[1], self.size[0], 3)[::-1]

    def click(self, form, row, column):
        io = self.stage.interface.io
        io.add_mouse_pos_event(column, row)
        io.add_mouse_button_event(0, True)
        self.draw(form)
        io.add_mouse_button_event(0, False)
        io.add_mouse_pos_event(0, 0)
        self.draw(form)

    def key(self, form, name):
        for down in (True, False):
            self.stage.interface.key(name, down)
            self.draw(form)


def fields(picture, least=100):
    """(row, column) of the middle of each white field: open circles, text fields."""
    labels, count = ndimage.label((picture == 255).all(axis=2))
    sizes = ndimage.sum_labels(np.ones_like(labels), labels, range(1, count + 1))
    chosen = [n for n, size in enumerate(sizes, start=1) if size >= least]
    return ndimage.center_of_mass(labels > 0, labels, chosen)


def button(picture):
    blue = (np.abs(picture.astype(int) - BUTTON) < 4).all(axis=2)
    blue[-10:] = False  # the progress line
    rows, columns = np.nonzero(blue)
    return (np.median(rows), np.median(columns)) if len(rows) else None


def seen(screen, form):
    """What is on the screen, still."""
    return screen.draw(form, 6).copy()
