"""Is no difference equality, and is the level at least no worse? Against declared margins only.

A margin is absolute, in the measure's own unit, or for what is analysed as logarithms a ratio; it
is declared in the study, before there are data. A margin taken from the data is no margin: against
20 % of the observed mean a test at .05 rejects in .07 to .09 of studies (16 people).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.analysis.design import Measured
from seethrough.analysis.page.blocks import Cited, Column, Table, say
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.paired import Equivalence, ratio_within, tost
from seethrough.analysis.stats.undefined import Undefined, is_defined

NO_MARGIN = "no margin was declared before the data"


@dataclass(frozen=True, slots=True)
class Margin:
    """A declared margin: `ratio` says whether it is one; `more`: whether more is better."""

    value: float
    ratio: bool = False
    more: bool = False


def margin_of(measure: Measured) -> Margin | None:
    """What a measure's study declared of it."""
    if measure.margin is None:
        return None
    return Margin(measure.margin, measure.log or measure.ratio, measure.direction == "more")


COLUMNS = (
    Column("tost_margin", "margin", "sig3", "declared before the data"),
    Column("tost_p", "p (TOST)", "p", "that the two are within the margin"),
    Column("noninferior_p", "p (no worse)", "p", "that the level is not worse by the margin"),
    Column("low90", "90 % from", "sig3", "of the difference; of the ratio where the margin is one"),
    Column("high90", "90 % to", "sig3"),
)


def equivalence(first: Array, second: Array, margin: Margin | None) -> dict[str, object]:
    """The columns for n people's values under baseline and level."""
    if margin is None:
        return _row(None, Undefined(NO_MARGIN))
    if margin.ratio:
        return _row(ratio_within(first, second, margin.value), margin.value, margin.more)
    scale = float(max(np.max(np.abs(first)), np.max(np.abs(second))))
    return _row(tost(first - second, margin.value, scale), margin.value, margin.more)


def log_equivalence(first: Array, second: Array, margin: Margin | None) -> dict[str, object]:
    """The same for logarithms: the ratio of geometric means between 1 / margin and margin."""
    if margin is None:
        return _row(None, Undefined(NO_MARGIN))
    scale = float(max(np.max(np.abs(first)), np.max(np.abs(second))))
    test = tost(first - second, float(np.log(margin.value)), scale)
    low, high = test.interval90
    return _row(test, margin.value, margin.more, (ratio_of(high), ratio_of(low)))


def ratio_of(log_gap: float | Undefined) -> float | Undefined:
    """level / baseline from baseline − level of logarithms."""
    return float(np.exp(-log_gap)) if is_defined(log_gap) else log_gap


def _row(
    test: Equivalence | None,
    margin: float | Undefined,
    more: bool = False,
    ends: tuple[float | Undefined, float | Undefined] | None = None,
) -> dict[str, object]:
    if test is None:
        return dict.fromkeys((c.name for c in COLUMNS), margin)
    low, high = ends or test.interval90
    # worse is more of an error or a time, and less of what is right
    no_worse = test.p_high if more else test.p_low
    return {
        "tost_margin": margin,
        "tost_p": test.p,
        "noninferior_p": no_worse,
        "low90": low,
        "high90": high,
    }


def no_difference(table: Table, key: str, alpha: float) -> tuple[str | Cited, ...]:
    """What follows where a test shows no difference: does the equivalence test show equality?"""
    p, margin = table.cite(key, "tost_p"), table.cite(key, "tost_margin")
    if isinstance(margin.value, Undefined):
        return (
            " No difference was shown, which is no evidence of equality: ",
            f"{margin.value.reason}.",
        )
    if not is_defined(p.value):
        return say(" No difference was shown; whether the two are equivalent is {}.", p).runs
    verdict = (
        "so the two are equivalent within that margin"
        if p.value < alpha
        else "so this is no evidence of equality either"
    )
    return say(
        f" No difference was shown; equivalence within ± {{}}, the declared margin: p "
        f"{equals(p.text)}{{}} (TOST), {verdict}.",
        margin,
        p,
    ).runs


def no_ratio(logs: Table, key: str, alpha: float) -> tuple[str | Cited, ...]:
    """Where no difference of log times is shown: is equivalence?"""
    p, margin = logs.cite(key, "tost_p"), logs.cite(key, "tost_margin")
    if isinstance(margin.value, Undefined):
        return no_difference(logs, key, alpha)
    if not is_defined(p.value):
        return say(" Whether the times are equivalent is {}.", p).runs
    verdict = "equivalence is shown" if p.value < alpha else "equivalence is not shown either"
    return say(
        f" For a ratio between 1 / {{}} and {{}}, the declared margin, p "
        f"{equals(p.text)}{{}} (TOST): {verdict}.",
        margin,
        margin,
        p,
    ).runs
