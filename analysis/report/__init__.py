"""From a data folder to a report folder: the order of things, and the only place that writes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.exclude import apply_rules
from seethrough.analysis.files.written import FILE, half_of, own_folder, write_over
from seethrough.analysis.load.plan import TESTS, make_plan
from seethrough.analysis.load.study import Study, config_of, load_study
from seethrough.analysis.measures import levels_of
from seethrough.analysis.page.blocks import (
    Column,
    Figure,
    Fold,
    Report,
    Section,
    Table,
    walk,
)
from seethrough.analysis.page.glossary import meaning
from seethrough.analysis.page.html import as_html
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.page.tables_csv import as_csv
from seethrough.analysis.report import folder
from seethrough.analysis.report.pdf import find_browser, print_pdf
from seethrough.analysis.report.r_script import Facts, as_r
from seethrough.analysis.sections.base.asked import asked_alike, scales
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.methods import methods_section
from seethrough.analysis.sections.participants import participants_section
from seethrough.analysis.sections.provenance import provenance_section
from seethrough.analysis.sections.ratings import ratings_section
from seethrough.analysis.sections.scales import plain_section, speed_section
from seethrough.analysis.sections.sensitivity import sensitivity_section
from seethrough.analysis.sections.summary import Found, summary_section
from seethrough.analysis.sections.tests.omnibus import complete
from seethrough.analysis.sections.tradeoff import tradeoff_section
from seethrough.analysis.sections.validity import validity_section

SIMULATED = "Simulated participants: for planning only, never evidence about people."
UNCHAINED = "Tables without hash chains: whether they were changed cannot be known."
PILOT = "Pilot data: not part of the study."


@dataclass(frozen=True, slots=True)
class Options:
    """What may be chosen on the command line; None leaves the study's own plan in force."""

    source: str | None = None
    alpha: float | None = None
    exclude: Sequence[str] | None = None
    pairwise: tuple[str, ...] = ()
    aligned_ranks: bool = False
    seed: int = 1


def make_report(data: Path, options: Options) -> Report:
    """Load, analyse, and put into words; nothing is written. Raises DataError."""
    study = load_study(data, options.source)
    plan = make_plan(study, options.alpha, options.exclude, options.pairwise, options.aligned_ranks)
    trials, excluded = apply_rules(study.trials, plan.exclude, plan.too_fast)
    context = Context(study, plan, trials, excluded, options.seed)
    sections = _sections(context)
    banner = {"simulated": SIMULATED, "pilot": PILOT}.get(study.source, "")
    if any(chain.state == "none" for chain in study.chains):
        banner = f"{banner} {UNCHAINED}".strip()
    subtitle = f"Study {study.name}. Source: {study.source}. {study.description}"
    sections[-1] = with_dictionary(sections, (f.name for f in study.design.factors))
    script = as_r(_title(study), study.source, plan, study.design, _facts(context, sections))
    return Report(f"{_title(study)}: report", subtitle, banner, tuple(sections), script)


DICTIONARY = (
    Column("column", "column of a table"),
    Column("table", "table"),
    Column("title", "what the table holds"),
    Column("label", "heading"),
    Column("about", "meaning"),
)


def with_dictionary(sections: Sequence[Section], factors: Iterable[str] = ()) -> Section:
    """The last section, with what every column of every table means; `factors`: the study's."""
    names = frozenset(factors)
    tables = [b for s in sections for b in walk(s.blocks) if isinstance(b, Table) and not b.source]
    rows = tuple(
        {
            "column": f"{table.key}.{column.name}",
            "table": table.key,
            "title": table.title,
            "label": column.label,
            "about": meaning(column.name, column.about, names),
        }
        for table in tables
        for column in table.columns
    )
    words = Table("dictionary", "What each column means", DICTIONARY, rows,
                  ("column", "label", "about"))  # fmt: skip
    last = sections[-1]
    return replace(last, blocks=(*last.blocks, Fold("The columns of the tables", (words,))))


