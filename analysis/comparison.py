"""A level against its baseline, measure by measure: the rows of the report's central tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from seethrough.analysis import equivalence
from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Contrast
from seethrough.analysis.equivalence import Margin
from seethrough.analysis.page.blocks import Cited, Column, Table
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.multiplicity import add_holm
from seethrough.analysis.stats.paired import paired, ratio_of_means, within_halfwidths
from seethrough.analysis.stats.ties import is_constant
from seethrough.analysis.stats.undefined import (
    ONE_PARTICIPANT,
    Number,
    Undefined,
    either_in,
    is_defined,
    no_interval,
    number_in,
)

NO_RATIO = "differences of z scores have no ratio"


@dataclass(frozen=True, slots=True)
class Pair:
    """Values of n participants under a contrast's baseline and its level. `family`: Holm's.

    `margin`: what was declared to be no difference that matters. `logs`: the same people's means of
    their trials' logarithms. `ratio_scale`: whether 0 means none of it. `participants`: the n
    names, where they are known. `largest`: of the cells that the values are means of.
    """

    key: str
    label: str
    unit: str
    digits: int
    first: Array
    second: Array
    family: str = ""
    margin: Margin | None = None
    logs: tuple[Array, Array] | None = None
    ratio_scale: bool = True
    participants: tuple[str, ...] = ()
    contrast: Contrast | None = None
    of: str = ""
    where: str = ""
    largest: float = 0.0

    @property
    def about(self) -> dict[str, object]:
        """What of a row is no column: whose it is, for what is said of it."""
        return {"of": self.of, "where": self.where, "level": self.contrast and self.contrast.key}

    @property
    def names(self) -> tuple[str, str]:
        """The two levels' names, as headings have them; numbers with their factor's name."""
        if self.contrast is None:
            return SIDES
        pair = (self.contrast.baseline, self.contrast.level)
        if all(_is_number(level) for level in pair):
            return f"{self.contrast.factor} {pair[0]}", f"{self.contrast.factor} {pair[1]}"
        return pair

    @property
    def said(self) -> tuple[str, str]:
        """The two levels in words, as sentences have them."""
        return (self.contrast.first, self.contrast.second) if self.contrast else SIDES


SIDES = ("baseline", "level")


def _is_number(level: str) -> bool:
    try:
        float(level)
    except ValueError:
        return False
    return True


def pair_of(
    key: str,
    label: str,
    unit: str,
    digits: int,
    cells: Cells,
    contrast: Contrast,
    family: str = "",
    margin: Margin | None = None,
    ratio_scale: bool = True,
    at: Mapping[str, str] | None = None,
) -> Pair | None:
    """The pair of those who have both levels of a within contrast; None unless somebody has.

    Over the other factors' cells that both levels have: cells that the study leaves out for
    everybody are in neither mean. `at` are levels of other factors to stay at.
    """
    if not {contrast.baseline, contrast.level} <= set(cells.factors.get(contrast.factor, ())):
        return None
    levels = (contrast.baseline, contrast.level)
    pair = np.stack(cells.both(contrast.factor, *levels, **(at or {})), axis=1)
    both = np.all(np.isfinite(pair), axis=1)
    if not both.any():
        return None
    names = tuple(p for p, b in zip(cells.participants, both, strict=True) if b)
    first, second = pair[both].T
    return Pair(
        key, label, unit, digits, first, second, family, margin, None, ratio_scale, names, contrast,
        largest=cells.largest,
    )  # fmt: skip


def sd_of(x: Array) -> Number:
    """Standard deviation over participants; of values that are equal up to rounding it is 0."""
    if len(x) < 2:
        return Undefined(ONE_PARTICIPANT)
    return 0.0 if is_constant(x) else float(np.std(x, ddof=1))


def _correlation(x: Array, y: Array) -> Number:
    if len(x) < 2:
        return Undefined(ONE_PARTICIPANT)
    if is_constant(x) or is_constant(y):
        return Undefined("one condition does not vary")
    return float(np.clip(np.corrcoef(x, y)[0, 1], -1.0, 1.0))


def _f_columns(first: Array, second: Array) -> dict[str, object]:
    """The one-factor ANOVA of two conditions."""
    effect = repeated_measures(np.stack([first, second], axis=1), ["level"])["level"]
    return {
        "df1": effect.df1,
        "df2": effect.df2,
        "F": effect.f,
        "p": effect.p,
        "ges": effect.ges,
        "pes": effect.pes,
        "pes_low": effect.pes_interval[0],
        "pes_high": effect.pes_interval[1],
    }


def _paired_columns(first: Array, second: Array) -> dict[str, object]:
    result = paired(first, second)
    return {
        "difference": result.difference,
        "difference_low": result.interval[0],
        "difference_high": result.interval[1],
        "sd_difference": result.sd,
        "t": result.t,
        "dz": result.dz,
        "dz_low": result.dz_interval[0],
        "dz_high": result.dz_interval[1],
        "bf10": result.bf10,
        "shapiro_w": result.shapiro_w,
        "shapiro_p": result.shapiro_p,
    }


def compare(measures: Sequence[Pair]) -> Table:
    """One row per measure on its own scale, with the tests against its declared margin."""
    rows = []
    for m in measures:
        ratio, ends = (
            ratio_of_means(m.first, m.second)
            if m.ratio_scale
            else (Undefined(NO_RATIO), no_interval(NO_RATIO))
        )
        row: dict[str, object] = {
            **m.about,
            "measure": m.key,
            "label": m.label,
            "unit": m.unit,
            "digits": m.digits,
            "n": len(m.first),
            "mean_baseline": float(m.first.mean()),
            "sd_baseline": sd_of(m.first),
            "mean_level": float(m.second.mean()),
            "sd_level": sd_of(m.second),
            "r": _correlation(m.first, m.second),
            # of two conditions both have the same one
            "within_half": within_halfwidths(np.stack([m.first, m.second], axis=1))[0],
            **_f_columns(m.first, m.second),
            **_paired_columns(m.first, m.second),
            "ratio": ratio,
            "ratio_low": ends[0],
            "ratio_high": ends[1],
            **equivalence.equivalence(m.first, m.second, m.margin),
        }
        rows.append(row)
    add_holm(rows, [m.family for m in measures])
    return Table(
        "tests", "Levels against their baseline", headed(COLUMNS, measures), tuple(rows), SHOWN
    )


def compare_logs(measures: Sequence[Pair]) -> Table:
    """Times on the log scale: geometric means and their ratio, and the tests of the ratio."""
    rows = []
    for m in measures:
        if m.logs is None:
            continue
        first, second = m.logs
        pair = _paired_columns(first, second)
        rows.append(
            {
                **m.about,
                "measure": m.key,
                "label": m.label,
                "digits": m.digits,
                "n": len(first),
                "geometric_baseline": float(np.exp(first.mean())),
                "geometric_level": float(np.exp(second.mean())),
                "ratio": float(np.exp(-number_in(pair, "difference"))),
                "ratio_low": equivalence.ratio_of(either_in(pair, "difference_high")),
                "ratio_high": equivalence.ratio_of(either_in(pair, "difference_low")),
                **_f_columns(first, second),
                **pair,
                **equivalence.log_equivalence(first, second, m.margin),
            }
        )
    add_holm(rows, [m.family for m in measures if m.logs is not None])
    return Table(
        "tests_log",
        "On the log scale",
        headed(LOG_COLUMNS, measures),
        tuple(rows),
        LOG_SHOWN,
        "Ratio: level / baseline, of geometric means: each participant's mean of the logarithms "
        "of their trials, averaged over participants.",
    )


def headed(columns: Sequence[Column], pairs: Sequence[Pair]) -> tuple[Column, ...]:
    """The columns with the levels' names in their headings, where all rows share them."""
    names = {p.names for p in pairs}
    if len(names) != 1:
        return tuple(columns)
    words = dict(zip(SIDES, names.pop(), strict=True))
    return tuple(
        replace(c, label=" ".join(words.get(w, w) for w in c.label.split(" "))) for c in columns
    )


