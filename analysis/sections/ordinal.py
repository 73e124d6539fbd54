"""Friedman tests as tables and sentences; k = 2 and more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Measure, corrected, decisive, sd_of
from seethrough.analysis.equivalence import COLUMNS as EQUIVALENCE
from seethrough.analysis.equivalence import equivalence, no_difference
from seethrough.analysis.page.blocks import Column, Prose, Table, say
from seethrough.analysis.sections.context import Context
from seethrough.analysis.sections.tables import of_people
from seethrough.analysis.stats.ranks import friedman, post_hoc
from seethrough.analysis.stats.undefined import is_defined

FRIEDMAN = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("k", "k", "int"),
    Column("mean_standard", "M standard", "fixed3"),
    Column("sd_standard", "SD", "fixed3"),
    Column("mean_dynamic", "M dynamic", "fixed3"),
    Column("sd_dynamic", "SD", "fixed3"),
    Column("chi2", "χ²", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p (χ²)", "p"),
    Column("p_exact", "p (permutation)", "p", "enumerated, or drawn where that is too long"),
    Column("p_holm", "p (Holm)", "p", "of the permutation p"),
    Column("method", "by"),
    Column("w", "Kendall's W", "bound2"),
    Column("difference", "standard − dynamic", "fixed3", "mean"),
    *EQUIVALENCE,
)
_OF_TWO = ("p_holm", "mean_", "sd_", "difference", "tost_", "noninferior_p", "low90", "high90")
"""Columns that only a comparison of two conditions has."""


def friedman_row(m: Measure, context: Context, purpose: int) -> dict[str, Any]:
    """Friedman's test of the two levels; for k = 2 its permutation p is the exact sign test's."""
    result = friedman(np.stack([m.standard, m.dynamic], axis=1), context.rng(purpose))
    return {
        "measure": m.key,
        "label": m.label,
        "n": result.n,
        "k": result.k,
        "mean_standard": float(m.standard.mean()),
        "sd_standard": sd_of(m.standard),
        "mean_dynamic": float(m.dynamic.mean()),
        "sd_dynamic": sd_of(m.dynamic),
        "chi2": result.chi2,
        "df": result.df,
        "p": result.p,
        "p_exact": result.exact,
        "method": result.method,
        "w": result.w,
        "difference": float((m.standard - m.dynamic).mean()),
        **equivalence(m.standard, m.dynamic, m.kind, context.plan.margins),
    }


SHOWN = tuple("label n mean_standard mean_dynamic chi2 df p p_exact p_holm w tost_p".split())


def friedman_table(
    key: str, title: str, rows: Sequence[Mapping[str, Any]], shares: bool = False
) -> Table:
    """The tests of several measures; `shares` cannot exceed 1, and are written so."""
    columns = tuple(
        replace(c, style="bound3") if shares and c.style == "fixed3" else c for c in FRIEDMAN
    )
    note = (
        "Of two conditions, p (permutation) is the exact sign test's, and decides: χ² rejects in "
        ".07 to .08 of studies without a difference, for .05. "
    )
    equal = any(is_defined(r["tost_margin"]) for r in rows)
    if equal:
        note += (
            "TOST and “no worse” are t tests of the means of shares, whose level holds roughly: "
            "with few trials a cell and shares near 1 they reject in up to .10 for .05."
        )
    shown = SHOWN if equal else tuple(c for c in SHOWN if c != "tost_p")
    return Table(key, title, columns, tuple(rows), shown, note.strip())


def friedman_sentence(table: Table, key: str, what: str, context: Context) -> Prose:
    """Both means, χ² and both p; where no difference is shown, whether equality is."""
    people = of_people(table, key, context)
    if not is_defined(table.row(key)["chi2"]):
        return say(
            f"{what}{{}}: M = {{}} standard, {{}} dynamic; {{}}.",
            people,
            table.cite(key, "mean_standard"),
            table.cite(key, "mean_dynamic"),
            table.cite(key, "chi2"),
        )
    p, exact = table.cite(key, "p"), table.cite(key, "p_exact")
    signs = ["" if c.text.startswith(("<", ">")) else "= " for c in (p, exact)]
    said = say(
        f"{what}{{}}: M = {{}} standard, {{}} dynamic; Friedman χ²({{}}) = {{}}, p {signs[0]}{{}}, "
        f"exact p (sign test) {signs[1]}{{}}, Kendall's W = {{}}.",
        people,
        table.cite(key, "mean_standard"),
        table.cite(key, "mean_dynamic"),
        table.cite(key, "df"),
        table.cite(key, "chi2"),
        p,
        exact,
        table.cite(key, "w", "bound2"),
    )
    said = Prose((*said.runs[:-1], *corrected(table, key), "."))
    _, deciding = decisive(table.row(key))
    alpha = context.plan.alpha
    if is_defined(deciding) and deciding < alpha:
        return said
    return Prose((*said.runs, *no_difference(table, key, alpha)))


PAIRS = (
    Column("pair", "conditions"),
    Column("rank_difference", "difference of mean ranks", "fixed2"),
    Column("nemenyi_p", "p (Nemenyi)", "p"),
    Column("v", "V", "fixed1", "signed ranks"),
    Column("p", "p (signed ranks)", "p"),
    Column("holm_p", "p (Holm)", "p"),
)


def four_conditions(context: Context, cells: Cells, purpose: int) -> list[Table]:
    """Friedman over transparency × scenario, with both post-hoc tests; none for fewer than 3."""
    cells = cells.whole()
    levels = [(c, s) for c in cells.factors["transparency"] for s in cells.factors["scenario"]]
    if len(levels) < 3 or len(cells.values) < 2:
        return []
    y = np.stack([cells.at(transparency=c, scenario=s) for c, s in levels], axis=1)
    result = friedman(y, context.rng(purpose))
    columns = tuple(c for c in FRIEDMAN if not c.name.startswith(_OF_TWO))
    row = {
        "measure": "rating_conditions",
        "label": "transparency × scenario",
        "n": result.n,
        "k": result.k,
        "chi2": result.chi2,
        "df": result.df,
        "p": result.p,
        "p_exact": result.exact,
        "method": result.method,
        "w": result.w,
    }
    shown = tuple("label n k chi2 df p p_exact method w".split())
    title = "Overall rating in the four conditions: Friedman test"
    test = Table("friedman_conditions", title, columns, (row,), shown)
    if not is_defined(result.chi2):
        return [test]
    names = [f"{c} {s}" for c, s in levels]
    rows = tuple(
        {
            "pair": f"{names[p.first]} – {names[p.second]}",
            "rank_difference": p.rank_difference,
            "nemenyi_p": p.nemenyi_p,
            "v": p.signed.v,
            "p": p.signed.p,
            "holm_p": p.holm_p,
        }
        for p in post_hoc(y)
    )
    return [test, Table("post_hoc_conditions", "Pairs of conditions", PAIRS, rows)]