def _facts(context: Context, sections: Sequence[Section]) -> Facts:
    """What the script in R has to know of this report's choices."""
    tables = {b.key: b for s in sections for b in walk(s.blocks) if isinstance(b, Table)}
    mixed, scenes = tables.get("mixed_model"), tables.get("mixed_scenes")
    design = context.design
    levels = levels_of(context.trials, design.crossed)
    shape = (1, *(len(known) for known in levels.values()))
    whole, _ = complete(design, Cells(np.zeros(shape), np.ones(shape, np.intp), ("",), levels))
    names = [str(t.rows[0]["model"]) if t else "" for t in (mixed, scenes)]
    return Facts(whole.factors, names[0], names[1], asked_alike(context), scales(context))


def _title(study: Study) -> str:
    """The study's title, as its sessions recorded it; its name where none did."""
    abouts = (config_of(sidecar).get("study") for sidecar in study.sidecars.values())
    titles = (about.get("title") for about in abouts if isinstance(about, Mapping))
    return next((title for title in titles if isinstance(title, str)), f"Study {study.name}")


def _sections(context: Context) -> list[Section]:
    """All sections in reading order; `participants` comes late to know who is missing where."""
    time, timed = speed_section(context)
    accuracy, tests = plain_section(context)
    ratings = ratings_section(context)
    tables = [b for b in walk(ratings.blocks) if isinstance(b, Table)] if ratings else []
    single = next((t for t in tables if t.key == "single_items"), None)
    found = Found(timed | tests, single)
    optional = {
        "time": time,
        "accuracy": accuracy,
        "ratings": ratings,
        "tradeoff": tradeoff_section(context),
        "validity": validity_section(context),
    }
    if "mixed" in context.plan.tests:
        optional["mixed"] = sensitivity_section(context, found.speed(context.design))
    chosen = [optional[name] for name in TESTS if name in context.plan.tests]
    return [
        summary_section(context, found),
        participants_section(context),
        methods_section(context),
        *(section for section in chosen if section is not None),
        provenance_section(context),
    ]


def figures_of(sections: Iterable[Section | None]) -> list[Figure]:
    """Every figure, those inside folds too."""
    return [b for s in sections if s is not None for b in walk(s.blocks) if isinstance(b, Figure)]


def make_published() -> Report:
    """The report on the paper's own printed numbers."""
    from seethrough.analysis.published.report import published_report

    return published_report()


def write(
    out: Path, make: Callable[[], Report], formats: Sequence[str], replace: bool = False
) -> Path:
    """Make the report and write it into `out`; returns the page's path. Raises DataError.

    report.html, report.md, analysis.R, tables/*.csv, figures/*.{svg,png,pdf}; report.pdf if
    asked for.
    """
    from seethrough.analysis.page.charts import (
        library,
        write_files,
    )  # V8 starts only where charts are drawn

    old = folder.earlier(out, replace)
    browser = find_browser() if "pdf" in formats else ""
    report = make()
    folder.clear(old)
    if not out.is_dir():
        own_folder(out)
    figures, tables = own_folder(out / "figures"), own_folder(out / "tables")
    pictures = {f.key: write_files(f, figures) for f in figures_of(report.sections)}
    for table in tables_of(report):
        write_over(tables / f"{table.key}.csv", as_csv(table))
    write_over(out / "report.md", as_markdown(report))
    if report.script:
        write_over(out / "analysis.R", report.script)
    page = out / "report.html"
    write_over(page, as_html(report, pictures, version("seethrough"), library()))
    if browser:
        half = half_of(out / "report.pdf")
        try:
            print_pdf(browser, page, half)
            half.chmod(FILE)
            half.replace(out / "report.pdf")
        finally:
            half.unlink(missing_ok=True)
    return page


def tables_of(report: Report) -> list[Table]:
    """The tables that become files: not the further views of others."""
    blocks = [b for s in report.sections for b in walk(s.blocks)]
    return [b for b in blocks if isinstance(b, Table) and not b.source]
