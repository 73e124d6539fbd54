"""The report as one self-contained HTML file: no network, no other file needed."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.resources import files

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup, escape

from seethrough.analysis.page.blocks import (
    Block,
    Cited,
    Figure,
    Fold,
    Prose,
    Report,
    Table,
    row_texts,
)
from seethrough.analysis.page.tables_csv import cell

MOST_ROWS = 60
_CITED = Markup(
    '<data value="{}" data-from="{}" data-row="{}" data-column="{}" '
    'title="tables/{}: {}, {}">{}</data>'
)
_SYMBOL = re.compile(
    r"(?<![\w<])(SD|df|[FtpnMrWV]|χ)(?=\(|²\(|\u00a0=|\s(?:&lt;|≤|\(|$)|\u00a0$|$)"
)


def template(name: str) -> str:
    """A file of the page's templates."""
    return (files("seethrough.analysis.page") / "templates" / name).read_text(encoding="utf-8")


def _environment() -> Environment:
    env = Environment(
        loader=FunctionLoader(template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    env.filters["prose"] = prose
    env.filters["signs"] = signs
    env.globals.update(exact=cell, kind_of=kind_of, most_rows=MOST_ROWS, texts=row_texts)
    return env


def kind_of(block: Block) -> str:
    """Which macro draws a block."""
    kinds: dict[type, str] = {Prose: "prose", Table: "table", Figure: "figure", Fold: "fold"}
    return kinds[type(block)]


def prose(block: Prose) -> Markup:
    """A paragraph's runs; each cited number knows its table, row and column."""
    return Markup("").join(_run(run) for run in block.runs)


def signs(text: str) -> Markup:
    """Text with the field's symbols set as APA sets them, and numbers kept with their units."""
    out = str(escape(re.sub(r" (?=[=%])|(?<==) |(?<=\bp) $", "\u00a0", text)))
    out = out.replace("d_z", "<i>d</i><sub>z</sub>")
    out = re.sub("η²([pG])", r"<i>η</i>²<sub>\1</sub>", out)
    return Markup(_SYMBOL.sub(r"<i>\1</i>", out))


def _run(run: str | Cited) -> Markup:
    if isinstance(run, str):
        return signs(run)
    text = run.text.replace(" ", "\u00a0") if len(run.text) < 16 else run.text
    where = (cell(run.value), run.file, run.row, run.column, run.file, run.row, run.column)
    return _CITED.format(*where, text)


def as_html(report: Report, pictures: Mapping[str, str], version: str, library: str = "") -> str:
    """The page. `pictures` maps a figure's key to its chart; `version` ours; `library` Vega."""
    page = _environment().get_template("report.html.j2")
    return page.render(
        report=report,
        pictures={key: Markup(svg) for key, svg in pictures.items()},
        version=version,
        css=Markup(template("report.css")),
        library=Markup(library),
        script=Markup(template("report.js")),
    )