_TEST = (
    Column("df1", "df₁", "int"),
    Column("df2", "df₂", "int"),
    Column("F", "F", "fixed2"),
    Column("p", "p", "p"),
    Column("p_holm", "p (Holm)", "p", "over tasks and levels"),
    Column("ges", "η²G", "bound3", "generalised η²"),
    Column("pes", "η²p", "bound2", "90 % interval", "pes_low", "pes_high"),
    Column("pes_low", "η²p from", "bound3", "90 % interval"),
    Column("pes_high", "η²p to", "bound3", "90 % interval"),
)
_DIFFERENCE = (
    Column(
        "difference",
        "baseline − level",
        "sig3",
        "95 % interval",
        "difference_low",
        "difference_high",
    ),
    Column("difference_low", "from", "sig3", "95 % interval"),
    Column("difference_high", "to", "sig3", "95 % interval"),
    Column("sd_difference", "SD of differences", "sig3"),
    Column("t", "t", "fixed2"),
    Column("dz", "d_z", "fixed2", "95 % interval", "dz_low", "dz_high"),
    Column("dz_low", "d_z from", "fixed2", "95 % interval"),
    Column("dz_high", "d_z to", "fixed2", "95 % interval"),
    Column("bf10", "BF₁₀", "sig3", "JZS, Cauchy scale √½"),
    Column("shapiro_w", "Shapiro W", "fixed3", "of the differences"),
    Column("shapiro_p", "Shapiro p", "p", "of the differences"),
)
_RATIO = (
    Column("ratio", "level / baseline", "fixed2", "95 % interval", "ratio_low", "ratio_high"),
    Column("ratio_low", "ratio from", "fixed2", "95 % interval"),
    Column("ratio_high", "ratio to", "fixed2", "95 % interval"),
)
COLUMNS = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("unit", "unit"),
    Column("n", "n", "int"),
    Column("mean_baseline", "M baseline", "own"),
    Column("sd_baseline", "SD", "own"),
    Column("mean_level", "M level", "own"),
    Column("sd_level", "SD", "own"),
    Column("r", "r", "bound2", "between the two conditions"),
    Column("within_half", "± within", "sig3", "95 % within-participant interval"),
    *_TEST,
    *_DIFFERENCE,
    *_RATIO,
    *equivalence.COLUMNS,
)
SHOWN = tuple(
    "label n mean_baseline sd_baseline mean_level sd_level F p p_holm pes dz bf10".split()
)
LOG_COLUMNS = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("geometric_baseline", "baseline", "own", "geometric mean"),
    Column("geometric_level", "level", "own", "geometric mean"),
    *_RATIO,
    *_TEST,
    *_DIFFERENCE,
    *equivalence.COLUMNS,
)
LOG_SHOWN = tuple("label n geometric_baseline geometric_level ratio F p p_holm dz bf10".split())


