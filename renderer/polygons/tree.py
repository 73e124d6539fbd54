"""A tree of planes, drawn from back to front without recursion."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bytes, Floats, Ints32, Whole

Indices = NDArray[np.uint32]
# Which way an item faces: away from its node's normal, along it, or it is drawn either way.
AGAINST, ALONG, EITHER = 0, 1, 2
EVERYTHING = np.empty(0, np.uint8)


@dataclass(frozen=True, eq=False, slots=True)
class Tree:
    """Nodes with a plane each; a parent always comes before its children.

    `planes` (n, 4) in columns: normal and minus offset, so that planes @ (eye, 1) > 0 on the
    normal's side. `children` (n, 2): the node on the normal's side (left, LabBSP2010's invariant),
    the one on the other; n for none. A node holds the items items[node] to items[node + 1];
    `sizes` (n + 1,) counts the items of a node and all below it. `facing` (items,) says which
    way items face, and those that look away from the eye are left out; EVERYTHING: none is.
    """

    planes: Floats
    children: Indices
    items: Indices
    sizes: Indices
    facing: NDArray[np.uint8]
    depth: int

    def order(self, point: Floats) -> NDArray[np.int32]:
        """Items from back to front, seen from a homogeneous point (4,)."""
        out = np.empty(int(self.items[-1]), np.int32)
        return out[: emit(*self.arguments, point, out)]

    @property
    def arguments(self) -> tuple[Floats, Indices, Indices, Indices, Bytes]:
        """What `emit` takes before the point."""
        return self.planes, self.children, self.items, self.sizes, self.facing


def tree(
    planes: Floats, children: Whole, items: Whole, facing: NDArray[np.uint8], depth: int
) -> Tree:
    """A tree from nodes whose `children` are -1 where there is none."""
    n = len(planes)
    links = np.where(children == -1, n, children).astype(np.uint32)
    sizes = _subtree_sizes(links, np.append(np.diff(items), 0).astype(np.uint32))
    return Tree(np.asfortranarray(planes), links, items.astype(np.uint32), sizes, facing, depth)


@numba.njit(cache=True)
def _subtree_sizes(children: Indices, own: Indices) -> Indices:
    sizes = own.copy()
    for node in range(len(children) - 1, -1, -1):
        sizes[node] += sizes[children[node, 0]] + sizes[children[node, 1]]
    return sizes


@numba.njit(cache=True)
def emit(
    planes: Floats,
    children: Indices,
    items: Indices,
    sizes: Indices,
    facing: Bytes,
    point: Floats,
    out: Ints32,
) -> np.uint64:
    """Write what is drawn into `out`; returns how much.

    One pass over the nodes: a node's place in the order is known when its parent's is. Which
    child comes first is looked up, not branched on. Indices are unsigned: numba tests signed
    ones for counting from the end.
    """
    u = np.uint64
    n = u(len(planes))
    front = np.empty(n, np.uint8)
    nx, ny, nz, offset = planes[:, 0], planes[:, 1], planes[:, 2], planes[:, 3]
    x, y, z, w = point[0], point[1], point[2], point[3]
    for node in range(n):
        front[node] = nx[node] * x + ny[node] * y + nz[node] * z + offset[node] * w > 0.0
    begin = np.empty(n + u(1), np.uint32)
    begin[0] = 0
    for node in range(n):
        side = u(front[node])
        far, near = children[node, side], children[node, side ^ u(1)]
        at = begin[node]
        begin[far] = at
        at += sizes[far]
        for item in range(u(items[node]), u(items[node + u(1)])):
            out[at] = item
            at += np.uint32(1)
        begin[near] = at
    if len(facing) == 0:
        return u(items[n])
    toward = np.empty(items[n], np.uint8)
    for node in range(n):
        for item in range(u(items[node]), u(items[node + u(1)])):
            toward[item] = (facing[item] == front[node]) | (facing[item] == np.uint8(2))
    length = u(0)
    for k in range(u(items[n])):
        item = out[k]
        out[length] = item
        length += u(toward[u(item)])
    return length
