"""Draws what a page is made of: texts, scales, choices, fields and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import floor, log10

from imgui_bundle import imgui

from seethrough.experiment.pages.color_plates import Plate
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import (
    ACCENT,
    INK,
    PAPER,
    draw_here,
    draw_mark,
    draw_place,
    draw_plan,
    draw_start,
    rgba,
    thick,
)
from seethrough.experiment.pages.interface import Interface
from seethrough.experiment.pages.pages import (
    PICTURE_ASPECT,
    Choice,
    Paragraph,
    Picture,
    PlanPicture,
    PlatePicture,
    Ranking,
    Scale,
    Several,
    TextField,
)
from seethrough.experiment.pages.texts import Texts
from seethrough.tasks.kit.hud import FloorPlan, Inset

MOST_RADIOS = 10  # a scale of more steps is a slider
COLORS = {
    "accent": rgba(*ACCENT),
    "ink": rgba(*INK),
    "wrong": rgba(0.75, 0.07, 0.07),
    "paper": rgba(*PAPER),
    "pale": rgba(0.90, 0.93, 0.97),
    "focus": rgba(0.95, 0.55, 0.05),
}

PALE = {  # of a button that is not what is usually meant
    imgui.Col_.button: COLORS["paper"],
    imgui.Col_.button_hovered: COLORS["pale"],
    imgui.Col_.button_active: COLORS["pale"],
}


class Blocks:
    """Draws blocks one below the other; `unit` is the height of a screen, scaled, in pixels."""

    def __init__(
        self,
        interface: Interface,
        texts: Texts,
        picture: Callable[[Picture, int, int], int],
        inset: Callable[[int, Inset, float], int],
    ) -> None:
        self.interface = interface
        self.texts = texts
        self.picture = picture
        self.inset = inset
        self.on_slider = False  # whether the keyboard is on one

    def draw(self, form: Form, unit: float, measured: bool) -> None:
        """All of a form's blocks. `measured`: only their sizes are wanted."""
        missing = form.missing if form.insisted else ()
        for block in form.page.blocks:
            named = getattr(block, "name", "")
            marked = bool(named) and named in missing
            top = imgui.get_cursor_screen_pos()
            if marked and named == form.sought and not measured:
                imgui.set_scroll_here_y(0.3)
                form.sought = ""
            self._block(block, form, unit, measured, marked)
            if marked:
                _bar(top, imgui.get_item_rect_max().y, unit)

    def _block(self, block: object, form: Form, unit: float, measured: bool, marked: bool) -> None:
        match block:
            case Paragraph():
                imgui.text_wrapped(self.texts.fill(block.text, block.values))
            case Scale():
                self._question(self.texts.fill(block.text, block.values), marked)
                slider = block.slider or block.steps > MOST_RADIOS
                self._slider(block, form) if slider else self._radios(block, form)
            case Choice():
                if block.text:
                    self._question(self.texts.get(block.text), marked)
                self._choice(block, form)
            case Several():
                self._question(self.texts.get(block.text), marked)
                self._several(block, form)
            case Ranking():
                self._question(self.texts.get(block.text), marked)
                self._ranking(block, form)
            case TextField():
                self._question(self.texts.get(block.text), marked)
                self._text_field(block, form, unit, measured)
            case PlatePicture():
                _plate(block.plate, 0.42 * unit, measured)
            case PlanPicture():
                self._plan(block, block.height * unit)
            case Picture():
                self._picture(block, int(block.height * unit), measured)

    def _question(self, text: str, marked: bool) -> None:
        if marked:
            imgui.push_style_color(imgui.Col_.text, COLORS["wrong"])
        imgui.text_wrapped(text)
        if marked:
            imgui.pop_style_color()

    def _radios(self, scale: Scale, form: Form) -> None:
        """A scale's steps between its ends; the ends above it where all do not fit in a line."""
        low, high = self.texts.get(scale.low), self.texts.get(scale.high)
        gap = imgui.get_style().item_spacing.x
        names = [str(scale.first + number) for number in range(scale.steps)]
        wide = sum(_radio_width(name) + gap for name in names)
        ends = imgui.calc_text_size(low).x + imgui.calc_text_size(high).x + 2 * gap
        beside = wide + ends <= imgui.get_content_region_avail().x
        if beside:
            imgui.align_text_to_frame_padding()
            imgui.text_disabled(low)
        else:
            _disabled_wrapped(_ends(scale, low, high))
        for number, name in enumerate(names):
            if number or beside:
                _beside(_radio_width(name))
            chosen = form.answers.get(scale.name) == str(number)
            if imgui.radio_button(f"{name}##{scale.name}", chosen):
                form.answers[scale.name] = str(number)
            ring()
        if beside:
            imgui.same_line()
            imgui.text_disabled(high)

    def _slider(self, scale: Scale, form: Form) -> None:
        """A scale of many steps: unanswered until it was touched."""
        low, high = self.texts.get(scale.low), self.texts.get(scale.high)
        gap, room = imgui.get_style().item_spacing.x, imgui.get_content_region_avail().x
        left = room - imgui.calc_text_size(low).x - imgui.calc_text_size(high).x - 2 * gap
        beside = left >= 0.3 * room
        if beside:
            imgui.align_text_to_frame_padding()
            imgui.text_disabled(low)
            imgui.same_line()
        else:
            _disabled_wrapped(_ends(scale, low, high))
        imgui.set_next_item_width(min(0.5 * room, left) if beside else room)
        answered = scale.name in form.answers
        value = scale.first + int(form.answers.get(scale.name, (scale.steps - 1) // 2))
        changed, value = imgui.slider_int(
            f"##{scale.name}",
            value,
            scale.first,
            scale.first + scale.steps - 1,
            "%d" if answered else "?",
            imgui.SliderFlags_.always_clamp,  # a number may be typed as well
        )
        ring()
        if changed or imgui.is_item_activated():
            form.answers[scale.name] = str(value - scale.first)
        self.on_slider |= imgui.is_item_focused() and self.interface.io.nav_visible
        if beside:
            imgui.same_line()
            imgui.text_disabled(high)

    def _choice(self, choice: Choice, form: Form) -> None:
        """Options side by side where they fit, else one below the other."""
        gap = imgui.get_frame_height() + 3 * imgui.get_style().item_spacing.x
        widths = [imgui.calc_text_size(self.texts.get(o)).x + gap for o in choice.options]
        beside = sum(widths) <= imgui.get_content_region_avail().x
        for number, option in enumerate(choice.options):
            if number and beside:
                imgui.same_line(0, 2 * imgui.get_style().item_spacing.x)
            chosen = form.answers.get(choice.name) == str(number)
            if _option(
                imgui.radio_button, self.texts.get(option), f"{choice.name}{number}", chosen
            ):
                form.answers[choice.name] = str(number)

    def _several(self, asked: Several, form: Form) -> None:
        """Boxes to tick, one below the other."""
        ticked = {int(n) for n in form.answers.get(asked.name, "").split(",") if n}
        for number, option in enumerate(asked.options):
            name, chosen = f"{asked.name}{number}", number in ticked
            if _option(_checkbox, self.texts.get(option), name, chosen):
                ticked ^= {number}
        form.answers[asked.name] = ",".join(map(str, sorted(ticked)))

    def _ranking(self, asked: Ranking, form: Form) -> None:
        """A line of ranks for each option; who takes another's rank gives it the one it had."""
        count = len(asked.options)
        ranks = form.answers.get(asked.name, "," * (count - 1)).split(",")
        gap, room = imgui.get_style().item_spacing.x, imgui.get_content_region_avail().x
        for number, option in enumerate(asked.options):
            for rank in map(str, range(1, count + 1)):
                if rank != "1":
                    _beside(_radio_width(rank))
                if imgui.radio_button(f"{rank}##{asked.name}{number}", ranks[number] == rank):
                    other = ranks.index(rank) if rank in ranks else number
                    ranks[other], ranks[number] = ranks[number], rank
                ring()
            text = self.texts.get(option)
            _beside(min(imgui.calc_text_size(text).x, 0.4 * room) + gap)
            imgui.align_text_to_frame_padding()
            imgui.text_wrapped(text)
        form.answers[asked.name] = ",".join(ranks)

    def _text_field(self, field_: TextField, form: Form, unit: float, measured: bool) -> None:
        """A field; beside one for a number stands what is wrong with it."""
        name, text = f"##{field_.name}", form.answers.get(field_.name, "")
        room = imgui.get_content_region_avail().x
        if field_.lines == 1:
            imgui.set_next_item_width(0.3 * room)
            _, text = imgui.input_text(name, text)
            ring()
            text = _stepped(field_, text) if field_.most is not None else text
        else:
            size = imgui.ImVec2(room, 0.05 * field_.lines * unit)
            _, text = imgui.input_text_multiline(name, text, size)
            ring()
        form.answers[field_.name] = text
        wrong = form.insisted and not field_.takes(text)
        if wrong or (measured and field_.most is not None):
            limits = (("most", f"{field_.most:g}"), ("least", f"{field_.least:g}"))
            values = ((field_.name, text.strip()[:20]), ("answer", text.strip()[:20]), *limits)
            imgui.same_line()
            imgui.push_style_color(imgui.Col_.text, COLORS["wrong"])
            imgui.text_wrapped(self.texts.fill(field_.wrong, values))
            imgui.pop_style_color()

    def _picture(self, picture: Picture, high: int, measured: bool) -> None:
        wide = round(high * PICTURE_ASPECT)
        size = imgui.ImVec2(wide, high)
        if measured:
            imgui.dummy(size)
            return
        corner = imgui.get_cursor_screen_pos()
        upside, down = imgui.ImVec2(0, 1), imgui.ImVec2(1, 0)  # row 0 of a texture is its lowest
        imgui.image(imgui.ImTextureRef(self.picture(picture, wide, high)), size, upside, down)
        lines = imgui.get_window_draw_list()
        insets = [e for e in picture.view.hud if isinstance(e, Inset)]
        for number, inset in enumerate(insets):
            name, r = self.inset(number, inset, high), inset.rect
            low = imgui.ImVec2(corner.x + r.x * high, corner.y + r.y * high)
            far = imgui.ImVec2(low.x + r.width * high, low.y + r.height * high)
            lines.add_image(imgui.ImTextureRef(name), low, far, upside, down)
            lines.add_rect(low, far, rgba(0.55, 0.58, 0.62), thickness=thick(2.0))

    def _plan(self, picture: PlanPicture, side: float) -> None:
        """The plan, and beside it what its signs mean."""
        corner, lines = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
        rect = picture.plan.rect
        scale = side / rect.height
        draw_plan(
            lines, picture.plan, scale, (corner.x - rect.x * scale, corner.y - rect.y * scale)
        )
        imgui.dummy(imgui.ImVec2(rect.width * scale, side))
        imgui.same_line()
        imgui.begin_group()
        radius, high = 0.018 * scale, imgui.get_text_line_height()
        for text, draw_sign in _signs(picture.plan):
            at = imgui.get_cursor_screen_pos()
            draw_sign(lines, imgui.ImVec2(at.x + 1.5 * radius, at.y + high / 2), radius)
            imgui.dummy(imgui.ImVec2(3 * radius, high))
            imgui.same_line()
            imgui.text_wrapped(self.texts.get(text))
        imgui.end_group()


def _signs(plan: FloorPlan) -> Iterator[tuple[str, Callable[..., None]]]:
    """What each sign on a plan means, and what draws it."""
    yield "plan.place", draw_place
    yield "plan.mark", draw_mark
    if plan.start is not None:
        yield "plan.start", draw_start
    if plan.here is not None:
        yield "plan.here", draw_here


def _stepped(field_: TextField, text: str) -> str:
    """Buttons beside a field for a number, for who has no keyboard at hand: held down, they go on.
    The keyboard passes them by."""
    assert field_.most is not None
    span = field_.most - field_.least
    far = 10.0 ** max(0, floor(log10(span)) - 1) if span > 20 else 1.0
    far = max(far, 10.0) if span > 20 else far
    steps = (-far, -1.0, 1.0, far) if far > 1 else (-1.0, 1.0)
    for which, color in PALE.items():
        imgui.push_style_color(which, color)
    imgui.push_item_flag(imgui.ItemFlags_.no_nav, True)
    imgui.push_item_flag(imgui.ItemFlags_.button_repeat, True)
    for step in steps:
        imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
        sign = "+" if step > 0 else "\u2212"
        label = sign if abs(step) == 1 else f"{sign}{abs(step):g}"
        if imgui.button(f"{label}##{field_.name}{step:g}"):
            fine = text.strip() and field_.takes(text)
            value = float(text.replace(",", ".")) + step if fine else max(field_.least, 0.0)
            text = f"{min(max(value, field_.least), field_.most):.10g}"
    imgui.pop_item_flag()
    imgui.pop_item_flag()
    imgui.pop_style_color(len(PALE))
    return text


def ring() -> None:
    """About what was drawn last, if the keyboard is on it. ImGui's own ring is as thin on every
    display, and touches the words beside a circle."""
    if not (imgui.get_io().nav_visible and imgui.is_item_focused()):
        return
    low, high, off = imgui.get_item_rect_min(), imgui.get_item_rect_max(), thick(3.0)
    imgui.get_window_draw_list().add_rect(
        imgui.ImVec2(low.x - off, low.y - off),
        imgui.ImVec2(high.x + off, high.y + off),
        COLORS["focus"],
        thickness=thick(2.0),
    )


def _beside(width: float) -> None:
    """What comes next stands beside what came last where it fits, else below."""
    imgui.same_line()
    if imgui.get_content_region_avail().x < width:
        imgui.new_line()


def _radio_width(text: str) -> float:
    inner = imgui.get_style().item_inner_spacing.x
    return float(imgui.get_frame_height() + inner + imgui.calc_text_size(text).x)


def _checkbox(name: str, chosen: bool) -> bool:
    return bool(imgui.checkbox(name, chosen)[0])


def _option(draw: Callable[[str, bool], bool], text: str, name: str, chosen: bool) -> bool:
    """A circle or box and its words, which are wrapped where they are too long for a line."""
    gap = imgui.get_style().item_inner_spacing.x
    room = imgui.get_content_region_avail().x - imgui.get_frame_height() - gap
    if imgui.calc_text_size(text).x <= room:
        pressed = draw(f"{text}##{name}", chosen)
        ring()
        return pressed
    pressed = draw(f"##{name}", chosen)
    ring()
    imgui.same_line(0, gap)
    imgui.align_text_to_frame_padding()
    imgui.text_wrapped(text)
    return bool(pressed or imgui.is_item_clicked())


def _ends(scale: Scale, low: str, high: str) -> str:
    return f"{scale.first}: {low}   {scale.first + scale.steps - 1}: {high}"


def _disabled_wrapped(text: str) -> None:
    imgui.push_style_color(imgui.Col_.text, imgui.get_style_color_vec4(imgui.Col_.text_disabled))
    imgui.text_wrapped(text)
    imgui.pop_style_color()


def _bar(top: imgui.ImVec2, bottom: float, unit: float) -> None:
    """A bar in the margin, beside what is missing: not by colour alone."""
    low = imgui.ImVec2(top.x - 0.022 * unit, top.y)
    high = imgui.ImVec2(top.x - 0.014 * unit, bottom)
    imgui.get_window_draw_list().add_rect_filled(low, high, COLORS["wrong"])


def _plate(plate: Plate, side: float, measured: bool) -> None:
    """A plate of dots at the cursor, `side` pixels wide."""
    corner, dots = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    if not measured:
        for (x, y), radius, color in zip(plate.places, plate.radii, plate.colors, strict=True):
            center = imgui.ImVec2(corner.x + x * side, corner.y + y * side)
            dots.add_circle_filled(center, radius * side, rgba(*color), 20)
    imgui.dummy(imgui.ImVec2(side, side))
