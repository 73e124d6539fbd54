"""Participants × cells: one value each, complete, or the participant is left out by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Missing:
    """Why a participant is not in an analysis."""

    participant: str
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Cells:
    """`values`: (n, k₁, …, k_m) of the complete `participants`; `counts` trials in each cell."""

    values: Array
    counts: NDArray[np.intp]
    participants: tuple[str, ...]
    factors: Mapping[str, tuple[str, ...]]
    missing: tuple[Missing, ...]

    def at(self, **levels: str) -> Array:
        """The values at the given levels, factors not named averaged over: (n,)."""
        index: list[slice | int] = [slice(None)]
        for factor, known in self.factors.items():
            index.append(known.index(levels[factor]) if factor in levels else slice(None))
        picked = self.values[tuple(index)]
        return picked.reshape(len(picked), -1).mean(axis=1)


def level_codes(column: pd.Series, levels: Sequence[str]) -> NDArray[np.intp]:
    """Each row's place in `levels`, −1 for a level not listed; categoricals without a detour."""
    if isinstance(column.dtype, pd.CategoricalDtype):
        place = {level: i for i, level in enumerate(levels)}
        known = [place.get(str(c), -1) for c in column.cat.categories]
        return np.array([*known, -1], dtype=np.intp)[column.cat.codes]
    return pd.Categorical(column.astype("str"), categories=list(levels)).codes.astype(np.intp)


def people(table: pd.DataFrame) -> list[str]:
    """Everybody in the study, also those without a row in this part of the table.

    Somebody who never met a task has no row of it; only the categories still know them, and they
    must be named as missing rather than vanish.
    """
    column = table["participant"]
    known = column.cat.categories if isinstance(column.dtype, pd.CategoricalDtype) else column
    return sorted({str(name) for name in known})


def sums(
    table: pd.DataFrame, columns: Sequence[str], factors: Mapping[str, Sequence[str]]
) -> tuple[list[Array], NDArray[np.intp], tuple[str, ...]]:
    """Sums of `columns` over the rows of each participant and cell, row counts, participants.

    Rows with levels that are not listed, or with a missing value in any column, do not count.
    """
    names = people(table)
    codes = level_codes(table["participant"], names)
    shape = (len(names), *(len(levels) for levels in factors.values()))
    known = codes >= 0
    flat = codes
    for factor, levels in factors.items():
        level = level_codes(table[factor], levels)
        known &= level >= 0
        flat = flat * len(levels) + level
    values = table[list(columns)].to_numpy(dtype=np.float64)
    known &= ~np.isnan(values).any(axis=1)
    size = int(np.prod(shape))
    counts = np.bincount(flat[known], minlength=size).reshape(shape)
    totals = [
        np.bincount(flat[known], weights=column[known], minlength=size).reshape(shape)
        for column in values.T
    ]
    return totals, counts, tuple(names)


def complete(
    values: Array,
    counts: NDArray[np.intp],
    participants: Sequence[str],
    factors: Mapping[str, Sequence[str]],
) -> Cells:
    """Keep the participants whose every cell has a finite value; name the others."""
    levels = {name: tuple(known) for name, known in factors.items()}
    bad = ~np.isfinite(values) | (counts == 0)
    whole = ~bad.reshape(len(values), -1).any(axis=1)
    missing = []
    for i in np.flatnonzero(~whole):
        where = [
            " × ".join(known[j] for known, j in zip(levels.values(), cell, strict=True))
            for cell in np.argwhere(bad[i])
        ]
        missing.append(Missing(participants[i], tuple(where)))
    kept = tuple(participants[i] for i in np.flatnonzero(whole))
    return Cells(values[whole], counts[whole], kept, levels, tuple(missing))


def means(table: pd.DataFrame, column: str, factors: Mapping[str, Sequence[str]]) -> Cells:
    """Mean of `column` per participant and cell, over the trials that have a value."""
    (total,), counts, names = sums(table, [column], factors)
    with np.errstate(invalid="ignore"):
        return complete(total / counts, counts, names, factors)
