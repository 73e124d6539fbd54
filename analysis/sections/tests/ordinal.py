"""Friedman tests as tables and sentences; k = 2 and more."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from seethrough.analysis.cells import Cells
from seethrough.analysis.comparison import Pair, corrected, decisive, headed, sd_of
from seethrough.analysis.equivalence import COLUMNS as EQUIVALENCE
from seethrough.analysis.equivalence import equivalence, no_difference
from seethrough.analysis.page.blocks import Column, Prose, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.tables import of_people
from seethrough.analysis.stats.ranks import friedman, post_hoc
from seethrough.analysis.stats.undefined import is_defined

FRIEDMAN = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("k", "k", "int"),
    Column("mean_baseline", "M baseline", "fixed3"),
    Column("sd_baseline", "SD", "fixed3"),
    Column("mean_level", "M level", "fixed3"),
    Column("sd_level", "SD", "fixed3"),
    Column("chi2", "χ²", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p (χ²)", "p"),
    Column("p_exact", "p (permutation)", "p", "enumerated, or drawn where that is too long"),
    Column("p_holm", "p (Holm)", "p", "of the permutation p"),
    Column("method", "by"),
    Column("w", "Kendall's W", "bound2", "how far participants agree; it has no interval"),
    Column("difference", "baseline − level", "fixed3", "mean"),
    *EQUIVALENCE,
)
NO_INTERVAL = (
    "Kendall's W has no interval here: bootstrap ones never hold a true W of 0, and others too "
    "seldom."
)
_OF_TWO = ("p_holm", "mean_", "sd_", "difference", "tost_", "noninferior_p", "low90", "high90")
"""Columns that only a comparison of two conditions has."""


def friedman_row(m: Pair, context: Context, purpose: int) -> dict[str, object]:
    """Friedman's test of the two levels; for k = 2 its permutation p is the exact sign test's."""
    result = friedman(np.stack([m.first, m.second], axis=1), context.rng(purpose), m.largest)
    return {
        **m.about,
        "measure": m.key,
        "label": m.label,
        "n": result.n,
        "k": result.k,
        "mean_baseline": float(m.first.mean()),
        "sd_baseline": sd_of(m.first),
        "mean_level": float(m.second.mean()),
        "sd_level": sd_of(m.second),
        "chi2": result.chi2,
        "df": result.df,
        "p": result.p,
        "p_exact": result.exact,
        "method": result.method,
        "w": result.w,
        "difference": float((m.first - m.second).mean()),
        **equivalence(m.first, m.second, m.margin),
    }


SHOWN = tuple("label n mean_baseline mean_level chi2 df p p_exact p_holm w tost_p".split())


def friedman_table(
    key: str,
    title: str,
    rows: Sequence[Mapping[str, object]],
    pairs: Sequence[Pair],
    shares: bool = False,
) -> Table:
    """The tests of several measures; `shares` cannot exceed 1, and are written so."""
    columns = tuple(
        replace(c, style="bound3") if shares and c.style == "fixed3" else c
        for c in headed(FRIEDMAN, pairs)
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
    return Table(key, title, columns, tuple(rows), shown, f"{note.strip()} {NO_INTERVAL}")


def friedman_sentence(table: Table, m: Pair, what: str, context: Context) -> Prose:
    """Both means, χ² and both p; where no difference is shown, whether equality is."""
    key, (first, second) = m.key, m.names
    people = of_people(table, key, context)
    if not is_defined(table.row(key)["chi2"]):
        return say(
            f"{what}{{}}: M = {{}} {first}, {{}} {second}; {{}}.",
            people,
            table.cite(key, "mean_baseline"),
            table.cite(key, "mean_level"),
            table.cite(key, "chi2"),
        )
    p, exact = table.cite(key, "p"), table.cite(key, "p_exact")
    signs = [equals(c.text) for c in (p, exact)]
    said = say(
        f"{what}{{}}: M = {{}} {first}, {{}} {second}; Friedman χ²({{}}) = {{}}, "
        f"p {signs[0]}{{}}, exact p (sign test) {signs[1]}{{}}, Kendall's W = {{}}.",
        people,
        table.cite(key, "mean_baseline"),
        table.cite(key, "mean_level"),
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


MOST_PAIRED = 6
"""Conditions of which every pair is compared unasked: of 18 there were 153."""


def conditions(
    context: Context,
    cells: Cells,
    factors: Sequence[str],
    key: str,
    row_key: str,
    said: str,
    purpose: int,
) -> list[Table]:
    """Friedman over all conditions of these factors, with both post-hoc tests; none for fewer than
    three. Conditions that the study leaves out for everybody are not there.

    `key`: `friedman_conditions` and `post_hoc_conditions` end in it.
    """
    known = [cells.factors[f] for f in factors]
    levels = [dict(zip(factors, at, strict=True)) for at in itertools.product(*known)]
    levels = [at for at in levels if not context.design.left_out(at)]
    if len(levels) < 3:
        return []
    y = np.stack([cells.at(**at) for at in levels], axis=1)
    y = y[np.isfinite(y).all(axis=1)]
    if len(y) < 2:
        return []
    result = friedman(y, context.rng(purpose), cells.largest)
    columns = tuple(c for c in FRIEDMAN if not c.name.startswith(_OF_TWO))
    row = {
        "measure": row_key,
        "label": " × ".join(factors),
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
    title = f"{said}: Friedman test over {len(levels)} conditions"
    test = Table(f"friedman_{key}", title, columns, (row,), shown, NO_INTERVAL)
    if not is_defined(result.chi2):
        return [test]
    if len(levels) > MOST_PAIRED:
        said = f"Its {len(levels) * (len(levels) - 1) // 2} pairs of conditions are not compared"
        note = f"{said}: ask for pairs of a factor's levels (pairwise)."
        return [replace(test, note=f"{note} {NO_INTERVAL}")]
    names = [" ".join(at.values()) for at in levels]
    rows = tuple(
        {
            "pair": f"{names[p.first]} – {names[p.second]}",
            "rank_difference": p.rank_difference,
            "nemenyi_p": p.nemenyi_p,
            "v": p.signed.v,
            "p": p.signed.p,
            "holm_p": p.holm_p,
        }
        for p in post_hoc(y, cells.largest)
    )
    return [test, Table(f"post_hoc_{key}", f"{said}: pairs of conditions", PAIRS, rows)]
