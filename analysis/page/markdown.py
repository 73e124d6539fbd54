"""The report as Markdown, with the figures as files beside it."""

from __future__ import annotations

from seethrough.analysis.page.blocks import Block, Cited, Figure, Prose, Report, Table, row_texts
from seethrough.analysis.page.html import MOST_ROWS


def as_markdown(report: Report) -> str:
    """The whole report."""
    lines = [f"# {_plain(report.title)}", "", _plain(report.subtitle), ""]
    if report.banner:
        lines += [f"> **{_plain(report.banner)}**", ""]
    for section in report.sections:
        lines += [f"## {_plain(section.title)}", ""]
        for block in section.blocks:
            lines += _block(block)
    return "\n".join(lines).rstrip() + "\n"


def _block(block: Block) -> list[str]:
    if isinstance(block, Prose):
        text = "".join(_run(run) for run in block.runs)
        marks = {"warning": "> ⚠ ", "note": "*", "answer": "> "}
        start = marks.get(block.kind, "")
        return [f"{start}{text}{'*' if block.kind == 'note' else ''}", ""]
    if isinstance(block, Figure):
        return [f"![{_plain(block.alt)}](figures/{block.key}.svg)", "", f"*{block.title}.*", ""]
    if isinstance(block, Table):
        return _table(block)
    inner = [line for b in block.blocks for line in _block(b)]
    return [f"### {_plain(block.summary)}", "", *inner]


def _run(run: str | Cited) -> str:
    return _plain(run if isinstance(run, str) else run.text)


def _table(table: Table) -> list[str]:
    columns = table.visible()
    heads = [_plain(f"{c.label} {c.about}".rstrip()) for c in columns]
    rule = ["---" if c.style == "text" else "---:" for c in columns]
    rows = [[_plain(text) for text in row_texts(table, row)] for row in table.rows[:MOST_ROWS]]
    lines = [f"**{_plain(table.title)}**", ""]
    lines += [f"| {' | '.join(cells)} |" for cells in (heads, rule, *rows)]
    note = f"{table.note} " if table.note else ""
    return [*lines, "", f"*{note}All rows and columns: tables/{table.file}.*", ""]


def _plain(text: str) -> str:
    """Text that Markdown shows as it is."""
    for sign in ("\\", "|", "*", "_", "`", "<", "["):
        text = text.replace(sign, f"\\{sign}")
    return text.replace("\n", " ")
