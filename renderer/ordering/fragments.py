"""The fragments of a set of polygons while a method cuts them up, and what became of each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renderer.ordering.cutting import classify, cut
from renderer.ordering.polygons import Integers, Polygons, check
from renderer.ordering.predicates import (
    has_area,
    plane_corners,
    plane_ids,
    plane_rows,
    point_slacks,
    sides,
    thickness,
)

COPLANAR, IN_FRONT, BEHIND, CUT = 0, 1, 2, 3


class Fragments:
    """Polygons and all pieces ever cut from them; nothing is removed, so every cut can be redone.

    Fragments 0 to n - 1 are the input polygons. `source` names the polygon a fragment comes from,
    `parent` the fragment it was cut from and `cutter` the polygon that cut it (-1: none). Splitters
    are always given as *source* polygons. `halves` cuts four-cornered pieces into triangles.
    """

    def __init__(self, polygons: Polygons, tolerance: float = 0.0, halves: bool = False) -> None:
        check(polygons)
        if not 0.0 <= tolerance < np.inf:
            raise ValueError(f"tolerance = {tolerance}, expected a finite distance, 0 or larger")
        n = len(polygons)
        self.tolerance, self.halves = float(tolerance), halves
        self.rows = np.column_stack([polygons.vertices, polygons.attributes])
        self.sign = np.zeros(len(self.rows), np.int8)
        self.start = polygons.starts[:-1].copy()
        self.count = polygons.counts.copy()
        self.source = np.arange(n)
        self.parent = np.full(n, -1, np.int64)
        self.cutter = np.full(n, -1, np.int64)
        self.objects = polygons.objects
        self.used = np.array([len(self.rows), n], np.int64)
        self.corners = plane_corners(polygons)
        self.planes = plane_rows(self.corners)
        self.solid = has_area(self.corners) if n else np.empty(0, bool)
        thick = thickness(polygons, self.corners)
        self.slack = np.maximum(thick, tolerance)
        self.fresh = np.zeros(len(self.rows), bool)
        self.plane_of = plane_ids(polygons, self.corners, thick)

    def classify(self, fragments: Integers, splitters: Integers) -> NDArray[np.int8]:
        """COPLANAR, IN_FRONT, BEHIND or CUT of each fragment against its splitter."""
        code = np.empty(len(fragments), np.int8)
        open_ = np.empty((2, int(self.count[fragments].sum())), np.int64)
        waiting = classify(
            fragments, splitters, self.start, self.count, self.source, self.rows,
            self.fresh, self.planes, self.plane_of, self.slack, self.sign, code, open_,
        )  # fmt: skip
        if waiting:
            at, who = open_[:, :waiting]
            points, planes = self.rows[at, :3], splitters[who]
            slack = np.maximum(
                self.slack[planes], np.where(self.fresh[at], point_slacks(points), 0)
            )
            found = sides(self.corners[planes], points, slack)
            self.sign[at] = found
            bits = np.where(found > 0, IN_FRONT, np.where(found < 0, BEHIND, COPLANAR))
            np.bitwise_or.at(code, who, bits.astype(np.int8))
        return code

    def cut(self, fragments: Integers, splitters: Integers) -> tuple[Integers, Integers, Integers]:
        """Cut what `classify` just found CUT by the same splitters.

        Returns the pieces, the position of each piece's parent in `fragments`, and its side.
        """
        corners = int(self.count[fragments].sum())
        self._reserve(4 * corners + 6 * len(fragments), 2 * corners)
        out = np.empty((2, 2 * corners + 2), np.int64)
        begin = int(self.used[1])
        made = cut(
            fragments, splitters, self.halves, self.start, self.count, self.source, self.rows,
            self.fresh, self.planes, self.sign, self.used, self.parent, self.cutter, out,
        )  # fmt: skip
        return np.arange(begin, begin + made), out[0, :made].copy(), out[1, :made].copy()

    def polygons(self, fragments: Integers) -> Polygons:
        """Some fragments, as polygons."""
        starts = np.concatenate([self.start[: self.used[1]], self.used[:1]])
        columns = self.rows[: self.used[0]]
        everything = Polygons(
            columns[:, :3], starts, columns[:, 3:], self.objects[self.source[: self.used[1]]]
        )
        return everything.take(fragments)

    def _reserve(self, rows: int, fragments: int) -> None:
        needed = int(self.used[0]) + rows
        if needed > len(self.rows):
            self.rows = _grown(self.rows, needed)
            self.sign = _grown(self.sign, len(self.rows))
            self.fresh = _grown(self.fresh, len(self.rows))
        needed = int(self.used[1]) + fragments
        if needed > len(self.start):
            for name in ("start", "count", "source", "parent", "cutter"):
                setattr(self, name, _grown(getattr(self, name), needed))


def _grown(array: NDArray, needed: int) -> NDArray:
    larger = np.empty((max(needed, len(array) * 3 // 2), *array.shape[1:]), array.dtype)
    larger[: len(array)] = array
    return larger
