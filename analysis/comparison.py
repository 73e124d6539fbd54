"""Standard against dynamic, measure by measure: the rows of the report's central tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analysis.cells import Array, Cells
from analysis.page.blocks import Cited, Column, Table, say
from analysis.stats.anova import repeated_measures
from analysis.stats.distributions import holm
from analysis.stats.paired import paired, ratio_of_means, tost, within_halfwidths
from analysis.stats.undefined import ONE_PARTICIPANT, Number, Undefined, is_defined

NO_PAIR = "there is only one transparency level"


@dataclass(frozen=True, slots=True)
class Measure:
    """Values of n participants under both levels. `family`: Holm corrects within it.

    `logs`: the same measure's per-participant means of logarithms, for times.
    """

    key: str
    label: str
    unit: str
    digits: int
    standard: Array
    dynamic: Array
    family: str = ""
    logs: tuple[Array, Array] | None = None


def measure(
    key: str, label: str, unit: str, digits: int, cells: Cells, family: str = "", **at: str
) -> Measure | None:
    """The measure from cells with a transparency factor; None unless both levels are there."""
    if cells.factors["transparency"] != ("standard", "dynamic") or not len(cells.values):
        return None
    pair = [cells.at(transparency=level, **at) for level in cells.factors["transparency"]]
    return Measure(key, label, unit, digits, pair[0], pair[1], family)


def sd_of(x: Array) -> Number:
    """Standard deviation over participants."""
    return float(np.std(x, ddof=1)) if len(x) > 1 else Undefined(ONE_PARTICIPANT)


def _correlation(x: Array, y: Array) -> Number:
    if len(x) < 2:
        return Undefined(ONE_PARTICIPANT)
    if np.ptp(x) == 0 or np.ptp(y) == 0:
        return Undefined("one condition does not vary")
    return float(np.clip(np.corrcoef(x, y)[0, 1], -1.0, 1.0))


def _f_columns(first: Array, second: Array) -> dict[str, Any]:
    """The one-factor ANOVA of two conditions."""
    effect = repeated_measures(np.stack([first, second], axis=1), ["transparency"])["transparency"]
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


def _paired_columns(first: Array, second: Array) -> dict[str, Any]:
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


def compare(measures: Sequence[Measure], margin: float) -> Table:
    """One row per measure on its own scale; TOST against ±`margin` of the standard mean."""
    rows = []
    for m in measures:
        ratio, ends = ratio_of_means(m.standard, m.dynamic)
        row: dict[str, Any] = {
            "measure": m.key,
            "label": m.label,
            "unit": m.unit,
            "digits": m.digits,
            "n": len(m.standard),
            "mean_standard": float(m.standard.mean()),
            "sd_standard": sd_of(m.standard),
            "mean_dynamic": float(m.dynamic.mean()),
            "sd_dynamic": sd_of(m.dynamic),
            "r": _correlation(m.standard, m.dynamic),
            # of two conditions both have the same one
            "within_half": within_halfwidths(np.stack([m.standard, m.dynamic], axis=1))[0],
            **_f_columns(m.standard, m.dynamic),
            **_paired_columns(m.standard, m.dynamic),
            "ratio": ratio,
            "ratio_low": ends[0],
            "ratio_high": ends[1],
            **tost_columns(m, margin),
        }
        rows.append(row)
    add_holm(rows, measures)
    return Table("tests", "Standard against dynamic transparency", COLUMNS, tuple(rows), SHOWN)


def tost_columns(m: Measure, margin: float) -> dict[str, Any]:
    """TOST against ±`margin` of the standard mean, with the 90 % interval that it inverts."""
    bound = margin * abs(float(m.standard.mean()))
    if bound == 0:
        gone = Undefined("the standard mean, and so the margin, is zero")
        return {"tost_margin": gone, "tost_p": gone, "low90": gone, "high90": gone}
    scale = float(max(np.max(np.abs(m.standard)), np.max(np.abs(m.dynamic))))
    test = tost(m.standard - m.dynamic, bound, scale)
    low, high = test.interval90
    return {"tost_margin": bound, "tost_p": test.p, "low90": low, "high90": high}


def compare_logs(measures: Sequence[Measure], margin: float) -> Table:
    """Times on the log scale: geometric means and their ratio; TOST within 1 + `margin` : 1."""
    rows = []
    for m in measures:
        if m.logs is None:
            continue
        first, second = m.logs
        pair = _paired_columns(first, second)
        rows.append(
            {
                "measure": m.key,
                "label": m.label,
                "digits": m.digits,
                "n": len(first),
                "geometric_standard": float(np.exp(first.mean())),
                "geometric_dynamic": float(np.exp(second.mean())),
                "ratio": float(np.exp(-pair["difference"])),
                "ratio_low": _exp(pair["difference_high"]),
                "ratio_high": _exp(pair["difference_low"]),
                **_f_columns(first, second),
                **pair,
                **_log_tost(first, second, margin),
            }
        )
    add_holm(rows, [m for m in measures if m.logs is not None])
    return Table(
        "tests_log_time",
        "Completion times on the log scale",
        LOG_COLUMNS,
        tuple(rows),
        LOG_SHOWN,
        "Ratio: dynamic / standard, of geometric means over participants.",
    )


def _log_tost(first: Array, second: Array, margin: float) -> dict[str, Any]:
    """Equivalence of geometric means: their ratio between 1 / (1 + margin) and 1 + margin."""
    scale = float(max(np.max(np.abs(first)), np.max(np.abs(second))))
    return {"tost_margin": 1 + margin, "tost_p": tost(first - second, np.log1p(margin), scale).p}


def _exp(value: Number) -> Number:
    return float(np.exp(-value)) if is_defined(value) else value


def add_holm(
    rows: Sequence[dict[str, Any]], measures: Sequence[Measure], column: str = "p"
) -> None:
    """Holm's p of `column` within each family; empty for a measure of no family."""
    by_key = {m.key: m.family for m in measures}
    for row in rows:
        row["p_holm"] = row[column] if by_key[row["measure"]] else None
    for family in {f for f in by_key.values() if f}:
        inside = [r for r in rows if by_key[r["measure"]] == family and is_defined(r[column])]
        for row, p in zip(inside, holm([r[column] for r in inside]), strict=True):
            row["p_holm"] = p


