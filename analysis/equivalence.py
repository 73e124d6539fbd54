"""Is no difference equality, and is the technique at least no worse? Against declared margins only.

A margin is absolute, in the measure's own unit, or for times a ratio; it is declared in the study,
before there are data ([analysis.margins]). A margin taken from the data is no margin: against 20 %
of the observed mean a test at .05 rejects in .07 to .09 of studies (16 people).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from seethrough.analysis.cells import Array
from seethrough.analysis.page.blocks import Cited, Column, Table, say
from seethrough.analysis.stats.paired import Equivalence, ratio_within, tost
from seethrough.analysis.stats.undefined import Undefined, is_defined

MARGINS = ("time", "count_error", "correct", "distance")
"""What a study may declare a margin of."""
RATIOS = ("time",)
LARGER_IS_BETTER = ("correct",)
NO_MARGIN = "no margin was declared before the data"

COLUMNS = (
    Column("tost_margin", "margin", "sig3", "declared before the data"),
    Column("tost_p", "p (TOST)", "p", "that the two are within the margin"),
    Column("noninferior_p", "p (no worse)", "p", "that dynamic is not worse by the margin"),
    Column("low90", "90 % from", "sig3", "of the difference; of the ratio where the margin is one"),
    Column("high90", "90 % to", "sig3"),
)


def equivalence(
    first: Array, second: Array, kind: str, margins: Mapping[str, float]
) -> dict[str, Any]:
    """The columns for n people's values under standard and dynamic; `kind`: what is measured."""
    if kind not in margins:
        return _row(None, Undefined(NO_MARGIN), kind)
    if kind in RATIOS:
        return _row(ratio_within(first, second, margins[kind]), margins[kind], kind)
    scale = float(max(np.max(np.abs(first)), np.max(np.abs(second))))
    test = tost(first - second, margins[kind], scale)
    return _row(test, margins[kind], kind)


def log_equivalence(
    first: Array, second: Array, kind: str, margins: Mapping[str, float]
) -> dict[str, Any]:
    """The same for logarithms: the ratio of geometric means between 1 / margin and margin."""
    if kind not in margins:
        return _row(None, Undefined(NO_MARGIN), kind)
    scale = float(max(np.max(np.abs(first)), np.max(np.abs(second))))
    test = tost(first - second, float(np.log(margins[kind])), scale)
    low, high = test.interval90
    ends = (_ratio(high), _ratio(low))
    return _row(test, margins[kind], kind, ends)


def _ratio(log_gap: float | Undefined) -> float | Undefined:
    """dynamic / standard from standard − dynamic of logarithms."""
    return float(np.exp(-log_gap)) if is_defined(log_gap) else log_gap


def _row(
    test: Equivalence | None,
    margin: float | Undefined,
    kind: str,
    ends: tuple[float | Undefined, float | Undefined] | None = None,
) -> dict[str, Any]:
    if test is None:
        return dict.fromkeys((c.name for c in COLUMNS), margin)
    low, high = ends or test.interval90
    # worse is more of an error or a time, and less of what is right
    no_worse = test.p_high if kind in LARGER_IS_BETTER else test.p_low
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
        f"{'' if p.text.startswith(('<', '>')) else '= '}{{}} (TOST), {verdict}.",
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
        f"{'' if p.text.startswith(('<', '>')) else '= '}{{}} (TOST): {verdict}.",
        margin,
        margin,
        p,
    ).runs
