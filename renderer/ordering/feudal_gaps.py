"""Planes across an axis that part a group without touching it: ours, beside paper 002's.

The paper looks for separating planes among the polygons' own. Its definition 4 asks for any
plane, and things that stand apart often have none of their own between them. A gap along x, y or
z is found by sorting the bounds, tests no relation, and is exact: it compares coordinates.
"""

from __future__ import annotations

import numpy as np

from renderer.ordering.fragments import Fragments
from renderer.ordering.polygons import Floats, Integers


def bounds_of(fragments: Fragments, group: Integers) -> tuple[Floats, Floats]:
    """(g, 3) lowest and highest coordinates of fragments."""
    polygons = fragments.polygons(group)
    first = polygons.starts[:-1]
    low = np.minimum.reduceat(polygons.vertices, first, axis=0)
    return low, np.maximum.reduceat(polygons.vertices, first, axis=0)


def widest_parting(low: Floats, high: Floats) -> tuple[int, float] | None:
    """(axis, coordinate) of the gap that leaves the most balanced sides, or None.

    Polygons with `low` > coordinate lie in front, the others behind.
    """
    best, found = 0, None
    size = len(low)
    for axis in range(3):
        order = np.argsort(low[:, axis], kind="stable")
        reach = np.maximum.accumulate(high[order, axis])[:-1]
        start = low[order, axis][1:]
        # The middle of two neighbouring numbers can round to the upper one: not a gap.
        middle = reach + (start - reach) / 2
        gaps = np.flatnonzero((reach < start) & (middle < start))
        if not len(gaps):
            continue
        balance = np.minimum(gaps + 1, size - 1 - gaps)
        at = int(np.argmax(balance))
        if balance[at] > best:
            best, found = int(balance[at]), (axis, float(middle[gaps[at]]))
    return found
