"""Draws tasks/kit/hud.py's elements over a view, with imgui's draw list."""

from __future__ import annotations

import math
from collections.abc import Callable

from imgui_bundle import imgui

from seethrough.experiment.pages.interface import Interface
from seethrough.experiment.pages.texts import Texts
from seethrough.tasks.kit.hud import (
    Button,
    Element,
    Entry,
    FloorPlan,
    Inset,
    Label,
    Mark,
    Rect,
)


def rgba(red: float, green: float, blue: float, alpha: float = 1.0) -> int:
    """A colour as ImGui packs it."""
    return imgui.color_convert_float4_to_u32(imgui.ImVec4(red, green, blue, alpha))


def thick(pixels: float) -> float:
    """A line's width that is so many pixels in a small window, and no less in a smaller one."""
    return pixels * max(1.0, imgui.get_io().display_size.y / SMALL)


SMALL = 600  # pixels of height
INK, PAPER, VEIL = (0.08, 0.09, 0.11), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0, 0.82)
ACCENT, MARK, GREY = (0.16, 0.40, 0.70), (0.85, 0.10, 0.10), (0.55, 0.58, 0.62)
PILOT, PLACE, HINT = (0.95, 0.55, 0.05), (0.05, 0.30, 0.75), (0.75, 0.07, 0.07)
TONES = {  # of a label: what it is written on, and with
    "plain": (VEIL, INK),
    "hint": (PAPER, HINT),
    "practice": (ACCENT, PAPER),
}
EDGE = 0.012  # view units that a label keeps from the border


class HudDrawing:
    """Draws elements at a height of `scale` pixels a view unit."""

    def __init__(
        self,
        interface: Interface,
        texts: Texts,
        scale: float,
        inset: Callable[[int, Inset], int],
    ) -> None:
        self.interface = interface
        self.texts = texts
        self.scale = scale
        self.inset = inset
        self.list = imgui.get_foreground_draw_list()

    def draw(self, elements: tuple[Element, ...]) -> None:
        """All elements, first to last."""
        insets = 0
        for element in elements:
            match element:
                case Label():
                    self._label(element)
                case Button():
                    self._button(element)
                case Entry():
                    self._entry(element)
                case FloorPlan():
                    self._plan(element)
                case Mark():
                    self._mark(element)
                case Inset():
                    self._inset(insets, element)
                    insets += 1

    def draw_pointer(self, at: tuple[float, float]) -> None:
        """A ring where a simulated participant points."""
        center = imgui.ImVec2(at[0] * self.scale, at[1] * self.scale)
        self.list.add_circle(center, 0.014 * self.scale, rgba(*MARK), 0, thick(3.0))

    def _corners(self, rect: Rect) -> tuple[imgui.ImVec2, imgui.ImVec2]:
        s = self.scale
        return (
            imgui.ImVec2(rect.x * s, rect.y * s),
            imgui.ImVec2((rect.x + rect.width) * s, (rect.y + rect.height) * s),
        )

    def _write(self, text: str, x: float, y: float, size: float, color: int) -> None:
        imgui.push_font(self.interface.regular, size * self.scale)
        self.list.add_text(imgui.ImVec2(x * self.scale, y * self.scale), color, text)
        imgui.pop_font()

    def _width(self, text: str, size: float) -> float:
        imgui.push_font(self.interface.regular, size * self.scale)
        width = imgui.calc_text_size(text).x / self.scale
        imgui.pop_font()
        return width

    def _label(self, label: Label) -> None:
        text = self.texts.fill(label.text, label.values)
        share = {"left": 0.0, "center": 0.5, "right": 1.0}[label.align]
        aspect = imgui.get_io().display_size.x / self.scale
        x, y = label.at
        room = min(x / share if share else 9e9, (aspect - x) / (1 - share) if share < 1 else 9e9)
        size, width, pad = label.size, self._width(text, label.size), 0.3 * label.size
        # A longer text, in another language or in a narrow window, is written smaller.
        size *= min(1.0, (room - EDGE - pad) / max(width, 1e-6))
        width = self._width(text, size)
        x -= share * width
        back = Rect(x - pad, y - pad / 2, width + 2 * pad, label.size + pad)
        paper, ink = TONES[label.tone]
        self.list.add_rect_filled(*self._corners(back), rgba(*paper), pad * self.scale)
        self._write(text, x, y + (label.size - size) / 2, size, rgba(*ink))

    def _button(self, button: Button) -> None:
        fill, ink = (ACCENT, PAPER) if button.chosen else (PAPER, INK)
        size = 0.55 * button.rect.height
        # Square: round corners are most of the HUD's triangles, which a frame without a GPU pays.
        self.list.add_rect_filled(*self._corners(button.rect), rgba(*fill))
        self.list.add_rect(*self._corners(button.rect), rgba(*GREY), thickness=thick(1.0))
        text = self.texts.get(button.text)
        size = min(size, size * 0.9 * button.rect.width / max(self._width(text, size), 1e-6))
        x = button.rect.x + (button.rect.width - self._width(text, size)) / 2
        y = button.rect.y + (button.rect.height - size) / 2
        self._write(text, x, y, size, rgba(*ink))

    def _entry(self, entry: Entry) -> None:
        self.list.add_rect_filled(*self._corners(entry.rect), rgba(*PAPER))
        self.list.add_rect(*self._corners(entry.rect), rgba(*ACCENT), 0.0, thickness=thick(2.0))
        size = 0.7 * entry.rect.height
        y = entry.rect.y + 0.15 * entry.rect.height
        self._write(entry.text + "|", entry.rect.x + 0.3 * size, y, size, rgba(*INK))

    def _inset(self, number: int, inset: Inset) -> None:
        name = self.inset(number, inset)
        reference = imgui.ImTextureRef(name)
        # Framebuffer pictures have their first row at the bottom.
        low, high = imgui.ImVec2(0, 1), imgui.ImVec2(1, 0)
        self.list.add_image(reference, *self._corners(inset.rect), low, high)
        self.list.add_rect(*self._corners(inset.rect), rgba(*GREY), thickness=thick(2.0))

    def _mark(self, mark: Mark) -> None:
        """On dark and on light alike: red, with white about it."""
        s = self.scale
        (x, y), r = mark.at, mark.radius * s
        for color, wide in ((rgba(*PAPER), thick(5.0)), (rgba(*MARK), thick(2.5))):
            if mark.form == "ring":
                self.list.add_circle(imgui.ImVec2(x * s, y * s), r, color, 0, wide)
                continue
            for dx, dy in ((r, 0.0), (0.0, r)):
                start, end = (imgui.ImVec2(x * s + k * dx, y * s + k * dy) for k in (-1, 1))
                self.list.add_line(start, end, color, wide)

    def _plan(self, plan: FloorPlan) -> None:
        draw_plan(self.list, plan, self.scale)


