"""Friedman tests as tables and sentences; k = 2 and more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from analysis.cells import Cells
from analysis.comparison import Measure, sd_of
from analysis.page.blocks import Column, Prose, Table, say
from analysis.sections.context import Context
from analysis.stats.ranks import friedman, post_hoc
from analysis.stats.undefined import is_defined

FRIEDMAN = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("k", "k", "int"),
    Column("mean_standard", "M standard", "fixed3"),
    Column("sd_standard", "s.d.", "fixed3"),
    Column("mean_dynamic", "M dynamic", "fixed3"),
    Column("sd_dynamic", "s.d.", "fixed3"),
    Column("chi2", "χ²", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p (χ²)", "p"),
    Column("p_exact", "p (exact)", "p"),
    Column("method", "by"),
    Column("w", "Kendall's W", "bound2", "95 % bootstrap interval", "w_low", "w_high"),
    Column("w_low", "W from", "bound3", "95 % bootstrap interval"),
    Column("w_high", "W to", "bound3", "95 % bootstrap interval"),
)


def friedman_row(m: Measure, context: Context, purpose: int) -> dict[str, object]:
    """Friedman's test of the two levels; for k = 2 its exact p is the sign test's."""
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
        "w_low": result.w_interval[0],
        "w_high": result.w_interval[1],
    }


SHOWN = tuple("label n mean_standard mean_dynamic chi2 df p p_exact w".split())


def friedman_table(key: str, title: str, rows: Sequence[Mapping[str, Any]]) -> Table:
    """The tests of several measures."""
    methods = sorted({str(r["method"]) for r in rows} - {"", "exact"})
    note = f"Exact p: by {' or '.join(methods)}." if methods else ""
    return Table(key, title, FRIEDMAN, tuple(rows), SHOWN, note)


def friedman_sentence(table: Table, key: str, what: str) -> Prose:
    """Both means, χ² and both p."""
    if not is_defined(table.row(key)["chi2"]):
        return say(
            f"{what}: M = {{}} standard, {{}} dynamic; {{}}.",
            table.cite(key, "mean_standard"),
            table.cite(key, "mean_dynamic"),
            table.cite(key, "chi2"),
        )
    p, exact = table.cite(key, "p"), table.cite(key, "p_exact")
    signs = ["" if c.text.startswith("<") else "= " for c in (p, exact)]
    return say(
        f"{what}: M = {{}} standard, {{}} dynamic; Friedman χ²({{}}) = {{}}, p {signs[0]}{{}}, "
        f"exact p {signs[1]}{{}}, Kendall's W = {{}}.",
        table.cite(key, "mean_standard"),
        table.cite(key, "mean_dynamic"),
        table.cite(key, "df"),
        table.cite(key, "chi2"),
        p,
        exact,
        table.cite(key, "w", "bound2"),
    )


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
    levels = [(c, s) for c in cells.factors["transparency"] for s in cells.factors["scenario"]]
    if len(levels) < 3 or len(cells.values) < 2:
        return []
    y = np.stack([cells.at(transparency=c, scenario=s) for c, s in levels], axis=1)
    result = friedman(y, context.rng(purpose))
    columns = tuple(c for c in FRIEDMAN if not c.name.startswith(("mean_", "sd_")))
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
        "w_low": result.w_interval[0],
        "w_high": result.w_interval[1],
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
