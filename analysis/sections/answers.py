"""An answer to a prediction, and what all kinds of answers share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from seethrough.analysis.comparison import decisive
from seethrough.analysis.design import Contrast, Prediction
from seethrough.analysis.page.blocks import Cited, Prose, Table
from seethrough.analysis.stats.undefined import Number, is_defined

KINDS = {"tost_p": "TOST p", "p_holm": "Holm-corrected p", "noninferior_p": "one-sided p"}


@dataclass(frozen=True, slots=True)
class Answer:
    """The sentence, the verdict in short, and the p that decides of so many tests."""

    prediction: Prediction
    said: Prose
    verdict: str
    p: Number | None = None
    tests: int = 0


def p_runs(table: Table, row: Mapping[str, object], column: str) -> list[str | Cited]:
    """` (p = .03)`, ` (Holm-corrected p = .03)` or ` (TOST p = .2)`."""
    p = table.cite(str(row[table.columns[0].name]), column)
    equals = "" if p.text.startswith(("<", ">", "undefined")) else "= "
    return [f" ({KINDS.get(column, 'p')} {equals}", p, ")"]


def rows_of(
    tables: Mapping[str, Table], contrast: Contrast
) -> list[tuple[Table, Mapping[str, object]]]:
    """A measure's rows of a contrast: over its tasks together first, in each task then."""
    for kind in ("logs", "tests", "ranks"):
        table = tables.get(kind)
        if table is not None:
            return [(table, r) for r in table.rows if r.get("level") == contrast.key]
    table = tables.get("contrasts")
    if table is None:
        return []
    return [(table, r) for r in table.rows if str(r["contrast"]).partition("/")[2] == contrast.key]


def is_shown(row: Mapping[str, object], alpha: float) -> bool:
    """Whether a row's deciding p shows a difference."""
    p = decisive(row)[1]
    return is_defined(p) and p < alpha
