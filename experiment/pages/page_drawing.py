"""Draws a page as a form and keeps what is filled in; mouse alone or keyboard alone will do.

A page of questions that is higher than the window is set closer, then smaller, so that all of it
can be seen; a text that is much longer keeps its size and is scrolled, and a line below says so.
"""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from seethrough.experiment.pages.form import Form, Setting
from seethrough.experiment.pages.hud_drawing import thick
from seethrough.experiment.pages.interface import SCREENS, Interface
from seethrough.experiment.pages.page_blocks import COLORS, PALE, Blocks, ring
from seethrough.experiment.pages.pages import Picture
from seethrough.experiment.pages.texts import Texts
from seethrough.tasks.kit.hud import Inset

COLUMN = 1.05  # widest text column, in heights of the screen
MARGIN = 0.06  # above and below, in heights of the screen
SETTINGS = (  # (size of text, of the gaps about it), until a page fits
    (1.0, 1.0), (1.0, 0.7), (1.0, 0.5), (0.95, 0.4), (0.9, 0.4), (0.85, 0.35), (0.8, 0.3),
    (0.75, 0.3), (0.7, 0.3),
)  # fmt: skip
READABLE = 0.85  # running text is not drawn smaller than that: it is scrolled
FOOT = 0.07  # where a page says that there is more of it, in heights of the screen
DOTS = 0.4  # s a dot of what says that something goes on


