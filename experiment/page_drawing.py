"""Draws a page as a form and keeps what is filled in; mouse alone or keyboard alone will do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count

from imgui_bundle import imgui

from experiment.interface import SCREENS, Interface
from experiment.pages import (
    Answers,
    Choice,
    Page,
    Paragraph,
    Picture,
    PlatePicture,
    Scale,
    TextField,
)
from experiment.plates import Plate
from experiment.texts import Texts

COLUMN = 1.05  # widest text column, in heights of the screen
MOST_RADIOS = 10  # a scale of more steps is a slider


@dataclass
class Form:
    """A page while it is being filled in."""

    page: Page
    answers: Answers = field(default_factory=dict)
    was_complete: bool = False  # when it was drawn last
    number: int = field(default_factory=count().__next__)  # no other form has it

    @property
    def complete(self) -> bool:
        """Whether every scale and choice has an answer."""
        return all(name in self.answers for name in self.page.required)


class PageDrawing:
    """Draws forms at a height of `scale` pixels."""

    def __init__(
        self, interface: Interface, texts: Texts, picture: Callable[[Picture, int, int], int]
    ) -> None:
        self.interface = interface
        self.texts = texts
        self.picture = picture

    def draw(self, form: Form, width: int, height: int) -> bool:
        """Draw; whether a button was pressed (then answers["button"] says which)."""
        column = min(COLUMN * height, 0.9 * width)
        imgui.set_next_window_pos(imgui.ImVec2(0, 0))
        imgui.set_next_window_size(imgui.ImVec2(width, height))
        flags = imgui.WindowFlags_
        style = imgui.get_style()
        style.window_padding = imgui.ImVec2((width - column) / 2, 0.06 * height)
        style.item_spacing = imgui.ImVec2(0.012 * height, 0.016 * height)
        style.frame_padding = imgui.ImVec2(0.022 * height, 0.012 * height)
        imgui.push_font(self.interface.regular, 0.034 * height)
        imgui.begin(
            # A window of its own for each form: ImGui gives a new one the keyboard.
            f"page{form.number}",
            None,
            flags.no_decoration & ~flags.no_scrollbar | flags.no_move | flags.no_saved_settings,
        )
        self._scroll(form, height)
        imgui.push_font(self.interface.bold, 0.058 * height)
        imgui.text_wrapped(self.texts.get(form.page.title))
        imgui.pop_font()
        imgui.dummy(imgui.ImVec2(0, 0.01 * height))
        for block in form.page.blocks:
            self._block(block, form, column, height)
        imgui.dummy(imgui.ImVec2(0, 0.01 * height))
        pressed = self._buttons(form)
        imgui.end()
        imgui.pop_font()
        form.was_complete = form.complete
        return pressed

    def _scroll(self, form: Form, height: int) -> None:
        """Scroll as far as keys say that were pressed since the last frame.

        In a form's first frame ImGui knows no height yet: keys from before it scroll nothing.
        """
        most = imgui.get_scroll_max_y()
        self.interface.reading = most > 0 and not form.page.asks
        if self.interface.scroll:
            to = imgui.get_scroll_y() + self.interface.scroll * height
            imgui.set_scroll_y(min(max(to, 0.0), most))
            self.interface.scroll = 0.0

    def _block(self, block: object, form: Form, column: float, height: int) -> None:
        match block:
            case Paragraph():
                imgui.text_wrapped(self.texts.fill(block.text, block.values))
            case Scale():
                self._scale(block, form)
            case Choice():
                self._choice(block, form)
            case TextField():
                self._text_field(block, form, column, height)
            case PlatePicture():
                _plate(block.plate, 0.42 * height)
            case Picture():
                high = int(block.height * height)
                wide = high * 4 // 3
                reference = imgui.ImTextureRef(self.picture(block, wide, high))
                size = imgui.ImVec2(wide, high)
                imgui.image(reference, size, imgui.ImVec2(0, 1), imgui.ImVec2(1, 0))

    def _scale(self, scale: Scale, form: Form) -> None:
        imgui.text_wrapped(self.texts.fill(scale.text, scale.values))
        if scale.steps > MOST_RADIOS:
            self._slider(scale, form)
            return
        imgui.align_text_to_frame_padding()
        imgui.text_disabled(self.texts.get(scale.low))
        for step in range(scale.steps):
            imgui.same_line()
            chosen = form.answers.get(scale.name) == str(step)
            if imgui.radio_button(f"{step}##{scale.name}", chosen):
                form.answers[scale.name] = str(step)
        imgui.same_line()
        imgui.text_disabled(self.texts.get(scale.high))

    def _slider(self, scale: Scale, form: Form) -> None:
        """A scale of many steps: unanswered until it was touched."""
        imgui.align_text_to_frame_padding()
        imgui.text_disabled(self.texts.get(scale.low))
        imgui.same_line()
        imgui.set_next_item_width(0.5 * imgui.get_content_region_avail().x)
        answered = scale.name in form.answers
        value = int(form.answers.get(scale.name, (scale.steps - 1) // 2))
        changed, value = imgui.slider_int(
            f"##{scale.name}",
            value,
            0,
            scale.steps - 1,
            "%d" if answered else "?",
            imgui.SliderFlags_.always_clamp,  # a number may be typed as well
        )
        if changed or imgui.is_item_activated():
            form.answers[scale.name] = str(value)
        imgui.same_line()
        imgui.text_disabled(self.texts.get(scale.high))

    def _choice(self, choice: Choice, form: Form) -> None:
        """Options side by side where they fit, else one below the other."""
        if choice.text:
            imgui.text_wrapped(self.texts.get(choice.text))
        gap = imgui.get_frame_height() + 3 * imgui.get_style().item_spacing.x
        widths = [imgui.calc_text_size(self.texts.get(o)).x + gap for o in choice.options]
        beside = sum(widths) <= imgui.get_content_region_avail().x
        for number, option in enumerate(choice.options):
            if number and beside:
                imgui.same_line(0, 2 * imgui.get_style().item_spacing.x)
            chosen = form.answers.get(choice.name) == str(number)
            if imgui.radio_button(f"{self.texts.get(option)}##{choice.name}", chosen):
                form.answers[choice.name] = str(number)

    def _text_field(self, field_: TextField, form: Form, column: float, height: int) -> None:
        imgui.text_wrapped(self.texts.get(field_.text))
        name, text = f"##{field_.name}", form.answers.get(field_.name, "")
        if field_.lines == 1:
            imgui.set_next_item_width(0.3 * column)
            _, text = imgui.input_text(name, text)
        else:
            size = imgui.ImVec2(column, 0.05 * field_.lines * height)
            _, text = imgui.input_text_multiline(name, text, size)
        form.answers[field_.name] = text

    def _buttons(self, form: Form) -> bool:
        """The page's buttons; Enter presses the focused one, or else the first.

        Nobody agrees by a key to what they have not seen: in a long text, Enter goes on reading.
        """
        chosen = focused = None
        most = imgui.get_scroll_max_y()
        imgui.begin_disabled(not form.complete)
        imgui.push_style_color(imgui.Col_.text, imgui.ImVec4(1, 1, 1, 1))
        for number, text in enumerate(form.page.buttons):
            if number:
                imgui.same_line()
            if imgui.button(f"{self.texts.get(text)}##button{number}") and imgui.is_item_visible():
                chosen = number
            if imgui.is_item_focused() and imgui.is_item_visible():
                focused = number
        imgui.pop_style_color()
        imgui.end_disabled()
        if chosen is None and self._enter(form):
            if focused is None and self.interface.reading and imgui.get_scroll_y() < 0.99 * most:
                self.interface.scroll += SCREENS["pagedown"]
            else:
                chosen = focused or 0
        if chosen is not None:
            form.answers["button"] = str(chosen)
        return chosen is not None

    def _enter(self, form: Form) -> bool:
        """Whether Enter was pressed for the page as a whole, not typed into a text field.

        The form must have been complete before: Enter on the last open scale only answers it.
        """
        pressed = imgui.is_key_pressed(imgui.Key.enter, False)
        return pressed and form.was_complete and not self.interface.io.want_text_input


def _plate(plate: Plate, side: float) -> None:
    """A plate of dots at the cursor, `side` pixels wide."""
    corner, dots = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    for (x, y), radius, color in zip(plate.places, plate.radii, plate.colors, strict=True):
        center = imgui.ImVec2(corner.x + x * side, corner.y + y * side)
        ink = imgui.color_convert_float4_to_u32(imgui.ImVec4(*color, 1.0))
        dots.add_circle_filled(center, radius * side, ink, 20)
    imgui.dummy(imgui.ImVec2(side, side))