_EQUAL = "tost_margin tost_p noninferior_p low90 high90"
MORE = f"label n r difference sd_difference t ratio shapiro_w shapiro_p {_EQUAL}"
LOG_MORE = f"label n difference sd_difference t ges pes shapiro_w shapiro_p {_EQUAL}"
MORE_TITLE = "Differences, ratios, normality of the differences, equivalence"


def decisive(row: Mapping[str, object]) -> tuple[str, Number]:
    """The column that decides whether a row shows a difference, and its p: Holm's in a family.

    Friedman's tests are decided by their exact p.
    """
    for column in ("p_holm", "p_exact"):
        if row.get(column) is not None:
            return column, either_in(row, column)
    return "p", either_in(row, "p")


def corrected(table: Table, key: str) -> list[str | Cited]:
    """`, Holm-corrected p = .06` where the row belongs to a family; nothing elsewhere."""
    if table.row(key).get("p_holm") is None or not is_defined(table.row(key)["p_holm"]):
        return []
    p = table.cite(key, "p_holm")
    return [f", Holm-corrected p {equals(p.text)}", p]


def apa_f(table: Table, key: str) -> list[str | Cited]:
    """`F(1, 15) = 49.54, p < .001, η²p = .77, 90 % CI [.55, .86]`, every number cited."""
    row = table.row(key)
    if not is_defined(row["F"]):
        return ["no test: ", table.cite(key, "F")]
    p = table.cite(key, "p")
    runs: list[str | Cited] = [
        "F(",
        table.cite(key, "df1"),
        ",\u00a0",
        table.cite(key, "df2"),
        ") = ",
        table.cite(key, "F"),
        f", p {equals(p.text)}",
        p,
        ", η²p = ",
        table.cite(key, "pes", "bound2"),
    ]
    if is_defined(row["pes_low"]):
        low, high = (table.cite(key, f"pes_{end}", "bound2") for end in ("low", "high"))
        runs += [", 90 % CI [", low, ", ", high, "]"]
    return runs
