"""Splitting planes tried out: each candidate's whole subtree is built before one is taken.

Ours, beside Chen1996: the plane that cuts fewest now often shaves one polygon off a group, and the
group pays the same again at the next node. Here each rule of `WEIGHTS` proposes its first few
planes; for each the group is divided and settled to the end by the simple rules of `ROLLOUTS`, and
the plane is taken whose best subtree adds the fewest polygons. The cuts of a trial are undone, its
relations are counted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seethrough.renderer.arrays import Whole
from seethrough.renderer.polygons.feudal.feudal_relations import Relations
from seethrough.renderer.polygons.feudal.feudal_tree import Cheapest, Node, divide, settle

# What balance is worth in cuts: to the rules that propose, and to those that build the subtrees.
WEIGHTS = (0.0, 0.5, 1.0, 2.0)
ROLLOUTS = (0.0, 0.5)


@dataclass(frozen=True, slots=True)
class Lookahead:
    """`most` candidates of each rule; `balance` is one more weight."""

    balance: float
    most: int

    def __call__(self, relations: Relations, group: Whole) -> int:
        """The polygon to split by."""
        weights = sorted({*WEIGHTS, self.balance})
        proposed = [relations.candidates(group, weight, self.most) for weight in weights]
        best = (np.inf, np.inf, -1)
        for polygon in np.unique(np.concatenate(proposed)):
            for weight in ROLLOUTS:
                best = min(best, (*_added(relations, group, int(polygon), weight), int(polygon)))
        return best[2]


def _added(relations: Relations, group: Whole, switch: int, weight: float) -> tuple[int, int]:
    """Polygons that a switch and the tree below it add to a group, and splits."""
    fragments = relations.fragments
    before = fragments.used.copy()
    nodes = [Node()]
    settle(relations, nodes, divide(relations, nodes, nodes[0], switch, group), Cheapest(weight))
    first, last = int(before[1]), int(fragments.used[1])
    splits = len(np.unique(fragments.parent[first:last]))
    relations.forget(before)
    return last - first - splits, splits
