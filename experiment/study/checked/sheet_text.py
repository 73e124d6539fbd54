"""Texts on contact sheets, in the pages' own font: what a study calls things can be read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from seethrough.experiment.study.translations import unshowable

if TYPE_CHECKING:
    from PIL.ImageFont import FreeTypeFont


def font(size: int) -> FreeTypeFont:
    """The pages' font, in pixels."""
    from PIL import ImageFont

    from seethrough.experiment.pages.interface import FONTS, REGULAR

    return ImageFont.truetype(FONTS / REGULAR, size)


def fitted(text: str, own: FreeTypeFont, width: float) -> str:
    """The text with ? for what the font has no picture of, cut with … where it is wider than
    `width` pixels."""
    text = "".join(c if not unshowable(c) else "?" for c in text)
    if own.getlength(text) <= width:
        return text
    while text and own.getlength(f"{text}…") > width:
        text = text[:-1]
    return f"{text}…"
