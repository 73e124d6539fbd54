"""Figures as SVG, PNG and PDF files, and as charts in the page that can be pointed at.

Vega draws both: here through vl-convert, in the page by itself. A drawing of each chart stands in
the page until the script has run, so that a reader without scripts sees it too.
"""

from __future__ import annotations

import json
import re
from functools import cache
from html import escape
from pathlib import Path

import vl_convert

from seethrough.analysis.files.written import write_over
from seethrough.analysis.page.blocks import Figure
from seethrough.analysis.page.style import FAINT, INK, PALETTE, RULE

_VARIABLES = {
    INK: "var(--ink)",
    RULE: "var(--rule)",
    FAINT: "var(--faint)",
    **{colour: f"var(--level-{i})" for i, colour in enumerate(PALETTE)},
}
_TEXT = {"labelColor": INK, "titleColor": INK, "labelFontSize": 11, "titleFontSize": 11}
_CONFIG: dict[str, object] = {
    "font": "Arial, Helvetica, Liberation Sans, sans-serif",
    "axis": {
        **_TEXT,
        "titleFontWeight": "normal",
        "domainColor": RULE,
        "gridColor": RULE,
        "tickColor": RULE,
    },
    "legend": _TEXT,
    "title": {"color": INK, "fontSize": 12, "fontWeight": "normal", "anchor": "start"},
    "view": {"stroke": None},
}
PNG_SCALE = 2.0


def whole(figure: Figure) -> dict[str, object]:
    """The figure's complete specification."""
    return {"description": figure.alt, "background": None, "config": _CONFIG, **figure.spec}


def write_files(figure: Figure, folder: Path) -> str:
    """Write KEY.svg, .png and .pdf into `folder`, which is there; the chart for the page."""
    plain = whole(figure)
    svg = _named(vl_convert.vegalite_to_svg(plain), figure)
    write_over(folder / f"{figure.key}.svg", svg)
    write_over(folder / f"{figure.key}.pdf", vl_convert.svg_to_pdf(svg))
    white = svg.replace(">", '><rect width="100%" height="100%" fill="white"/>', 1)
    write_over(folder / f"{figure.key}.png", vl_convert.svg_to_png(white, scale=PNG_SCALE))
    return _in_page(plain, svg)


def _named(svg: str, figure: Figure) -> str:
    """Title and description for those who see the file alone."""
    about = f"<title>{escape(figure.title)}</title><desc>{escape(figure.alt)}</desc>"
    return svg.replace(">", f' role="img">{about}', 1)


def _in_page(spec: dict[str, object], svg: str) -> str:
    """The drawing, and the specification that takes its place; colours follow light and dark."""
    # "</" would end the script element
    text = json.dumps(spec, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    for colour, variable in _VARIABLES.items():
        svg, text = svg.replace(colour, variable), text.replace(colour, variable)
    # ids of many drawings would meet in one page; what is clipped at the frame's edge stays clipped
    svg = re.sub(r'\s(?:id|clip-path)="[^"]*"', "", svg)
    return (
        f'<div class="chart">{svg}</div>'
        f'<script type="application/json" class="chart-spec">{text}</script>'
    )


@cache  # two seconds of work, always with the same result
def library() -> str:
    """Vega, Vega-Lite and vega-embed as one script that needs no network."""
    return str(vl_convert.javascript_bundle("window.vegaEmbed = vegaEmbed;")).replace(
        "</script", "<\\/script"
    )