def draw_plan(
    lines: imgui.ImDrawList,
    plan: FloorPlan,
    scale: float,
    origin: tuple[float, float] = (0.0, 0.0),
) -> None:
    """A floor plan, a view unit `scale` pixels, from a point of the screen on."""

    def at(x: float, y: float) -> imgui.ImVec2:
        return imgui.ImVec2(origin[0] + x * scale, origin[1] + y * scale)

    r = plan.rect
    lines.add_rect_filled(at(r.x, r.y), at(r.x + r.width, r.y + r.height), rgba(*PAPER))
    for start, end in plan.walls:
        lines.add_line(at(*start), at(*end), rgba(*INK), thick(2.0))
    if plan.start is not None:
        draw_start(lines, at(*plan.start), 0.018 * scale)
    if plan.here is not None:
        draw_walker(lines, at(*plan.here[0]), at(*plan.here[1]), 0.018 * scale)
    if plan.mark is not None and plan.place is not None:
        lines.add_line(at(*plan.mark), at(*plan.place), rgba(*GREY), thick(2.0))
    if plan.place is not None:
        draw_place(lines, at(*plan.place), 0.018 * scale)
    if plan.mark is not None:
        draw_mark(lines, at(*plan.mark), 0.018 * scale)


def draw_mark(lines: imgui.ImDrawList, center: imgui.ImVec2, radius: float) -> None:
    """Where the participant set their mark: a point in a ring."""
    lines.add_circle_filled(center, 0.55 * radius, rgba(*MARK))
    lines.add_circle(center, radius, rgba(*MARK), 0, thick(2.0))


def draw_place(lines: imgui.ImDrawList, center: imgui.ImVec2, radius: float) -> None:
    """Where the thing stands: a diamond, so that the two differ by more than their colour."""
    lines.add_ngon_filled(center, 1.25 * radius, rgba(*PLACE), 4)


def draw_start(lines: imgui.ImDrawList, center: imgui.ImVec2, radius: float) -> None:
    """Where the participant began: an empty square."""
    low, high = (imgui.ImVec2(center.x + s * radius, center.y + s * radius) for s in (-0.8, 0.8))
    lines.add_rect(low, high, rgba(*INK), 0.0, thickness=thick(2.0))


def draw_here(lines: imgui.ImDrawList, center: imgui.ImVec2, radius: float) -> None:
    """Where the participant was, where the direction does not matter: pointing up."""
    draw_walker(lines, center, imgui.ImVec2(center.x, center.y - 1.0), radius)


def draw_walker(
    lines: imgui.ImDrawList, center: imgui.ImVec2, ahead: imgui.ImVec2, radius: float
) -> None:
    """A wedge that points to where somebody looks."""
    dx, dy = ahead.x - center.x, ahead.y - center.y
    length = math.hypot(dx, dy) or 1.0
    dx, dy = dx / length * radius, dy / length * radius
    tip = imgui.ImVec2(center.x + 1.3 * dx, center.y + 1.3 * dy)
    left = imgui.ImVec2(center.x - dx - 0.8 * dy, center.y - dy + 0.8 * dx)
    right = imgui.ImVec2(center.x - dx + 0.8 * dy, center.y - dy - 0.8 * dx)
    lines.add_triangle_filled(tip, left, right, rgba(*ACCENT))


def draw_progress(size: tuple[int, int], done: float, pilot: bool) -> None:
    """A thin line along the bottom: how much is done. Orange marks a pilot run."""
    width, height = size
    deep = max(3.0, 0.006 * height)
    lines = imgui.get_foreground_draw_list()
    low = imgui.ImVec2(0, height - deep)
    lines.add_rect_filled(low, imgui.ImVec2(width, height), rgba(*GREY, 0.35))
    ink = PILOT if pilot else ACCENT
    lines.add_rect_filled(low, imgui.ImVec2(width * done, height), rgba(*ink))