class PageDrawing:
    """Draws forms into a window's width and height, in pixels."""

    def __init__(
        self,
        interface: Interface,
        texts: Texts,
        picture: Callable[[Picture, int, int], int],
        inset: Callable[[int, Inset, float], int],
    ) -> None:
        self.interface = interface
        self.texts = texts
        self.blocks = Blocks(interface, texts, picture, inset)

    def draw(self, form: Form, width: int, height: int) -> bool:
        """Draw; whether a button was pressed (then answers["button"] says which)."""
        if form.fitted is None or form.fitted[0] != (width, height):
            form.fitted = ((width, height), *self._fit(form, width, height))
        _, setting, long = form.fitted
        scale = setting[0]
        before = dict(form.answers)
        # A window of its own for each form: ImGui gives a new one the keyboard.
        foot = FOOT * height if long else 0.0
        self._begin(f"page{form.number}", width, height - foot, height, setting)
        self._scroll(form, height)
        self._contents(form, height * scale, False)
        pressed = self._buttons(form, before, height * scale, False)
        below = imgui.get_scroll_y() < imgui.get_scroll_max_y() - 1
        self._end()
        if long and below:
            self._say_that_there_is_more(width, height)
        form.was_complete = form.complete
        return pressed

    def _fit(self, form: Form, width: int, height: int) -> tuple[Setting, bool]:
        """The first setting in which all of it lies in the window, and whether there is none."""
        for setting in SETTINGS:
            if setting[0] < READABLE and not form.page.asks:
                break
            if self._measured(form, width, height, setting) <= height:
                return setting, False
        return SETTINGS[0], True

    def _measured(self, form: Form, width: int, height: int, setting: Setting) -> float:
        """Height of a form with all that it may ever say: laid out, with nothing drawn."""
        imgui.push_style_var(imgui.StyleVar_.alpha, 1e-6)  # 0 would not be laid out at all
        flags = imgui.WindowFlags_
        unseen = flags.no_inputs | flags.no_focus_on_appearing | flags.no_background
        self._begin(f"measured{setting}", width, height, height, setting, unseen)
        self._contents(form, height * setting[0], True)
        self._buttons(form, form.answers, height * setting[0], True)
        bottom = imgui.get_cursor_pos_y() - imgui.get_style().item_spacing.y
        self._end()
        imgui.pop_style_var()
        return bottom + MARGIN * setting[1] * height

    def _begin(
        self, name: str, width: int, high: float, height: int, setting: Setting, more: int = 0
    ) -> None:
        imgui.set_next_window_pos(imgui.ImVec2(0, 0))
        imgui.set_next_window_size(imgui.ImVec2(width, high))
        flags, unit, gaps = imgui.WindowFlags_, height * setting[0], setting[1]
        style = imgui.get_style()
        side = (width - _column(width, height)) / 2
        style.window_padding = imgui.ImVec2(side, MARGIN * gaps * height)
        style.item_spacing = imgui.ImVec2(0.012 * unit, 0.016 * gaps * unit)
        style.item_inner_spacing = imgui.ImVec2(thick(4.0), thick(4.0))
        style.frame_border_size = style.input_text_cursor_size = round(thick(1.0))
        style.scrollbar_size, style.grab_min_size = thick(14.0), thick(12.0)
        style.frame_padding = imgui.ImVec2(0.022 * unit, 0.012 * gaps * unit)
        imgui.push_font(self.interface.regular, 0.034 * unit)
        plain = flags.no_decoration & ~flags.no_scrollbar | flags.no_move | flags.no_saved_settings
        imgui.begin(name, None, plain | more)

    def _end(self) -> None:
        imgui.end()
        imgui.pop_font()

    def _contents(self, form: Form, unit: float, measured: bool) -> None:
        imgui.push_font(self.interface.bold, 0.058 * unit)
        imgui.text_wrapped(self.texts.get(form.page.title))
        imgui.pop_font()
        imgui.dummy(imgui.ImVec2(0, imgui.get_style().item_spacing.y / 2))
        self.blocks.draw(form, unit, measured)
        imgui.dummy(imgui.ImVec2(0, imgui.get_style().item_spacing.y / 2))

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

    def _say_that_there_is_more(self, width: int, height: int) -> None:
        """A line below the page; nothing of the page lies there."""
        lines, text = imgui.get_foreground_draw_list(), self.texts.get("page.more")
        imgui.push_font(self.interface.regular, 0.03 * height)
        size = imgui.calc_text_size(text)
        left, top = (width - size.x) / 2, height * (1 - FOOT / 2) - size.y / 2
        lines.add_text(imgui.ImVec2(left, top), COLORS["ink"], text)
        imgui.pop_font()

    def _buttons(self, form: Form, before: dict[str, str], unit: float, measured: bool) -> bool:
        """The page's buttons, and beside them what is missing; Enter presses the focused one, or
        else the first.

        Nobody agrees by a key to what they have not seen: in a long text, Enter goes on reading.
        """
        chosen = focused = None
        most = imgui.get_scroll_max_y()
        pale = not form.complete or bool(form.waiting)
        if pale and not measured:
            imgui.push_style_var(imgui.StyleVar_.alpha, 0.6)
        gap, end = 0.03 * unit, imgui.get_cursor_screen_pos().x + imgui.get_content_region_avail().x
        for number, key in enumerate(form.page.buttons):
            text = self.texts.get(key)
            wide = imgui.calc_text_size(text).x + 2 * imgui.get_style().frame_padding.x
            if number and imgui.get_item_rect_max().x + gap + wide <= end:
                imgui.same_line(0, gap)
            if _button(text, number) and imgui.is_item_visible():
                chosen = number
            if imgui.is_item_focused() and imgui.is_item_visible():
                focused = number
        if pale and not measured:
            imgui.pop_style_var()
        self._beside_buttons(form, measured)
        if measured or form.waiting:
            return False
        if chosen is None and self._enter(form, before):
            reading = self.interface.reading and imgui.get_scroll_y() < 0.99 * most
            if focused is None and reading:
                self.interface.scroll += SCREENS["pagedown"]
            elif form.page.buttons:
                chosen = focused or 0
        if chosen is None:
            return False
        if not form.complete:
            form.insisted, form.sought = True, form.missing[0]
            return False
        form.answers["button"] = str(chosen)
        return True

    def _beside_buttons(self, form: Form, measured: bool) -> None:
        """What is missing, or what is being done."""
        missing = form.missing
        if form.waiting:
            dots = "." * (1 + int(imgui.get_time() / DOTS) % 3)
            text, color = self.texts.get(form.waiting) + dots, COLORS["accent"]
        elif (form.insisted and missing) or (measured and form.page.asks):
            open_ = (("open", str(len(missing))),)
            text, color = self.texts.fill("page.missing", open_), COLORS["wrong"]
        else:
            return
        room = imgui.get_content_region_avail().x
        end = imgui.get_cursor_screen_pos().x + room
        if form.page.buttons and end - imgui.get_item_rect_max().x > 0.3 * room:
            imgui.same_line()
        imgui.align_text_to_frame_padding()
        imgui.push_style_color(imgui.Col_.text, color)
        imgui.text_wrapped(text)
        imgui.pop_style_color()

    def _enter(self, form: Form, before: dict[str, str]) -> bool:
        """Whether Enter was pressed for the page as a whole, not typed into a text field.

        Enter on an open scale only answers it, on the last one too; on a slider it opens it.
        """
        pressed = imgui.is_key_pressed(imgui.Key.enter, False)
        if not pressed or self.interface.io.want_text_input or form.answers != before:
            return False
        return form.was_complete or not self.blocks.on_slider


def _column(width: int, height: int) -> float:
    """How wide the text is, in pixels."""
    return min(COLUMN * height, 0.9 * width)


def _button(text: str, number: int) -> bool:
    """A button; the first is what is usually meant, and filled. Whether it was pressed."""
    colors = PALE if number else {imgui.Col_.text: COLORS["paper"]}
    for which, color in colors.items():
        imgui.push_style_color(which, color)
    pressed = imgui.button(f"{text}##button{number}")
    ring()
    imgui.pop_style_color(len(colors))
    return bool(pressed)
