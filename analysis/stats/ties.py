"""Equal up to rounding: the one place that says when two computed numbers are tied.

4/3 − 8/3 and 2/3 − 2 are both −4/3, and differ in the last bit. Whatever is ranked, compared with 0
or called equal goes through here first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.undefined import EPS

STEPS = 32
"""Roundings allowed for, in units of EPS times the largest value that a number was made from.

The mean of m values is off by at most m · EPS / 2 of the largest, a difference of two means by
m · EPS: 32 covers 30 trials a cell at the worst, and thousands as roundings usually cancel.
What a study measures differs by 10⁸ times as much.
"""
_EXACT = 2.0**53


def slack(*parts: Array, largest: float = 0.0) -> Array:
    """How far rounding may have moved each row's number: (n,), from the `parts` it is made of.

    Each part is (n,) or (n, …). Whole numbers are exact, so between them nothing is forgiven.
    `largest`: of the values that the parts are means of, where these can cancel: the mean of 4/3,
    −1 and −1/3 is −2 · 10⁻¹⁷, and its own size says nothing of how far it is off.
    """
    rows = [np.asarray(p, dtype=np.float64).reshape(len(p), -1) for p in parts]
    values = np.concatenate(rows, axis=1)
    size = np.max(np.abs(values), axis=1, initial=largest)
    if np.all(values == np.rint(values)) and np.all(size < _EXACT):
        return np.zeros(len(values))
    moved: Array = STEPS * EPS * size
    return moved


def signs(values: Array, room: Array) -> NDArray[np.intp]:
    """−1, 0 or 1 for each of `values` (n,): 0 where it is within its `room` (n,) of zero."""
    return np.where(np.abs(values) <= room, 0, np.sign(values)).astype(np.intp)


def levels(values: Array, room: Array) -> NDArray[np.intp]:
    """The order of `values` along the last axis as 0, 1, …: the same number where they are tied.

    Neighbours in size are tied if their distance is within the room of both together; `room` has
    the shape of `values`, or one that broadcasts to it.
    """
    order = np.argsort(values, axis=-1, kind="stable")
    ranked = np.take_along_axis(values, order, axis=-1)
    near = np.take_along_axis(np.broadcast_to(room, values.shape), order, axis=-1)
    with np.errstate(over="ignore"):  # values near the largest double: apart, in any case
        step = np.diff(ranked, axis=-1) > near[..., 1:] + near[..., :-1]
    first = np.zeros((*values.shape[:-1], min(1, values.shape[-1])), dtype=np.intp)
    group = np.concatenate([first, np.cumsum(step, axis=-1)], axis=-1)
    out = np.empty_like(group)
    np.put_along_axis(out, order, group, axis=-1)
    return out


def difference_signs(first: Array, second: Array) -> NDArray[np.intp]:
    """Sign of `first − second` for n pairs, 0 where the two are equal up to rounding."""
    return signs(first - second, slack(first, second))


def is_constant(values: Array) -> bool:
    """Whether all of `values` are equal up to rounding."""
    if not len(values):
        return True
    room = slack(values[:, None])
    return bool(np.ptp(values) <= 2 * np.max(room))
