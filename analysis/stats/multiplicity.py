"""Several tests at once: p values corrected for their number (Holm 1979)."""

from __future__ import annotations

from collections.abc import MutableMapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.undefined import Number, either_in, is_defined


def holm(p: ArrayLike) -> Array:
    """Holm's step-down adjusted p values of k tests, (k,) or (k, …), in the order given.

    Further axes are families of their own.
    """
    raw = np.asarray(p, dtype=np.float64)
    left = (len(raw) - np.arange(len(raw))).reshape(-1, *(1,) * (raw.ndim - 1))
    order = np.argsort(raw, axis=0, kind="stable")
    scaled = np.take_along_axis(raw, order, axis=0) * left
    adjusted = np.empty_like(raw)
    np.put_along_axis(
        adjusted, order, np.minimum(np.maximum.accumulate(scaled, axis=0), 1.0), axis=0
    )
    return adjusted


def holm_of_defined(p: Sequence[Number]) -> list[Number]:
    """Holm's p among the tests that have one; an undefined one stays so and counts for nothing."""
    adjusted = iter(holm([x for x in p if is_defined(x)]).tolist())
    return [next(adjusted) if is_defined(x) else x for x in p]


def add_holm(
    rows: Sequence[MutableMapping[str, object]], families: Sequence[str], column: str = "p"
) -> None:
    """Write `p_holm` into each row: Holm's p of `column` within the row's family, "" for none.

    It is None in a row of no family, and undefined where `column` is.
    """
    for row, family in zip(rows, families, strict=True):
        if not family:
            row["p_holm"] = None
    for family in dict.fromkeys(f for f in families if f):
        inside = [r for r, f in zip(rows, families, strict=True) if f == family]
        found = holm_of_defined([either_in(r, column) for r in inside])
        for row, p in zip(inside, found, strict=True):
            row["p_holm"] = p
