"""The one-way priority table of paper 002: where each polygon lies against each other's plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer.ordering.fragments import BEHIND, COPLANAR, CUT, IN_FRONT, Fragments
from renderer.ordering.polygons import Integers

# What a row says where the two polygons' normals point opposite ways.
REVERSED = np.array([COPLANAR, BEHIND, IN_FRONT, CUT], np.int8)


class Relations:
    """codes[q, p] is the relation of polygon p to the plane of q (002, definition 1).

    Rows are computed one at a time, against the polygons of a group only. A row of coplanar
    polygons is computed once and copied, reversed where the normals are opposite. `tested` counts
    the relations computed, as the paper's tables 6 and 7 do. Polygons are fragments' numbers.
    """

    def __init__(self, fragments: Fragments) -> None:
        self.fragments = fragments
        n = int(fragments.used[1])
        self.codes = np.zeros((n, n), np.int8)
        self.known = np.zeros(n, bool)
        self.tested = 0

    def same_way(self, polygon: int, others: Integers) -> NDArray[np.bool_]:
        """Whether coplanar polygons face the way `polygon` does."""
        normals = self.fragments.planes[:, 3:6]
        source = self.fragments.source
        return normals[source[others]] @ normals[source[polygon]] > 0

    def compute(self, polygon: int, group: Integers) -> None:
        """Fill in the row of a polygon against a group, and the rows of those coplanar with it."""
        self._put(polygon, group, self.fragments.classify(group, self._plane(polygon, len(group))))

    def _put(self, polygon: int, group: Integers, row: NDArray[np.int8]) -> None:
        self.tested += len(group) - 1
        coplanar = group[row == COPLANAR]
        same = self.same_way(polygon, coplanar)
        for other, alike in zip(coplanar, same, strict=True):
            if not self.known[other]:
                self.codes[other, group] = row if alike else REVERSED[row]
                self.known[other] = True

    def split(self, polygon: int, through: Integers) -> tuple[Integers, Integers, Integers]:
        """Cut the polygons `through` by the plane of a polygon: pieces, their parents, sides.

        A piece lies in its parent's plane and inherits its row and, where the parent was on one
        side of a plane, its column.
        """
        planes = self._plane(polygon, len(through))
        self.fragments.classify(through, planes)
        pieces, position, side = self.fragments.cut(through, planes)
        self._adopt(pieces, through[position])
        return pieces, through[position], side

    def _adopt(self, pieces: Integers, parents: Integers) -> None:
        room = int(pieces.max(initial=-1)) + 1
        if room > len(self.codes):
            size = max(room, len(self.codes) * 3 // 2)
            codes = np.zeros((size, size), np.int8)
            codes[: len(self.codes), : len(self.codes)] = self.codes
            self.codes = codes
            self.known = np.concatenate([self.known, np.zeros(size - len(self.known), bool)])
        for piece, parent in zip(pieces, parents, strict=True):
            self.codes[piece] = self.codes[parent]
            self.codes[:, piece] = self.codes[:, parent]
            self.known[piece] = self.known[parent]

    def refine(self, pieces: Integers, group: Integers) -> None:
        """Test pieces against the planes of their group that cut their parents."""
        known = group[self.known[group]]
        at, which = np.nonzero(self.codes[np.ix_(known, pieces)] == CUT)
        if not len(at):
            return
        rows, columns = known[at], pieces[which]
        sources = self.fragments.source[rows]
        self.codes[rows, columns] = self.fragments.classify(columns, sources)
        planes = self.fragments.plane_of[sources]
        self.tested += len(np.unique(np.stack([planes, columns]), axis=1).T)

    def _plane(self, polygon: int, times: int) -> Integers:
        return np.full(times, self.fragments.source[polygon])
