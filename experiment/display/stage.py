"""Draws what a participant sees, view or page, into any framebuffer: window, offscreen, tests."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import moderngl

from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import HudDrawing, draw_progress
from seethrough.experiment.pages.interface import INSET_TEXTURES, Interface
from seethrough.experiment.pages.page_drawing import PageDrawing
from seethrough.experiment.pages.pages import Picture
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import Inset, Label

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Parameters


class Stage:
    """A renderer for the view, small ones for insets, and the interface over them."""

    def __init__(
        self, context: moderngl.Context, size: tuple[int, int], texts: Texts, samples: int = 0
    ) -> None:
        self.context = context
        self.size = size
        self.texts = texts
        self.samples = samples
        self.renderer = Renderer(context, size, samples)
        self.interface = Interface(context)
        self.done = 0.0  # part of the session
        self.pilot = False
        self.pointer: tuple[float, float] | None = None
        self.last: Form | tuple[View, Parameters] | None = None  # what was drawn
        self._pictures: dict[int, _SmallPicture] = {}

    @property
    def aspect(self) -> float:
        """Width / height."""
        return self.size[0] / self.size[1]

    def resize(self, size: tuple[int, int]) -> None:
        """The window has another size now, in pixels."""
        self.size = size
        self.renderer.resize(size)

    def draw_view(
        self, view: View, technique: Parameters, target: moderngl.Framebuffer, passed: float
    ) -> None:
        """Draw a task's view with its HUD."""
        self.last = (view, technique)
        self.renderer.draw(view.scene, view.camera, technique, target, view.drawn)
        self.interface.begin(self.size, passed)
        inset = partial(self._inset, scale=self.size[1])
        hud = HudDrawing(self.interface, self.texts, self.size[1], inset)
        hud.draw(view.hud)
        if self.pointer is not None and not view.captured:
            hud.draw_pointer(self.pointer)
        draw_progress(self.size, self.done, self.pilot)
        self.interface.end(target)

    def digest(self) -> str:
        """Half of the SHA-256 of the view drawn last, without its HUD."""
        return hashlib.sha256(self.renderer.raw()).hexdigest()[:32]

    def draw_form(self, form: Form, target: moderngl.Framebuffer, passed: float) -> bool:
        """Draw a page; whether one of its buttons was pressed."""
        self.last = form
        target.use()
        target.clear(0.97, 0.97, 0.98, 1.0)
        self.interface.begin(self.size, passed)
        drawing = PageDrawing(self.interface, self.texts, self._picture, self._inset)
        pressed = drawing.draw(form, *self.size)
        draw_progress(self.size, self.done, self.pilot)
        self.interface.end(target)
        return pressed

    @property
    def on_page(self) -> bool:
        """Whether a page was drawn last."""
        return isinstance(self.last, Form)

    def draw_waiting(self, said: str, target: moderngl.Framebuffer, passed: float) -> None:
        """What was drawn last, and that something is being made, as the text `said` has it."""
        if isinstance(self.last, Form):
            self.last.waiting = said
            self.draw_form(self.last, target, passed)
        elif self.last is not None:
            (view, technique), middle = self.last, (self.aspect / 2, 0.47)
            word = Label(said, middle, align="center")
            self.draw_view(replace(view, hud=(word,), captured=False), technique, target, passed)
            self.last = (view, technique)

    def _inset(self, number: int, inset: Inset, scale: float) -> int:
        size = (round(inset.rect.width * scale), round(inset.rect.height * scale))
        return self._small(number, size).draw(View(inset.scene, inset.camera), Standard())

    def _picture(self, picture: Picture, width: int, height: int) -> int:
        return self._small(-1, (width, height)).draw(picture.view, picture.technique)

    def _small(self, number: int, size: tuple[int, int]) -> _SmallPicture:
        size = (max(size[0], 1), max(size[1], 1))
        picture = self._pictures.get(number)
        if picture is None or (picture.size, picture.window) != (size, self.size[1]):
            if picture is not None:
                picture.release(self.interface)
            name = INSET_TEXTURES + 1 + number
            picture = _SmallPicture(self.context, size, self.size[1], name, self.interface)
            self._pictures[number] = picture
        return picture


class _SmallPicture:
    """A picture of its own size that the interface can show as a texture, in a window `window`
    pixels high."""

    def __init__(
        self,
        context: moderngl.Context,
        size: tuple[int, int],
        window: int,
        name: int,
        interface: Interface,
    ) -> None:
        self.size, self.window = size, window
        self.name = name
        self._renderer = Renderer(context, size, window=window)
        self._texture = context.texture(size, 4)
        self._target = context.framebuffer([self._texture])
        interface.overlay.adopt_texture(name, self._texture)

    def draw(self, view: View, technique: Parameters) -> int:
        self._renderer.draw(view.scene, view.camera, technique, self._target, view.drawn)
        return self.name

    def release(self, interface: Interface) -> None:
        self._target.release()
        interface.overlay.delete_texture(self.name)
