"""The 12-polygon object of Chen1996, from its relation tables to its trees and priority lists.

What the scan lost: the drawing of figure 4, so there are no coordinates, only tables 1 to 5. Rows
5, 8, 9 and 10 are not printed; the text calls these polygons absolute front priority, which fixes
their rows. Rows 6, 7, 11 and 12 are printed only after polygons have been removed (tables 2 and
5): what they say of some of 1, 2, 5, 8, 9 and 10 is nowhere. Table 2's and 3's columns are
scrambled; they are read as definition 1 and the text allow. The lost entries are filled at random
here: the trees must not depend on them, since those six polygons leave before the rows are used.
"""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.polygons.feudal.feudal_kernels import (
    BEHIND,
    COPLANAR,
    CUT,
    IN_FRONT,
    UNKNOWN,
    Geometry,
)
from seethrough.renderer.polygons.feudal.feudal_list import priority_list, program
from seethrough.renderer.polygons.feudal.feudal_relations import Relations
from seethrough.renderer.polygons.feudal.feudal_tree import build_dynamic, build_static

OUTWARD = (1, 2, 5, 8, 9, 10)
# Front, back, cut (tables 1, 2 and 5).
PRINTED = {
    3: ((5, 6, 7, 12), (1, 2, 10, 11), (4, 8, 9)),
    4: ((1, 11), (5, 6, 7, 8, 9, 12), (2, 3, 10)),
    6: ((11,), (7, 12), (3, 4)),
    7: ((3, 6, 11, 12), (9,), (4, 5, 10)),
    11: ((4, 5, 6, 7, 9, 12), (), (3, 10)),
    12: ((3, 7, 11), (6,), (4,)),
}
# Table 3: what the two parts of polygon 4 are to the others, cut by the plane of 3.
AFTER_SPLIT = {
    6: ((), (7, 12, 14), ()),
    7: ((6, 12), (), (14,)),
    12: ((7,), (6,), (14,)),
    14: ((), (6, 7, 12), ()),
    11: ((13,), (), ()),
    13: ((11,), (), ()),
}
# Order in which the paper's random numbers select the polygons for figure 10.
PAPER_ORDER = np.array([2, 8, 7, 11, 1, 5, 6, 3, 10, 4, 12, 9])
FACING_THE_VIEWER = (1, 2, 3, 5, 6, 7, 13, 14)  # those figures 13 and 14 list
KINDS = (IN_FRONT, BEHIND, CUT)


class PrintedRelations(Relations):
    """The paper's tables in place of geometry."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.table = rng.choice(np.array(KINDS, np.int8), (15, 15))
        for polygon in OUTWARD:
            self.table[polygon] = BEHIND
        self.enter(PRINTED)
        self.codes = np.full((15, 15), UNKNOWN, np.int8)
        np.fill_diagonal(self.codes, COPLANAR)
        self.row_of = np.arange(15)
        self.flipped, self.alive = np.zeros(15, bool), np.zeros(15, bool)
        self.witness, self.size = np.full(15, -1), np.zeros(15)
        self.count = np.zeros(1, np.int64)

    def enter(self, table):
        for polygon, row in table.items():
            for kind, members in zip(KINDS, row, strict=True):
                self.table[polygon, list(members)] = kind

    def _geometry(self):
        """Corners that are no numbers: every relation is left to `_decide`."""
        nowhere = np.full((15, 10), np.nan)
        loops = np.column_stack([np.arange(15), np.ones(15)] * 2).astype(np.int32)
        rows, fresh, slack = nowhere[:, :3].copy(), np.zeros(15, bool), np.zeros(15)
        corners = np.zeros((15, 3, 3))
        return Geometry(loops, rows, fresh, nowhere, corners, slack, self.row_of, self.count)

    def _decide(self, rows, polygons):
        new = self.codes[rows, polygons] == UNKNOWN
        self.codes[rows, polygons] = self.table[rows, polygons]
        self.codes[rows[rows == polygons], polygons[rows == polygons]] = COPLANAR
        self.count[0] += new.sum()

    def split(self, polygon, through):
        assert (polygon, list(through)) == (3, [4])
        self.enter(AFTER_SPLIT)
        for row, kinds in AFTER_SPLIT.items():
            members = [m for kind in kinds for m in kind]
            self.codes[row, members] = self.table[row, members]
        return np.array([14, 13]), np.array([4, 4]), np.array([1, -1])


def bunches(node):
    return [tuple(tuple(sorted(int(p) for p in side)) for side in level) for level in node.levels]


def lower_part(nodes, root):
    """What figures 8 and 10 have in common: switch 3 and all below it."""
    assert root.switch == 3
    assert list(root.coplanar) == [3]
    front, back = (nodes[child] for child in root.children)
    assert bunches(front) == [((6, 14), ()), ((), (7, 12))]
    assert bunches(back) == [((), (11, 13))]
    assert front.switch == back.switch == -1


def printed_list(nodes):
    made = program(
        nodes, np.zeros((15, 4)), np.arange(15), np.arange(16), np.empty(0, int), closed=True
    )
    toward = np.isin(np.arange(15), FACING_THE_VIEWER)
    return [tuple(int(p) for p in members) for members in priority_list(made, toward)]


@pytest.mark.parametrize("seed", range(5))
def test_the_static_tree_is_figure_8_and_its_list_figure_13(seed):
    nodes = build_static(PrintedRelations(seed), np.arange(1, 13))
    assert bunches(nodes[0]) == [(OUTWARD, ())]
    lower_part(nodes, nodes[0])
    assert printed_list(nodes) == [(13,), (3,), (7,), (6, 14), (1, 2, 5)]


@pytest.mark.parametrize("seed", range(5))
def test_the_dynamic_tree_is_figure_10_and_its_list_figure_14(seed):
    relations = PrintedRelations(seed)
    nodes = build_dynamic(relations, PAPER_ORDER)
    assert bunches(nodes[0]) == [((p,), ()) for p in (2, 8, 1, 5, 10, 9)]
    lower_part(nodes, nodes[0])
    assert printed_list(nodes) == [(13,), (3,), (7,), (6, 14), (5,), (1,), (2,)]


@pytest.mark.parametrize("seed", range(5))
def test_the_dynamic_version_computes_fewer_relations_than_the_static_one(seed):
    static, dynamic = PrintedRelations(seed), PrintedRelations(seed)
    build_static(static, np.arange(1, 13))
    build_dynamic(dynamic, PAPER_ORDER)
    assert static.tested == 12 * 11
    # The paper's rows in its order, whole, each against those that are still in the group. Ours
    # end at the first cut: 7, 11, 6, 3, 4 and 12 cut something, the other six are needed whole.
    assert dynamic.tested < 11 + 10 + 9 + 9 + 9 + 8 + 7 + 7 + 7 + 6 + 6 + 6
    assert dynamic.tested >= 11 + 10 + 9 + 8 + 7 + 6
