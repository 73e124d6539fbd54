"""Planes between polygons that part a group without touching it: ours, beside paper 002's.

The paper looks for separating planes among the polygons' own. Its definition 4 asks for any
plane, and things that stand apart often have none of their own between them. Here a gap is looked
for along every direction that some polygon of the group faces, by sorting the group's extents
along it: no relation is tested. A gap counts only where it is wider than rounding.
"""

from __future__ import annotations

import numpy as np

from renderer.ordering.fragments import Fragments
from renderer.ordering.polygons import Floats, Integers
from renderer.ordering.predicates import ROUNDING


def widest_parting(fragments: Fragments, group: Integers) -> Floats | None:
    """(4,) plane, as a row for homogeneous points, that leaves the most balanced sides, or None."""
    polygons = fragments.polygons(group)
    normals = fragments.planes[fragments.source[group], 3:6]
    directions = _distinct(normals / np.linalg.norm(normals, axis=1, keepdims=True))
    heights = polygons.vertices @ directions.T
    first = polygons.starts[:-1]
    low = np.minimum.reduceat(heights, first, axis=0)
    high = np.maximum.reduceat(heights, first, axis=0)
    order = np.argsort(low, axis=0, kind="stable")
    reach = np.maximum.accumulate(np.take_along_axis(high, order, axis=0), axis=0)[:-1]
    gap = np.take_along_axis(low, order, axis=0)[1:] - reach
    size = len(group)
    below = np.arange(1, size)[:, None]
    wide = gap > 4 * ROUNDING * np.abs(polygons.vertices).max()
    balance = np.where(wide, np.minimum(below, size - below), 0)
    at, which = np.unravel_index(np.argmax(balance), balance.shape)
    if balance[at, which] == 0:
        return None
    middle = reach[at, which] + gap[at, which] / 2
    return np.append(directions[which], -middle)


def in_front(fragments: Fragments, group: Integers, plane: Floats) -> Integers:
    """(g,) whether fragments lie on the normal's side of a plane that touches none of them."""
    polygons = fragments.polygons(group)
    return polygons.vertices[polygons.starts[:-1]] @ plane[:3] + plane[3] > 0.0


def _distinct(directions: Floats) -> Floats:
    """Unit vectors without repetition, opposite ones counted once."""
    rounded = np.round(directions, 6)
    lead = rounded[np.arange(len(rounded)), np.argmax(np.abs(rounded) > 0.5, axis=1)]
    _, where = np.unique(np.where(lead[:, None] < 0, -rounded, rounded), axis=0, return_index=True)
    return directions[np.sort(where)]
