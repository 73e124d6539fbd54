"""The report as one self-contained HTML file: no network, no other file needed."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files

from jinja2 import Environment, FunctionLoader, StrictUndefined
from markupsafe import Markup, escape

from analysis.page.blocks import Block, Cited, Figure, Fold, Prose, Report, Table
from analysis.page.numbers import show
from analysis.page.tables_csv import cell

MOST_ROWS = 60


def _template(name: str) -> str:
    return (files("analysis.page") / "templates" / name).read_text(encoding="utf-8")


def _environment() -> Environment:
    env = Environment(
        loader=FunctionLoader(_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    env.filters["prose"] = prose
    env.globals.update(show=show, exact=cell, kind_of=kind_of, most_rows=MOST_ROWS)
    return env


def kind_of(block: Block) -> str:
    """Which macro draws a block."""
    kinds: dict[type, str] = {Prose: "prose", Table: "table", Figure: "figure", Fold: "fold"}
    return kinds[type(block)]


def prose(block: Prose) -> Markup:
    """A paragraph's runs; each cited number knows its table, row and column."""
    return Markup("").join(_run(run) for run in block.runs)


def _run(run: str | Cited) -> Markup:
    if isinstance(run, str):
        return escape(run)
    return Markup(
        '<data value="{}" data-from="{}" data-row="{}" data-column="{}">{}</data>'
    ).format(cell(run.value), f"{run.table}.csv", run.row, run.column, run.text)


def as_html(report: Report, pictures: Mapping[str, str], version: str) -> str:
    """The page. `pictures` maps a figure's key to its inline SVG; `version` ours."""
    page = _environment().get_template("report.html.j2")
    return page.render(
        report=report,
        pictures={key: Markup(svg) for key, svg in pictures.items()},
        version=version,
        css=Markup(_template("report.css")),
        script=Markup(_template("report.js")),
    )