_TEST = (
    Column("df1", "df₁", "int"),
    Column("df2", "df₂", "int"),
    Column("F", "F", "fixed2"),
    Column("p", "p", "p"),
    Column("p_holm", "p (Holm)", "p", "over the tasks"),
    Column("ges", "η²G", "bound3", "generalised η²"),
    Column("pes", "η²p", "bound2", "90 % interval", "pes_low", "pes_high"),
    Column("pes_low", "η²p from", "bound3", "90 % interval"),
    Column("pes_high", "η²p to", "bound3", "90 % interval"),
)
_DIFFERENCE = (
    Column(
        "difference",
        "standard − dynamic",
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
    Column("ratio", "dynamic / standard", "fixed2", "95 % interval", "ratio_low", "ratio_high"),
    Column("ratio_low", "ratio from", "fixed2", "95 % interval"),
    Column("ratio_high", "ratio to", "fixed2", "95 % interval"),
)
COLUMNS = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("unit", "unit"),
    Column("n", "n", "int"),
    Column("mean_standard", "M standard", "own"),
    Column("sd_standard", "SD", "own"),
    Column("mean_dynamic", "M dynamic", "own"),
    Column("sd_dynamic", "SD", "own"),
    Column("r", "r", "bound2", "between the two conditions"),
    Column("within_half", "± within", "sig3", "95 % within-participant interval"),
    *_TEST,
    *_DIFFERENCE,
    *_RATIO,
    Column("tost_margin", "margin", "sig3", "of equivalence"),
    Column("tost_p", "p (TOST)", "p"),
    Column("low90", "90 % from", "sig3"),
    Column("high90", "90 % to", "sig3"),
)
SHOWN = tuple(
    "label n mean_standard sd_standard mean_dynamic sd_dynamic F p p_holm pes dz bf10".split()
)
LOG_COLUMNS = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("n", "n", "int"),
    Column("geometric_standard", "standard", "own", "geometric mean, s"),
    Column("geometric_dynamic", "dynamic", "own", "geometric mean, s"),
    *_RATIO,
    *_TEST,
    *_DIFFERENCE,
    Column("tost_margin", "margin", "fixed2", "ratio that counts as equal"),
    Column("tost_p", "p (TOST)", "p"),
)
LOG_SHOWN = tuple("label n geometric_standard geometric_dynamic ratio F p p_holm dz bf10".split())


MORE = (
    "label n r difference sd_difference t ratio shapiro_w shapiro_p tost_margin tost_p low90 high90"
)
LOG_MORE = "label n difference sd_difference t ges pes shapiro_w shapiro_p tost_margin tost_p"
MORE_TITLE = "Differences, ratios, normality of the differences, equivalence"


def decisive(row: Mapping[str, Any]) -> tuple[str, Number]:
    """The column that decides whether a row shows a difference, and its p: Holm's in a family.

    Friedman's tests are decided by their exact p.
    """
    for column in ("p_holm", "p_exact"):
        if row.get(column) is not None:
            return column, row[column]
    return "p", row["p"]


def corrected(table: Table, key: str) -> list[str | Cited]:
    """`, Holm-corrected p = .06` where the row belongs to a family; nothing elsewhere."""
    if table.row(key).get("p_holm") is None or not is_defined(table.row(key)["p_holm"]):
        return []
    p = table.cite(key, "p_holm")
    return [", Holm-corrected p " if p.text.startswith("<") else ", Holm-corrected p = ", p]


def no_difference(table: Table, key: str, margin: float, alpha: float) -> tuple[str | Cited, ...]:
    """What follows where a test shows no difference: does the equivalence test show equality?

    `margin` is the share of the standard mean that the table's `tost_margin` was made from.
    """
    p = table.cite(key, "tost_p")
    if not is_defined(p.value):
        return say(" No difference was shown; whether the two are equivalent is {}.", p).runs
    verdict = (
        "so the two are equivalent within that margin"
        if p.value < alpha
        else "so this is no evidence of equality either"
    )
    return say(
        f" No difference was shown; equivalence within ± {{}} ({100 * margin:g} % of the standard "
        f"mean): p {'' if p.text.startswith('<') else '= '}{{}} (TOST), {verdict}.",
        table.cite(key, "tost_margin"),
        p,
    ).runs


def apa_f(table: Table, key: str) -> list[str | Cited]:
    """`F(1, 15) = 49.54, p < .001, η²p = .77, 90 % CI [.55, .86]`, every number cited."""
    row = table.row(key)
    if not is_defined(row["F"]):
        return ["no test: ", table.cite(key, "F")]
    p = table.cite(key, "p")
    return [
        "F(",
        table.cite(key, "df1"),
        ",\u00a0",
        table.cite(key, "df2"),
        ") = ",
        table.cite(key, "F"),
        ", p " if p.text.startswith("<") else ", p = ",
        p,
        ", η²p = ",
        table.cite(key, "pes", "bound2"),
        ", 90 % CI [",
        table.cite(key, "pes_low", "bound2"),
        ", ",
        table.cite(key, "pes_high", "bound2"),
        "]",
    ]
