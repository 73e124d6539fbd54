"""Figures as SVG, PNG and PDF files, and as SVG inside the page, with marks that can be pointed at.

One drawing makes all of them. In the page its colours become CSS variables, so that it follows
light and dark, and each mark gets a title, a label and a place in the keyboard's order.
"""

from __future__ import annotations

import io
import re
from html import escape
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure as Canvas

from analysis.figures.style import DYNAMIC, FAINT, INK, RULE, STANDARD
from analysis.page.blocks import Figure, Tips

_VARIABLES = {
    INK: "--ink",
    RULE: "--rule",
    FAINT: "--faint",
    STANDARD: "--standard",
    DYNAMIC: "--dynamic",
}

_STYLE: Any = {
    "axes.edgecolor": RULE,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "axes.axisbelow": True,
    "axes.labelcolor": INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlecolor": INK,
    "axes.titlesize": 10,
    "axes.titleweight": "normal",
    "axes.labelsize": 9,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "font.family": "sans-serif",
    "font.size": 9,
    "grid.color": RULE,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "lines.linewidth": 1.2,
    "savefig.facecolor": "none",
    "svg.fonttype": "none",
    "svg.hashsalt": "seethrough",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
}


def drawn(figure: Figure) -> tuple[Canvas, Tips]:
    """The figure on a fresh canvas."""
    with mpl.rc_context(_STYLE):
        canvas, tips = Canvas(figsize=figure.size, layout="constrained"), Tips()
        figure.draw(canvas, tips)
        return canvas, tips


def write_files(figure: Figure, folder: Path, formats: tuple[str, ...]) -> str:
    """Write `figure` as KEY.svg, .png, … into `folder`; returns the SVG for the page."""
    canvas, tips = drawn(figure)
    with mpl.rc_context(_STYLE):
        svg = _svg(canvas)
        canvas.set_layout_engine("none")  # laid out once: every format is the same picture
        for kind in formats:
            path = folder / f"{figure.key}.{kind}"
            if kind == "svg":
                path.write_text(_marked(svg, tips, figure, inline=False), encoding="utf-8")
            elif kind == "png":
                canvas.savefig(path, format="png", dpi=144, facecolor="white")
            else:
                canvas.savefig(path, format="pdf", metadata={"CreationDate": None})
    return _themed(_marked(svg, tips, figure, inline=True))


def _svg(canvas: Any) -> str:
    buffer = io.StringIO()
    canvas.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return buffer.getvalue()


def _marked(svg: str, tips: Tips, figure: Figure, inline: bool) -> str:
    """Title, description and marks; ids get the figure's key, so that many fit one page."""
    key = f"picture-{figure.key}"
    svg = re.sub(r'\b(id=")([^"]+")', rf"\1{key}-\2", svg)
    svg = re.sub(r'((?:xlink:)?href="#)', rf"\1{key}-", svg)
    svg = re.sub(r"(url\(#)", rf"\1{key}-", svg)
    start = svg.index("<svg")
    end = svg.index(">", start)
    names = f"{key}-title {key}-alt"
    # marks inside a role="img" would be hidden from screen readers
    role = "group" if inline else "img"
    opening = f'{svg[start:end]} role="{role}" aria-labelledby="{names}">'
    if inline:  # as wide as the page allows, and all figures' texts of one size
        opening = re.sub(r' (?:width|height)="[^"]+"', "", opening)
        opening = opening[:-1] + f' style="max-width: {7.5 * figure.size[0]:.1f}rem">'
    about = (
        f'<title id="{key}-title">{escape(figure.title)}</title>'
        f'<desc id="{key}-alt">{escape(figure.alt)}</desc>'
    )
    body = re.sub(r"<metadata>.*?</metadata>", "", svg[end + 1 :], flags=re.DOTALL)
    for name, text in tips.texts.items():
        said = escape(text)
        old = f'<g id="{key}-{name}">'
        new = f'<g class="mark" data-tip="{said}"><title>{said}</title>'
        body = body.replace(old, new)
    for name, texts in tips.lists.items():
        body = _each_marked(body, f"{key}-{name}", texts)
    head = "" if inline else '<?xml version="1.0" encoding="utf-8"?>\n'
    return head + opening + about + body


def _each_marked(body: str, name: str, texts: list[str]) -> str:
    """Wrap the markers of the group `name`, which come in the order of their points."""
    start = body.index(f'<g id="{name}">')
    said = iter(texts)

    def wrap(match: re.Match[str]) -> str:
        text = next(said, None)
        if text is None:  # past this group's markers
            return match.group()
        text = escape(text)
        return f'<g class="mark" data-tip="{text}"><title>{text}</title>{match.group()}</g>'

    return body[:start] + re.sub(r"<use [^>]*/>", wrap, body[start:])


def _themed(svg: str) -> str:
    """Colours as CSS variables with the printed colour behind, for light and dark."""
    for colour, name in _VARIABLES.items():
        svg = svg.replace(colour, f"var({name},{colour})")
    return re.sub(r"font: ([^;\"]*?)'[^;\"]*", r"font: \1system-ui, sans-serif", svg)
