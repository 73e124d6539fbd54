"""Tables as CSV files, at full precision: what the page rounds can be looked up here."""

from __future__ import annotations

import csv
import io

from seethrough.analysis.page.blocks import Table
from seethrough.analysis.stats.undefined import Undefined


def cell(value: object) -> str:
    """A value as the CSV has it; undefined quantities keep their reason."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Undefined):
        return str(value)
    return repr(float(value)) if isinstance(value, float) else str(value)


def as_csv(table: Table) -> str:
    """The whole table, all columns."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([c.name for c in table.columns])
    for row in table.rows:
        writer.writerow([cell(row.get(c.name)) for c in table.columns])
    return out.getvalue()
