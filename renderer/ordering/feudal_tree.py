"""Building a feudal priority tree from one-way relations, statically and dynamically (002)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from renderer.ordering.feudal_relations import Relations
from renderer.ordering.fragments import BEHIND, COPLANAR, CUT, IN_FRONT
from renderer.ordering.polygons import Integers


@dataclass(slots=True)
class Node:
    """A connecting node: bunches of absolute priority, then the switch plane below them.

    `levels` are pairs (F_j, B_j) of polygons with absolute front and back priority. `switch` is
    the polygon whose plane parts the rest, `coplanar` (O_k) it and all in its plane, `children`
    the connecting nodes in front of it and behind. -1: none.
    """

    levels: list[tuple[Integers, Integers]] = field(default_factory=list)
    switch: int = -1
    coplanar: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    children: list[int] = field(default_factory=lambda: [-1, -1])


@dataclass(slots=True)
class _Counts:
    """How many of a group lie in front, behind and across each plane of the group."""

    front: Integers
    back: Integers
    cut: Integers

    @classmethod
    def of(cls, codes: NDArray[np.int8]) -> _Counts:
        kinds = (IN_FRONT, BEHIND, CUT)
        return cls(*(np.count_nonzero(codes == kind, axis=1) for kind in kinds))

    def joined(self, other: _Counts) -> _Counts:
        return _Counts(
            np.concatenate([self.front, other.front]),
            np.concatenate([self.back, other.back]),
            np.concatenate([self.cut, other.cut]),
        )

    def without(self, leaving: NDArray[np.int8], kept: NDArray[np.bool_]) -> _Counts:
        """Rows that stay, less the columns that leave: codes (rows, leaving)."""
        gone = _Counts.of(leaving[kept])
        return _Counts(
            self.front[kept] - gone.front, self.back[kept] - gone.back, self.cut[kept] - gone.cut
        )

    @property
    def absolute_back(self) -> NDArray[np.bool_]:
        return (self.back == 0) & (self.cut == 0)

    @property
    def absolute_front(self) -> NDArray[np.bool_]:
        """Those in front of all others; a polygon alone in its group counts as back (step 1)."""
        return (self.front == 0) & (self.cut == 0) & (self.back > 0)


def build_static(relations: Relations, group: Integers) -> list[Node]:
    """The whole table first, then the tree (002, "The Static Preprocessing Phase")."""
    for polygon in group:
        if not relations.known[polygon]:
            relations.compute(int(polygon), group)
    nodes = [Node()]
    settle(relations, nodes, [(0, group)])
    return nodes


def settle(relations: Relations, nodes: list[Node], work: list[tuple[int, Integers]]) -> None:
    """Build what is below connecting nodes whose groups have all their rows (procedures 2 to 4)."""
    while work:
        at, group = work.pop()
        node = nodes[at]
        codes = relations.codes[np.ix_(group, group)]
        counts = _Counts.of(codes)
        while len(group):
            back, front = counts.absolute_back, counts.absolute_front
            if not (back | front).any():
                break
            node.levels.append((group[front], group[back]))
            kept = ~(back | front)
            counts = counts.without(codes[:, ~kept], kept)
            group, codes = group[kept], codes[np.ix_(kept, kept)]
        if len(group):
            # A separating plane cuts none; else the plane that cuts fewest. Then the most balanced.
            best = np.lexsort((group, np.abs(counts.front - counts.back), counts.cut))[0]
            work += divide(relations, nodes, node, int(group[best]), group)


def divide(
    relations: Relations, nodes: list[Node], node: Node, switch: int, group: Integers
) -> list[tuple[int, Integers]]:
    """Put a switch under a connecting node; returns the new nodes with their groups."""
    row = relations.codes[switch, group]
    node.switch, node.coplanar = switch, group[row == COPLANAR]
    sides = {IN_FRONT: group[row == IN_FRONT], BEHIND: group[row == BEHIND]}
    through = group[row == CUT]
    if len(through):
        pieces, _, piece_side = relations.split(switch, through)
        for side, sign in ((IN_FRONT, 1), (BEHIND, -1)):
            mine = pieces[piece_side == sign]
            sides[side] = np.concatenate([sides[side], mine])
            relations.refine(mine, sides[side])
    return _hang(nodes, node, [sides[IN_FRONT], sides[BEHIND]])


def _hang(nodes: list[Node], node: Node, sides: list[Integers]) -> list[tuple[int, Integers]]:
    """New connecting nodes for the sides of a switch."""
    work = []
    for place, members in enumerate(sides):
        if len(members):
            node.children[place] = len(nodes)
            work.append((len(nodes), members))
            nodes.append(Node())
    return work


def build_dynamic(relations: Relations, order: Integers) -> list[Node]:
    """A row at a time, using each as soon as it is there (002, "The Dynamic Preprocessing Phase").

    `order` is the input in the random order the paper asks for.
    """
    nodes = [Node()]
    work, rest = [(0, order)], []
    while work:
        at, group = work.pop()
        switch, group = _peel(relations, nodes[at], group)
        if switch >= 0:
            work += divide(relations, nodes, nodes[at], switch, group)
        elif len(group):
            rest.append((at, group))
    settle(relations, nodes, rest)
    return nodes


def _peel(relations: Relations, node: Node, group: Integers) -> tuple[int, Integers]:
    """Rows of a group in turn: absolute priority leaves at once, a separating plane ends it.

    Returns the separating polygon, or -1 when every row is there and none is left, and the group.
    """
    known = group[relations.known[group]]
    counts = _Counts.of(relations.codes[np.ix_(known, group)])
    while len(group):
        usable = np.flatnonzero(counts.cut == 0)
        if not len(usable):
            unknown = np.flatnonzero(~relations.known[group])
            if not len(unknown):
                break
            relations.compute(int(group[unknown[0]]), group)
            fresh = group[unknown][relations.known[group[unknown]]]
            known = np.concatenate([known, fresh])
            counts = counts.joined(_Counts.of(relations.codes[np.ix_(fresh, group)]))
            continue
        polygon = int(known[usable[0]])
        if not (counts.absolute_back | counts.absolute_front)[usable[0]]:
            return polygon, group
        row = relations.codes[polygon, group]
        coplanar = group[row == COPLANAR]
        alike = relations.same_way(polygon, coplanar)
        bunches = (coplanar[alike], coplanar[~alike])
        node.levels.append(bunches[::-1] if counts.absolute_back[usable[0]] else bunches)
        kept = ~np.isin(known, coplanar)
        counts = counts.without(relations.codes[np.ix_(known, coplanar)], kept)
        known, group = known[kept], group[row != COPLANAR]
    return -1, group
