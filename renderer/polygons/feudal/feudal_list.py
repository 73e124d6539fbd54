"""The postprocessing phase of Chen1996: from a feudal priority tree to a priority list."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.feudal.feudal_stretches import Lists, Stretches, write_out
from seethrough.renderer.polygons.feudal.feudal_tree import Node

DOWN, SWITCH, UP = 0, 1, 2


@dataclass(frozen=True, eq=False, slots=True)
class Program:
    """The tree as three lists of polygons for each node: on the way down, at the switch, back up.

    Going down, a node draws B_j towards the eye and F_j away from it, level by level; coming back
    up, F_j towards and B_j away, in the reverse order. In `lists`, `entries` (e,) are polygons and
    `wanted` (e,) the way they must face: 1 towards the eye, 0 away, 2 either way. Node i has the
    entries spans[i, k] to spans[i, k + 1], k = DOWN, SWITCH, UP; `breaks` (e,) marks the first of a
    class. A closed volume has no entries that look away.

    Coplanar polygons share a plane: polygon p faces the eye when the eye is in front of plane
    toward[p] of `planes` (k, 4), or behind plane toward[p] - k. `stretches` are the lists written
    out for a view, as triangles.
    """

    planes: Floats
    toward: Whole
    lists: Lists
    breaks: NDArray[np.bool_]
    stretches: Stretches
    depth: int

    def order(self, point: Floats) -> NDArray[np.int32]:
        """Triangles from back to front, seen from a homogeneous point (4,)."""
        return self.stretches.order(point)

    def stretches_of(self, bounds: Whole) -> Stretches:
        """The lists written out with polygon p as the items bounds[p] to bounds[p + 1]."""
        return write_out(self.lists, self.planes, self.toward, bounds)

    def classes(self, point: Floats) -> list[Whole]:
        """Polygons in classes, from back to front."""
        front = self.planes @ point > 0
        return priority_list(self, np.concatenate([front, ~front])[self.toward])


def program(
    nodes: list[Node], planes: Floats, toward: Whole, bounds: Whole, flat: Whole,
    closed: bool,
) -> Program:  # fmt: skip
    """Flatten a tree. `toward` (m,) and `bounds` (m + 1,), its triangles, are output polygons'.

    `flat` are polygons without area: they belong to no node and are drawn first of all.
    """
    entries: list[int] = [int(p) for p in flat]
    wanted = [2] * len(entries)
    breaks = [i == 0 for i in range(len(entries))]
    spans = np.zeros((len(nodes), 4), np.int64)
    either = 1 if closed else 2

    def put(polygons: Whole, way: int, first: bool) -> None:
        if way == 0 and closed:
            return
        for i, polygon in enumerate(polygons):
            entries.append(int(polygon))
            wanted.append(way)
            breaks.append(first and i == 0)

    for i, node in enumerate(nodes):
        for back, front in ((b, f) for f, b in node.levels):
            put(back, 1, True)
            put(front, 0, len(back) == 0)
        spans[i, SWITCH] = len(entries)
        put(node.coplanar, either, True)
        spans[i, UP] = len(entries)
        for front, back in reversed(node.levels):
            put(front, 1, True)
            put(back, 0, len(front) == 0)
        spans[i, 3] = len(entries)
    spans[1:, DOWN] = spans[:-1, 3]
    lists = Lists(
        np.array(entries, np.int64),
        np.array(wanted, np.uint8),
        spans,
        np.array([node.children for node in nodes], np.int64).reshape(-1, 2),
        np.array([node.switch for node in nodes], np.int64),
    )
    return Program(
        planes, toward, lists, np.array(breaks, bool), write_out(lists, planes, toward, bounds),
        _depth(nodes),
    )  # fmt: skip


def _depth(nodes: list[Node]) -> int:
    """Connecting nodes on the longest way down; children come after their parents."""
    depth = [1] * len(nodes)
    for i, node in enumerate(nodes):
        for child in node.children:
            if child >= 0:
                depth[child] = depth[i] + 1
    return max(depth)


def priority_list(made: Program, toward: NDArray[np.bool_]) -> list[Whole]:
    """Classes of polygons from back to front, `toward` (m,) saying which face the eye."""
    classes: list[list[int]] = []
    fresh = True

    def put(begin: int, end: int) -> None:
        nonlocal fresh
        fresh = True
        for e in range(begin, end):
            fresh |= bool(made.breaks[e])
            polygon, way = int(made.lists.entries[e]), int(made.lists.wanted[e])
            if way == 2 or bool(toward[polygon]) == bool(way):
                if fresh:
                    classes.append([])
                classes[-1].append(polygon)
                fresh = False

    # A node is met on the way down, between its children, and on the way back up.
    stack = [(0, DOWN)]
    while stack:
        node, step = stack.pop()
        put(int(made.lists.spans[node, step]), int(made.lists.spans[node, step + 1]))
        if step == UP:
            continue
        stack.append((node, step + 1))
        switch = int(made.lists.switches[node])
        if switch >= 0:
            far = 1 if toward[switch] else 0
            child = int(made.lists.children[node, far if step == DOWN else 1 - far])
            if child >= 0:
                stack.append((child, DOWN))
    return [np.sort(np.array(c)) for c in classes]
