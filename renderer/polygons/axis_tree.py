"""Median split by x, y and z in turn, the camera's coordinate compared at each node (WebSorting).

A heuristic, and measurably the worst of the sorts (`seethrough bench accuracy`): a node parts the
polygons' *centres*, polygons reach through its plane uncut, and what lies in a camera's own half
is not ordered by depth at all. Its order is exact where every polygon lies wholly on one side of
every node's plane. What it is good for: the tree stays when the camera moves, and a frame costs
one comparison a node.

Where all coordinates of a set are equal, the paper's split by "< median" never ends: such a set
tries the next axis, and is a leaf when no axis parts it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.distance import centers
from seethrough.renderer.polygons.polygons import Polygons, check
from seethrough.renderer.polygons.prepared import Drawable, Stats, drawable, viewpoint
from seethrough.renderer.polygons.tree import EVERYTHING, Tree, tree


@dataclass(frozen=True, eq=False, slots=True)
class PreparedAxisTree:
    """A tree of axis-aligned planes; polygons lie in its leaves, whole."""

    drawable: Drawable
    tree: Tree
    stats: Stats

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """Triangle indices from back to front, as far as the heuristic goes."""
        return self.tree.order(viewpoint(eye, view))


def prepare(polygons: Polygons) -> PreparedAxisTree:
    """Build the tree, a level at a time. Raises ValueError for what `polygons.check` refuses."""
    check(polygons)
    planes, children, counts, leaves, depth = _grow(centers(polygons))
    drawn = drawable(polygons.take(leaves), leaves)
    items = drawn.bounds[np.concatenate([[0], np.cumsum(counts)])]
    kinds = {"switch": int((children[:, 0] >= 0).sum()), "leaf": int((counts > 0).sum())}
    stats = Stats(inputs=len(polygons), outputs=len(polygons), depth=depth, nodes=kinds)
    return PreparedAxisTree(drawn, tree(planes, children, items, EVERYTHING, depth), stats)


def _grow(points: Floats) -> tuple[Floats, Whole, Whole, Whole, int]:
    """Nodes level by level: planes, children, polygons of each node, their indices, and depth."""
    members = np.arange(len(points))
    sizes = np.array([len(points)])
    tried = np.zeros(1, np.int64)
    planes, children, counts, leaves = [], [], [], []
    axis, made, depth = 0, 1, 0
    while len(sizes):
        group = np.repeat(np.arange(len(sizes)), sizes)
        key = points[members, axis]
        members = members[np.lexsort((members, key, group))]
        key = points[members, axis]
        begin = np.cumsum(sizes) - sizes
        median = key[begin + sizes // 2] if len(points) else np.zeros(1)
        below = np.bincount(group[key < median[group]], minlength=len(sizes))
        parted, leaf = below > 0, (sizes <= 1) | (tried == 2)
        split, again = parted & ~leaf, ~parted & ~leaf
        # A set this axis cannot part keeps its node: it hands all it has to one child.
        level = np.zeros((len(sizes), 4))
        level[np.arange(len(sizes)), axis] = 1.0
        level[:, 3] = -median
        inner = np.where(split, 2, np.where(again, 1, 0))
        first = made + np.cumsum(inner) - inner
        planes.append(level)
        children.append(
            np.column_stack([np.where(inner > 0, first, -1), np.where(split, first + 1, -1)])
        )
        counts.append(np.where(leaf, sizes, 0))
        leaves.append(members[leaf[group]])
        made += int(inner.sum())
        # The normal points along the axis: its side (coordinate >= median) is the left child.
        side = np.where(split[group], (key < median[group]).astype(int), 0)
        kept = ~leaf[group]
        members = members[kept][np.argsort((2 * group + side)[kept], kind="stable")]
        next_sizes = np.column_stack([np.where(split, sizes - below, sizes), below])
        flat = np.column_stack([split | again, split]).ravel()
        tried = np.repeat(np.where(again, tried + 1, 0), 2)[flat]
        sizes = next_sizes.ravel()[flat]
        axis = (axis + 1) % 3
        depth += 1
    return (
        np.concatenate(planes),
        np.concatenate(children),
        np.concatenate(counts),
        np.concatenate(leaves),
        depth,
    )
