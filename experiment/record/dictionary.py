"""Makes the data dictionary of data/README.md from the columns."""

from __future__ import annotations

import sys
from pathlib import Path

from seethrough.experiment.generated import write_anew
from seethrough.experiment.record.columns import FACTORS_AFTER, TABLES, Column

README = Path(__file__).resolve().parents[2] / "data" / "README.md"
BEGIN = (
    "<!-- made by `python -m seethrough.experiment.record.dictionary`: "
    "change experiment/record/columns.py, not this -->"
)
FACTORS = "| *each factor* | text |  | its level, by the name that the study gives it |"
END = "<!-- end of what is made -->"


def _row(column: Column) -> str:
    """A line of the table: levels belong to the meaning."""
    levels = f": {', '.join(f'`{level}`' for level in column.levels)}" if column.levels else ""
    return f"| `{column.name}` | {column.type} | {column.unit} | {column.description}{levels} |"


def dictionary() -> str:
    """Markdown: a heading and a table for each table that the recorder writes."""
    parts = []
    for name, columns in TABLES.items():
        head = [f"## `…_{name}_data.csv`", "", "| column | type | unit | meaning |"]
        rows = list(map(_row, columns))
        at = [i for i, column in enumerate(columns, start=1) if column.name == FACTORS_AFTER[name]]
        for place in at:
            rows.insert(place, FACTORS)
        parts.append("\n".join([*head, "| --- | --- | --- | --- |", *rows]))
    return "\n\n".join(parts)


def with_dictionary(text: str) -> str:
    """`text` with what stands between the two marks made anew.

    Raises ValueError where a mark is missing: the rest of the file is written by hand.
    """
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise ValueError(f"data/README.md: expected the marks {BEGIN} and {END}")
    return f"{before}{BEGIN}\n\n{dictionary()}\n\n{END}{after}"


def page() -> str:
    """data/README.md as it has to be. Raises ValueError where it has no marks."""
    return with_dictionary(README.read_text("utf-8"))


if __name__ == "__main__":
    sys.exit(write_anew(README, page, "It lists the columns of all tables."))
