"""The fragments of a set of polygons while a method cuts them up, and what became of each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Whole
from seethrough.renderer.polygons.classification import (
    COUNT,
    SOURCE,
    START,
    Pieces,
    Planes,
    classify,
)
from seethrough.renderer.polygons.cutting import cut, interpolate
from seethrough.renderer.polygons.polygons import Polygons, check
from seethrough.renderer.polygons.predicates import (
    has_area,
    plane_corners,
    plane_ids,
    plane_rows,
    point_slacks,
    sides,
    thickness,
)

COPLANAR, IN_FRONT, BEHIND, CUT = 0, 1, 2, 3
MOST_PIECES = 2_000_000
"""Of all polygons together, cut or not: a gibibyte of them, and seconds to make."""
# Interpolated unit normals shorter than this point nowhere.
CANCELLED = 1e-6

Indices = NDArray[np.int32]


class TooManyPieces(ValueError):
    """Polygons cross so densely that cutting them up would not end soon."""


class Fragments:
    """Polygons and all pieces ever cut from them; nothing is removed, so every cut can be redone.

    Fragments 0 to n - 1 are the input polygons. `source` names the polygon a fragment comes from,
    `parent` the fragment it was cut from and `cutter` the polygon that cut it (-1: none). Splitters
    are always given as *source* polygons; `plane_table` has their planes. `halves` cuts
    four-cornered pieces into triangles.
    """

    def __init__(
        self,
        polygons: Polygons,
        tolerance: float = 0.0,
        halves: bool = False,
        most: int = MOST_PIECES,
    ) -> None:
        check(polygons)
        self.most = most
        if not 0.0 <= tolerance < np.inf:
            raise ValueError(f"tolerance = {tolerance}, expected a finite distance, 0 or larger")
        n = len(polygons)
        self.tolerance, self.halves = float(tolerance), halves
        self.inputs = polygons
        self.corners = plane_corners(polygons)
        self.planes = plane_rows(self.corners)
        self.solid = has_area(self.corners) if n else np.empty(0, bool)
        thick = thickness(polygons, self.corners)
        self.slack = np.maximum(thick, tolerance)
        self.plane_of = plane_ids(polygons, self.corners, thick)
        self.plane_table = Planes(self.planes, self.plane_of, self.slack)
        self.rows = polygons.vertices.copy()
        self.edge = np.empty((len(self.rows), 2), np.int32)
        self.along = np.empty(len(self.rows))
        self.sign = np.zeros(len(self.rows), np.int8)
        self.fresh = np.zeros(len(self.rows), bool)
        self.shape = np.column_stack(
            [polygons.starts[:-1], polygons.counts, np.arange(n), self.plane_of]
        ).astype(np.int32)
        self.parent = np.full(n, -1, np.int32)
        self.cutter = np.full(n, -1, np.int32)
        self.used = np.array([len(self.rows), n], np.int64)

    @property
    def start(self) -> Indices:
        """First row of each fragment."""
        return self.shape[:, START]

    @property
    def count(self) -> Indices:
        """Corners of each fragment."""
        return self.shape[:, COUNT]

    @property
    def source(self) -> Indices:
        """Input polygon of each fragment."""
        return self.shape[:, SOURCE]

    def pieces(self) -> Pieces:
        """The arrays as compiled code takes them: others once a cut has made room."""
        return Pieces(
            self.shape, self.rows, self.fresh, self.edge, self.along, self.sign, self.parent,
            self.cutter, self.used,
        )  # fmt: skip

    def classify(self, fragments: Whole, splitters: Whole) -> NDArray[np.int8]:
        """COPLANAR, IN_FRONT, BEHIND or CUT of each fragment against its splitter."""
        code = np.empty(len(fragments), np.int8)
        # Few corners are undecided as a rule; if more are, once more with room for all.
        open_ = np.empty((2, 64 + len(fragments) // 16), np.int64)
        while True:
            waiting = classify(fragments, splitters, self.pieces(), self.plane_table, code, open_)
            if waiting <= open_.shape[1]:
                break
            open_ = np.empty((2, waiting), np.int64)
        if waiting:
            at, who = open_[:, :waiting]
            points, planes = self.rows[at], splitters[who]
            slack = np.maximum(
                self.slack[planes], np.where(self.fresh[at], point_slacks(points), 0)
            )
            found = sides(self.corners[planes], points, slack)
            self.sign[at] = found
            bits = np.where(found > 0, IN_FRONT, np.where(found < 0, BEHIND, COPLANAR))
            np.bitwise_or.at(code, who, bits.astype(np.int8))
        return code

    def cut(self, fragments: Whole, splitters: Whole) -> tuple[Whole, Whole, Whole]:
        """Cut what `classify` just found CUT by the same splitters.

        Returns the pieces, the position of each piece's parent in `fragments`, and its side.
        """
        corners = int(self.count[fragments].sum())
        # A loop of c corners has c crossings at most, each on two pieces. Halved quadrilaterals
        # have two corners more; a triangle falls into a triangle and one of these.
        if self.halves and corners == 3 * len(fragments):
            rows, pieces = 9 * len(fragments), 3 * len(fragments)
        else:
            rows, pieces = 4 * corners + 6 * len(fragments), 2 * corners
        self._reserve(rows, pieces)
        out = np.empty((2, pieces), np.int64)
        begin = int(self.used[1])
        made = cut(fragments, splitters, self.halves, self.pieces(), self.planes, out)
        if self.used[1] > self.most:
            raise TooManyPieces(
                f"{len(self.inputs)} polygons cross so densely that they fall into more than "
                f"{self.most} pieces: expected fewer crossings, or an order that cuts nothing"
            )
        return np.arange(begin, begin + made), out[0, :made].copy(), out[1, :made].copy()

    def polygons(self, fragments: Whole) -> Polygons:
        """Some fragments, as polygons, their attributes interpolated."""
        first, counts = self.start[fragments].astype(np.int64), self.count[fragments]
        starts = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        rows = np.repeat(first - starts[:-1], counts) + np.arange(starts[-1])
        source = self.source[fragments]
        attributes = np.empty((len(rows), self.inputs.attributes.shape[1]))
        # One attribute at a time: all rows of all attributes would be most of the memory.
        values = np.empty(int(self.used[0]) if attributes.shape[1] else 0)
        for k, column in enumerate(self.inputs.attributes.T):
            interpolate(column, self.edge, self.along, len(self.inputs.vertices), values)
            attributes[:, k] = values[rows]
        made = Polygons(
            self.rows[rows], starts, attributes, self.inputs.objects[source], self.inputs.normals
        )
        return self._unit_normals(made, rows, np.repeat(source, counts))

    def _unit_normals(self, made: Polygons, rows: Whole, source: Whole) -> Polygons:
        """Vertex normals of cut points as long as one again; where they cancel, the plane's."""
        at = made.normals
        cut = np.flatnonzero(self.fresh[rows])
        if at < 0 or not len(cut):
            return made
        normal = made.attributes[cut, at : at + 3]
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        flat = self.planes[source[cut]]
        usual = normal / np.where(length > 0, length, 1.0)
        made.attributes[cut, at : at + 3] = np.where(
            length > CANCELLED, usual, flat[:, 3:6] / flat[:, 9:10]
        )
        return made

    def _reserve(self, rows: int, fragments: int) -> None:
        needed = int(self.used[0]) + rows
        if needed > len(self.rows):
            for name in ("rows", "edge", "along", "sign", "fresh"):
                setattr(self, name, _grown(getattr(self, name), needed))
        needed = int(self.used[1]) + fragments
        if needed > len(self.shape):
            for name in ("shape", "parent", "cutter"):
                setattr(self, name, _grown(getattr(self, name), needed))


def _grown(array: NDArray[np.generic], needed: int) -> NDArray[np.generic]:
    larger = np.empty((max(needed, len(array) * 5 // 4), *array.shape[1:]), array.dtype)
    larger[: len(array)] = array
    return larger
