"""A tree of planes, drawn from back to front without recursion."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from renderer.ordering.polygons import Floats, Integers


@dataclass(frozen=True, eq=False, slots=True)
class Tree:
    """Nodes with a plane each; a parent always comes before its children.

    `planes` (n, 4): normal and minus offset, so that planes @ (eye, 1) > 0 on the normal's side.
    `children` (n, 2): the node on the normal's side (left, paper 001's invariant), the one on the
    other; -1 for none. A node holds the items items[node] to items[node + 1]; `sizes` (n,) counts
    the items of a node and all below it.
    """

    planes: Floats
    children: Integers
    items: Integers
    sizes: Integers
    depth: int

    def order(self, point: Floats) -> NDArray[np.int32]:
        """Items from back to front, seen from a homogeneous point (4,)."""
        return _order(self.planes, self.children, self.items, self.sizes, point)


def subtree_sizes(children: Integers, own: Integers) -> Integers:
    """(n,) items of each node and all below it."""
    return _subtree_sizes(children, own)


@numba.njit(cache=True)
def _subtree_sizes(children, own):
    sizes = own.copy()
    for node in range(len(own) - 1, -1, -1):
        for side in range(2):
            if children[node, side] >= 0:
                sizes[node] += sizes[children[node, side]]
    return sizes


@numba.njit(cache=True)
def _order(planes, children, items, sizes, point):
    """One pass over the nodes: a node's place in the order is known when its parent's is."""
    n = len(planes)
    begin = np.empty(n, np.int32)
    result = np.empty(items[n], np.int32)
    if n:
        begin[0] = 0
    x, y, z, w = point
    for node in range(n):
        plane = planes[node]
        seen = plane[0] * x + plane[1] * y + plane[2] * z + plane[3] * w > 0.0
        far = children[node, 1 if seen else 0]
        near = children[node, 0 if seen else 1]
        at = begin[node]
        if far >= 0:
            begin[far] = at
            at += sizes[far]
        for item in range(items[node], items[node + 1]):
            result[at] = item
            at += 1
        if near >= 0:
            begin[near] = at
    return result
