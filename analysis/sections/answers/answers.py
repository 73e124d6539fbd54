"""An answer to a prediction, and what all kinds of answers share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from seethrough.analysis.design import Contrast, Prediction
from seethrough.analysis.measures import TASK
from seethrough.analysis.page.blocks import Cited, Prose, Table
from seethrough.analysis.sections.base.tables import cited_f
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


def depends(tables: Mapping[str, Table], factor: str, alpha: float) -> list[str | Cited]:
    """On which other factors an effect was found to depend: its mean over their levels is none of
    theirs. That of tasks, and of what tasks are nested in, is told beside the tasks' own rows."""
    runs: list[str | Cited] = []
    for name, table in tables.items():
        told = name in ("anova", f"anova_{TASK}") or name.startswith("anova_in_")
        for row in table.rows if told else ():
            effect = str(row["effect"])
            others = [part for part in effect.split(" × ") if part != factor]
            if len(others) != 1 or factor not in effect.split(" × ") or others == [TASK]:
                continue
            if is_defined(row["p_decisive"]) and row["p_decisive"] < alpha:
                runs += [f" It depends on {others[0]} (", *cited_f(table, effect),
                         "): this is the mean of unlike effects, and those at each level are what "
                         "to read."]  # fmt: skip
    return runs


def on_average(verdict: str, depending: bool) -> str:
    """The verdict on an effect that depends on something."""
    return "supported on average, not alike" if depending and verdict == "supported" else verdict


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
