"""Where the ink of pages and HUDs lies: `python tests/support/ink_figures.py` writes it anew.

Texts and things are the test's own, so that a sentence put otherwise changes nothing here: a page's
layout or the look of a HUD is changed on purpose, in a commit of its own, which writes these
figures (tests/data/pages/ink.json) with it.
"""

from __future__ import annotations

import ctypes
import json
from pathlib import Path

import numpy as np
from imgui_bundle import imgui

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.color_plates import Plate
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.hud_drawing import HudDrawing, draw_progress
from seethrough.experiment.pages.interface import INSET_TEXTURES
from seethrough.experiment.pages.pages import (
    Choice,
    Page,
    Paragraph,
    Picture,
    PlanPicture,
    PlatePicture,
    Scale,
    TextField,
)
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.gpu.overlay import STRIDE
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import Button, Entry, FloorPlan, Inset, Label, Rect

FIGURES = Path(__file__).resolve().parents[1] / "data" / "pages" / "ink.json"
SMALL = INSET_TEXTURES + 1  # the texture that stands for every picture
LONG = "Words of a sentence that is rather longer than most of them are. "


class Words(Texts):
    """Texts that are their own keys; the tree's for what pages say by themselves."""

    def __init__(self):
        super().__init__("en")
        self._texts = {"decimal": ".", "page.missing": "{open} to do", "page.more": "More below"}


def small_stage(context, size):
    """A stage whose pictures are all one small texture."""
    stage = Stage(context, size, Words())
    stage.interface.overlay.adopt_texture(SMALL, context.texture((4, 3), 4))
    stage._picture = stage._inset = lambda *words, **more: SMALL
    return stage


PLAN = FloorPlan(
    Rect(0.2, 0.1, 0.6, 0.6),
    (((0.2, 0.1), (0.8, 0.1)), ((0.5, 0.1), (0.5, 0.45))),
    mark=(0.32, 0.21),
    place=(0.61, 0.55),
)
INSET = Inset(None, lambda: None, Rect(0.04, 0.5, 0.21, 0.17))


def huds():
    """{name: elements}: each kind, in each of its states."""
    labels = {
        f"label {align} {tone} {len(text)}": (Label(text, at, 0.04, align, tone=tone),)
        for text in ("Short", 2 * LONG)
        for tone, align, at in (
            ("plain", "left", (0.3, 0.2)),
            ("hint", "center", (0.6, 0.5)),
            ("practice", "right", (1.2, 0.8)),
        )
    }
    rect = Rect(0.3, 0.6, 0.11, 0.07)
    plain = {
        "button": (Button("7", rect),),
        "button chosen": (Button("7", rect, chosen=True),),
        "button long": (Button("Something longer", rect),),
        "entry": (Entry("42", Rect(0.5, 0.7, 0.2, 0.06)),),
        "entry empty": (Entry("", Rect(0.5, 0.7, 0.2, 0.06)),),
        "plan": (PLAN,),
        "plan without": (FloorPlan(PLAN.rect, PLAN.walls),),
        "insets": (INSET, Inset(None, lambda: None, Rect(0.7, 0.3, 0.2, 0.2))),
    }
    return labels | plain


def forms():
    """{name: form}: each kind of block, in each of its states."""
    scales = Page(
        "a", "A title", (Scale("x", LONG, "none", "all"), Scale("y", "Q", "no", "yes", 7))
    )
    sliders = Page(
        "b", "A title", (Scale("x", "Q", "none", "all", 21), Scale("y", "Q", LONG, LONG, 21))
    )
    ends = Page("c", "A title", (Scale("x", "Q", LONG, LONG, 7),))
    short = Page(
        "d", "A title", (Choice("x", "Q", ("one", "two", "three")), Choice("y", "", ("a",)))
    )
    long = Page(
        "e", "A title", (Choice("x", "Q", (LONG, 3 * LONG, "three")),), ("go", "stay", "leave")
    )
    typed = Page(
        "f", "A title", (TextField("x", "Q"), TextField("y", "Q", 1, 99, "{y}: up to {most}"))
    )
    seen = Picture(lambda: View(None, None, (INSET,)), None)
    plate = PlatePicture(Plate(5, False, np.random.default_rng(3)))
    crowd = tuple(Scale(f"s{n}", LONG, "none", "all") for n in range(14))
    several = ("one button", "another button", "a third button")
    wide = tuple(f"{n} {LONG}" for n in range(3))
    return {
        "scales": Form(scales),
        "scales answered": Form(scales, {"x": "0", "y": "6"}),
        "scales insisted": Form(scales, {"x": "2"}, insisted=True),
        "sliders": Form(sliders, {"y": "17"}),
        "scales ends": Form(ends),
        "choices": Form(short, {"x": "1"}, insisted=True),
        "choices long": Form(long, {"x": "1"}),
        "fields": Form(typed, {"x": "some words", "y": "7"}),
        "fields wrong": Form(typed, {"y": "700"}, insisted=True),
        "picture": Form(Page("g", "A title", (Paragraph(LONG), seen))),
        "plan": Form(Page("h", "A title", (PlanPicture(PLAN), Paragraph("Below")))),
        "plate": Form(Page("i", "A title", (plate, Choice("x", "Q", ("5", "6"))))),
        "crowd": Form(Page("j", "A title", crowd)),
        "text": Form(Page("k", "A title", (Paragraph(9 * LONG),), several)),
        "text long": Form(Page("l", "A title", (Paragraph(120 * LONG),), several)),
        "buttons": Form(Page("m", LONG, (), wide)),
        "waiting": Form(Page("n", "A title", ()), waiting="Making it"),
    }


