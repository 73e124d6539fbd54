"""Participants × cells: one value each. Each analysis leaves out, by name, who lacks what it needs.

A test of one task needs that task's cells (pairwise deletion); the mean over tasks and the
factorial analyses need them all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array


@dataclass(frozen=True, slots=True)
class Missing:
    """Why a participant is not in an analysis."""

    participant: str
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Cells:
    """`values`: (n, k₁, …, k_m), NaN where a participant lacks the cell; `counts`: its trials."""

    values: Array
    counts: NDArray[np.intp]
    participants: tuple[str, ...]
    factors: Mapping[str, tuple[str, ...]]

    def at(self, **levels: str) -> Array:
        """The values at the given levels, factors not named averaged over: (n,), NaN if lacking."""
        picked = self.values[self._index(levels)]
        found: Array = picked.reshape(len(picked), -1).mean(axis=1)
        return found

    def both(self, factor: str, first: str, second: str, **levels: str) -> tuple[Array, Array]:
        """The values at two levels of a factor, over the other factors' cells that both have.

        A cell that nobody has is left out of both means; (n,) each, NaN if lacking.
        """
        pair = []
        for level in (first, second):
            picked = self.values[self._index({**levels, factor: level})]
            pair.append(picked.reshape(len(picked), -1))
        there = np.isfinite(pair[0]).any(axis=0) & np.isfinite(pair[1]).any(axis=0)
        if not there.any():
            return pair[0].mean(axis=1), pair[1].mean(axis=1)
        return pair[0][:, there].mean(axis=1), pair[1][:, there].mean(axis=1)

    def pick(self, **levels: str) -> Cells:
        """The cells at the given levels; the factors named are gone."""
        index = self._index(levels)
        left = {name: known for name, known in self.factors.items() if name not in levels}
        return Cells(self.values[index], self.counts[index], self.participants, left)

    def take(self, levels: Mapping[str, Sequence[str]]) -> Cells:
        """The cells of these levels of the factors named, all of the others'."""
        values, counts = self.values, self.counts
        for axis, (factor, known) in enumerate(self.factors.items(), start=1):
            if factor in levels:
                at = [known.index(level) for level in levels[factor]]
                values, counts = np.take(values, at, axis), np.take(counts, at, axis)
        left = {name: tuple(levels.get(name, known)) for name, known in self.factors.items()}
        return Cells(values, counts, self.participants, left)

    def lone(self) -> Cells:
        """Without the factors that have a single level."""
        at = {name: known[0] for name, known in self.factors.items() if len(known) == 1}
        return self.pick(**at)

    def whole(self) -> Cells:
        """Only the participants who have every cell."""
        kept = np.all(np.isfinite(self.values.reshape(len(self.values), -1)), axis=1)
        names = tuple(p for p, k in zip(self.participants, kept, strict=True) if k)
        return Cells(self.values[kept], self.counts[kept], names, self.factors)

    @property
    def largest(self) -> float:
        """The largest absolute value, which bounds how far rounding moves a mean over cells."""
        return float(np.nanmax(np.abs(self.values), initial=0.0))

    @property
    def missing(self) -> tuple[Missing, ...]:
        """Who lacks a cell, and which."""
        return self.lacking(np.ones_like(self.values, dtype=bool))

    def lacking(self, expected: NDArray[np.bool_]) -> tuple[Missing, ...]:
        """Who lacks a cell that they are `expected` to have, and which."""
        bad = ~np.isfinite(self.values) & expected
        found = []
        for i in np.flatnonzero(bad.reshape(len(bad), -1).any(axis=1)):
            where = [
                " × ".join(known[j] for known, j in zip(self.factors.values(), cell, strict=True))
                for cell in np.argwhere(bad[i])
            ]
            found.append(Missing(self.participants[i], tuple(where)))
        return tuple(found)

    def _index(self, levels: Mapping[str, str]) -> tuple[slice | int, ...]:
        picked: list[slice | int] = [slice(None)]
        for factor, known in self.factors.items():
            picked.append(known.index(levels[factor]) if factor in levels else slice(None))
        return tuple(picked)


def level_codes(column: pd.Series, levels: Sequence[str]) -> NDArray[np.intp]:
    """Each row's place in `levels`, −1 for a level not listed; categoricals without a detour."""
    if isinstance(column.dtype, pd.CategoricalDtype):
        place = {level: i for i, level in enumerate(levels)}
        known = [place.get(str(c), -1) for c in column.cat.categories]
        own: NDArray[np.intp] = np.array([*known, -1], dtype=np.intp)[column.cat.codes]
        return own
    made = pd.Categorical(column.astype("str"), categories=list(levels))
    codes: NDArray[np.intp] = made.codes.astype(np.intp)
    return codes


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
        np.bincount(flat[known], weights=column[known], minlength=size)
        .reshape(shape)
        .astype(float, copy=False)
        for column in values.T
    ]
    return totals, counts, tuple(names)


def table_of(
    values: Array,
    counts: NDArray[np.intp],
    participants: Sequence[str],
    factors: Mapping[str, Sequence[str]],
) -> Cells:
    """The cells of everybody; a value that is not finite, or of no trial, is lacking."""
    known = np.where(np.isfinite(values) & (counts > 0), values, np.nan)
    return Cells(known, counts, tuple(participants), {k: tuple(v) for k, v in factors.items()})


def means(table: pd.DataFrame, column: str, factors: Mapping[str, Sequence[str]]) -> Cells:
    """Mean of `column` per participant and cell, over the trials that have a value."""
    (total,), counts, names = sums(table, [column], factors)
    with np.errstate(invalid="ignore"):
        return table_of(total / counts, counts, names, factors)
