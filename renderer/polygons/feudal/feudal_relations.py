"""The one-way priority table of Chen1996: where each polygon lies against each other's plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Whole
from seethrough.renderer.polygons.feudal.feudal_kernels import (
    BEHIND,
    COPLANAR,
    CUT,
    IN_FRONT,
    UNKNOWN,
    Geometry,
    cheapest,
    clean_rows,
    first_usable,
)
from seethrough.renderer.polygons.fragments import Fragments

# What a row says where the two polygons' normals point opposite ways.
REVERSED = np.array([COPLANAR, BEHIND, IN_FRONT, CUT], np.int8)


class Relations:
    """codes[q, p] is the relation of polygon p to the plane q (Chen1996, definition 1), or UNKNOWN.

    Polygons are fragments' numbers. Coplanar polygons share a row, numbered by one of them:
    `row_of` (fragments,); `flipped` says whether a polygon faces against its row, and then has
    front and back exchanged. `tested` counts the relations computed, as the paper's tables 6 and
    7 do; `witness` (rows,) is a polygon that each plane is known to cut.
    """

    def __init__(self, fragments: Fragments) -> None:
        self.fragments = fragments
        n = len(fragments.source)
        self.codes = np.full((n, n), UNKNOWN, np.int8)
        self.row_of = fragments.plane_of.copy()
        self.flipped = self._against(np.arange(n))
        self.codes[self.row_of, np.arange(n)] = COPLANAR
        # That a row's own polygon is coplanar is no test; that another one is, is.
        self.count = np.array([int((self.row_of != np.arange(n)).sum())])
        self.witness = np.full(n, -1, np.int64)
        self.alive = np.zeros(n, bool)
        self.size = self._sizes(np.arange(n))

    @property
    def tested(self) -> int:
        """Relations computed."""
        return int(self.count[0])

    def row(self, polygon: int, group: Whole) -> NDArray[np.int8]:
        """(g,) relations of a group to a polygon's plane, seen from its own front: all known."""
        codes = self.codes[self.row_of[polygon], group]
        return REVERSED[codes] if self.flipped[polygon] else codes

    def compute_all(self, group: Whole) -> None:
        """The whole table of a group: what the static version begins with."""
        for row in np.unique(self.row_of[group]):
            self._decide(np.full(len(group), row), group)

    def usable(self, group: Whole) -> int:
        """Position of the first polygon whose plane cuts none of the group; -1 if each cuts one."""
        large_first = self._enter(group)
        while True:
            at, other = first_usable(
                self.codes, group, large_first, self.witness, self.alive, self._geometry()
            )
            if other < 0:
                return int(at)
            self._decide(self.row_of[group[at : at + 1]], np.array([other]))

    def clean(self, group: Whole) -> NDArray[np.bool_]:
        """(g,) whether a polygon's plane cuts none of the group; those rows are known then."""
        large_first = self._enter(group)
        members = np.unique(self.row_of[group])
        open_ = np.empty((2, len(members)), np.int64)
        while waiting := clean_rows(
            self.codes, members, large_first, self.witness, self.alive, self._geometry(), open_
        ):
            self._decide(*open_[:, :waiting])
        return self.witness[self.row_of[group]] < 0

    def splitter(self, group: Whole, weight: float) -> int:
        """The polygon to split a group by: see `feudal_kernels.cheapest`.

        Of equally good ones the most balanced, then the first by number.
        """
        large_first = self._enter(group)
        members, at = np.unique(self.row_of[group], return_inverse=True)
        counts = np.zeros((len(members), 3), np.int64)
        place = np.zeros(len(members), np.int64)
        while True:
            plane, other = cheapest(
                self.codes, members, large_first, counts, place, weight, self._geometry()
            )
            if other < 0:
                break
            self._decide(np.array([plane]), np.array([other]))
        cost, lean = costs(counts, weight)
        cost[place < len(group)] = np.inf
        return int(group[np.lexsort((group, lean[at], cost[at]))[0]])

    def candidates(self, group: Whole, weight: float, most: int) -> Whole:
        """The first few polygons, of a plane each, as `splitter` ranks them."""
        self.compute_all(group)
        members, first = np.unique(self.row_of[group], return_index=True)
        codes = self.codes[np.ix_(members, group)]
        kinds = (IN_FRONT, BEHIND, CUT)
        counts = np.stack([np.count_nonzero(codes == kind, axis=1) for kind in kinds], axis=1)
        cost, lean = costs(counts, weight)
        return group[first][np.lexsort((group[first], lean, cost))[:most]]

    def forget(self, fragments: Whole) -> None:
        """Undo all cuts since there were `fragments` (rows, fragments) in use."""
        self.fragments.used[:] = fragments
        self.codes[:, fragments[1] :] = UNKNOWN
        gone = self.witness >= fragments[1]
        self.witness[gone] = -1

    def split(self, polygon: int, through: Whole) -> tuple[Whole, Whole, Whole]:
        """Cut the polygons `through` by the plane of a polygon: pieces, their parents, sides.

        A piece lies in its parent's plane, so it has its row; where the parent lies on one side
        of a plane the piece does too, and where it is cut the piece is yet to be tested.
        """
        planes = np.full(len(through), self.row_of[polygon])
        self.fragments.classify(through, planes)
        pieces, position, side = self.fragments.cut(through, planes)
        parents = through[position]
        self._reserve(int(pieces.max(initial=-1)) + 1)
        self.row_of[pieces], self.flipped[pieces] = self.row_of[parents], self.flipped[parents]
        self.size[pieces] = self._sizes(pieces)
        inherited = self.codes[:, parents]
        self.codes[:, pieces] = np.where(inherited == CUT, UNKNOWN, inherited)
        self.codes[self.row_of[polygon], pieces] = np.where(side > 0, IN_FRONT, BEHIND)
        return pieces, parents, -side if self.flipped[polygon] else side

    def _enter(self, group: Whole) -> Whole:
        """Mark who is in the group; returns it with large polygons first."""
        self.alive[:] = False
        self.alive[group] = True
        return group[np.lexsort((group, -self.size[group]))]

    def _geometry(self) -> Geometry:
        f = self.fragments
        return Geometry(
            f.shape, f.rows, f.fresh, f.planes, f.corners, f.slack, self.row_of, self.count
        )

    def _decide(self, rows: Whole, polygons: Whole) -> None:
        """Test relations that are still unknown, exactly."""
        new = self.codes[rows, polygons] == UNKNOWN
        rows, polygons = rows[new], polygons[new]
        self.codes[rows, polygons] = self.fragments.classify(polygons, rows)
        self.count[0] += len(rows)

    def _against(self, polygons: Whole) -> NDArray[np.bool_]:
        f = self.fragments
        mine, row = f.planes[f.source[polygons], 3:6], f.planes[self.row_of[polygons], 3:6]
        return (mine * row).sum(axis=1) < 0

    def _sizes(self, polygons: Whole) -> NDArray[np.float64]:
        """(p,) squared diagonals of polygons' bounds."""
        f = self.fragments
        parts = [f.rows[f.start[p] : f.start[p] + f.count[p], :3] for p in polygons]
        return np.array([((part.max(axis=0) - part.min(axis=0)) ** 2).sum() for part in parts])

    def _reserve(self, room: int) -> None:
        have = self.codes.shape[1]
        if room <= have:
            return
        more = max(room, have * 3 // 2) - have
        self.codes = np.pad(self.codes, ((0, 0), (0, more)), constant_values=UNKNOWN)
        for name in ("row_of", "flipped", "alive", "size"):
            setattr(self, name, np.pad(getattr(self, name), (0, more)))


def costs(counts: Whole, weight: float) -> tuple[NDArray[np.float64], Whole]:
    """What planes cost and how they lean, from counts (p, 3) in front, behind and cut."""
    front, back, cut = counts.T
    return cut - weight * np.log2(1.0 + np.minimum(front, back)), np.abs(front - back)
