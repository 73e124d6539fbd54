"""Building a feudal priority tree from one-way relations, statically and dynamically (Chen1996)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from seethrough.renderer.arrays import Whole
from seethrough.renderer.polygons.feudal.feudal_kernels import BEHIND, COPLANAR, CUT, IN_FRONT
from seethrough.renderer.polygons.feudal.feudal_relations import Relations


@dataclass(slots=True)
class Node:
    """A connecting node: bunches of absolute priority, then the switch plane below them.

    `levels` are pairs (F_j, B_j) of polygons with absolute front and back priority. `switch` is
    the polygon whose plane parts the rest, `coplanar` (O_k) it and all in its plane, `children`
    the connecting nodes in front of it and behind. -1: none.
    """

    levels: list[tuple[Whole, Whole]] = field(default_factory=list)
    switch: int = -1
    coplanar: Whole = field(default_factory=lambda: np.empty(0, np.int64))
    children: list[int] = field(default_factory=lambda: [-1, -1])


Work = list[tuple[int, Whole]]


class Rule(Protocol):
    """Chooses the polygon whose plane splits a group that none separates."""

    def __call__(self, relations: Relations, group: Whole) -> int: ...


@dataclass(frozen=True, slots=True)
class Cheapest:
    """Fewest cuts, less what `balance` is worth: see `feudal_kernels.cheapest`. 0: Chen1996."""

    balance: float = 0.0

    def __call__(self, relations: Relations, group: Whole) -> int:
        """The polygon to split by."""
        return relations.splitter(group, self.balance)


PAPER = Cheapest()


def build_static(relations: Relations, group: Whole, rule: Rule = PAPER) -> list[Node]:
    """The whole table first, then the tree (Chen1996, "The Static Preprocessing Phase")."""
    relations.compute_all(group)
    nodes = [Node()]
    settle(relations, nodes, [(0, group)], rule)
    return nodes


def build_dynamic(relations: Relations, order: Whole, rule: Rule = PAPER) -> list[Node]:
    """A row at a time, using each as soon as it is there (Chen1996, "The Dynamic Preprocessing
    Phase").

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
    settle(relations, nodes, rest, rule)
    return nodes


def settle(relations: Relations, nodes: list[Node], work: Work, rule: Rule) -> None:
    """Build what is below connecting nodes, level by level (Chen1996, procedures 2 to 4)."""
    while work:
        at, group = work.pop()
        node = nodes[at]
        while len(group):
            clean = np.flatnonzero(relations.clean(group))
            sides = np.array([_sides(relations, p, group) for p in group[clean]]).reshape(-1, 2)
            # A polygon alone in its group counts as back (step 1).
            back = sides[:, 1] == 0
            front = (sides[:, 0] == 0) & ~back
            if not (back | front).any():
                break
            node.levels.append((group[clean[front]], group[clean[back]]))
            group = np.delete(group, clean[back | front])
        if not len(group):
            continue
        if len(clean):
            # A separating plane: the most balanced.
            lean = np.abs(sides[:, 0] - sides[:, 1])
            switch = int(group[clean[np.lexsort((group[clean], lean))[0]]])
        else:
            switch = rule(relations, group)
        work += divide(relations, nodes, node, switch, group)


def _sides(relations: Relations, polygon: int, group: Whole) -> tuple[int, int]:
    """How many of a group lie in front of a polygon and behind it."""
    row = relations.row(polygon, group)
    return int(np.count_nonzero(row == IN_FRONT)), int(np.count_nonzero(row == BEHIND))


def divide(relations: Relations, nodes: list[Node], node: Node, switch: int, group: Whole) -> Work:
    """Put a switch under a connecting node; returns the new nodes with their groups."""
    row = relations.row(switch, group)
    node.switch, node.coplanar = switch, group[row == COPLANAR]
    sides = [group[row == IN_FRONT], group[row == BEHIND]]
    through = group[row == CUT]
    if len(through):
        pieces, _, piece_side = relations.split(switch, through)
        sides = [
            np.concatenate([mine, pieces[piece_side == sign]])
            for mine, sign in zip(sides, (1, -1), strict=True)
        ]
    work = []
    for place, members in enumerate(sides):
        if len(members):
            node.children[place] = len(nodes)
            work.append((len(nodes), members))
            nodes.append(Node())
    return work


def _peel(relations: Relations, node: Node, group: Whole) -> tuple[int, Whole]:
    """Rows of a group in turn: absolute priority leaves at once, a separating plane ends it.

    Returns the separating polygon, or -1 when every plane cuts some of the group, and the group.
    """
    while len(group):
        at = relations.usable(group)
        if at < 0:
            break
        polygon = int(group[at])
        row = relations.row(polygon, group)
        front, back = (row == IN_FRONT).any(), (row == BEHIND).any()
        if front and back:
            return polygon, group
        coplanar = group[row == COPLANAR]
        alike = relations.flipped[coplanar] == relations.flipped[polygon]
        bunches = (coplanar[alike], coplanar[~alike])
        # In front of all others, or with none behind: a polygon alone counts as back (step 1).
        node.levels.append(bunches if back else bunches[::-1])
        group = group[row != COPLANAR]
    return -1, group