def ink():
    """{picture and colour: (triangles, area, left, top, right, bottom, middle x, y)} in pixels, of
    what ImGui drew last."""
    found = {}
    for commands in imgui.get_draw_data().cmd_lists:
        vertices = np.frombuffer(
            ctypes.string_at(
                commands.vtx_buffer.data_address(), commands.vtx_buffer.size() * STRIDE
            ),
            [("at", "2f4"), ("uv", "2f4"), ("color", "u4")],
        )
        raw = ctypes.string_at(
            commands.idx_buffer.data_address(), commands.idx_buffer.size() * imgui.INDEX_SIZE
        )
        indices = np.frombuffer(raw, np.uint16 if imgui.INDEX_SIZE == 2 else np.uint32)
        for command in commands.cmd_buffer:
            chosen = indices[command.idx_offset : command.idx_offset + command.elem_count]
            corners = vertices[chosen.astype(int) + command.vtx_offset].reshape(-1, 3)
            picture = " picture" if command.tex_ref.get_tex_id() == SMALL else ""
            for color in np.unique(corners["color"]):
                own = corners["at"][(corners["color"] == color).any(axis=1)].astype(float)
                found.setdefault(f"{color:08x}{picture}", []).append(own)
            if picture:  # which corner of it lies where: a picture's rows begin at the bottom
                found.setdefault("picture corners", []).append(corners["uv"].astype(float))
    return {name: _figures(np.concatenate(parts)) for name, parts in sorted(found.items())}


def _figures(corners):
    (ax, ay), (bx, by) = (corners[:, k].T - corners[:, 0].T for k in (1, 2))
    area = np.abs(ax * by - ay * bx).sum() / 2
    flat = corners.reshape(-1, 2)
    numbers = (area, *flat.min(axis=0), *flat.max(axis=0), *flat.mean(axis=0))
    return [len(corners), *(round(float(v), 2) for v in numbers)]


def hud_ink(stage, target, elements, size):
    """What a HUD's elements, a pointer and the progress line put on a screen of this size."""
    stage.interface.begin(size, 1 / 60)
    hud = HudDrawing(stage.interface, stage.texts, size[1], lambda *_: SMALL)
    hud.draw(elements)
    hud.draw_pointer((0.9, 0.1))
    draw_progress(size, 0.3, False)
    stage.interface.end(target)
    return ink()


def form_ink(stage, target, form):
    """What a page puts on the stage's screen once its layout has settled."""
    for _ in range(3):
        stage.draw_form(form, target, 1 / 60)
    return ink()


def everything(context, size=(800, 600)):
    """{name: ink} of all of it."""
    stage, target = small_stage(context, size), context.framebuffer([context.texture((8, 6), 4)])
    made = {f"hud {name}": hud_ink(stage, target, e, size) for name, e in huds().items()}
    stage.interface.close()
    for name, form in forms().items():  # each on a stage of its own: a focus stays
        stage = small_stage(context, size)
        made[f"page {name}"] = form_ink(stage, target, form)
        stage.interface.close()
    return made


if __name__ == "__main__":
    from seethrough.renderer.gpu.device.context import standalone

    rows = [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in everything(standalone()).items()]
    FIGURES.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")
