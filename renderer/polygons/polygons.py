"""Flat polygons as arrays, and the refusal of what no method can order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole

# Coordinates beyond this overflow in the cubic terms of a side test.
LARGEST = 1e90
# How far a vertex may lie off its polygon's plane, relative to the polygon's size: what rounding
# a turned or moved polygon to float64 costs, with room to spare.
FLATNESS = 1e-9


@dataclass(frozen=True, eq=False, slots=True)
class Polygons:
    """Flat polygons with three or more corners, convex or concave, each a simple loop.

    `vertices` (n, 3) float64, world units, counter-clockwise seen from the front. Polygon i has
    the corners starts[i] to starts[i + 1]; `starts` (m + 1,) int64. `attributes` (n, k) float64
    belong to corners and are interpolated along cut edges: colours, texture coordinates, normals.
    `objects` (m,) int64 says which object a polygon is part of. A hole is joined to the outline
    by a pair of bridging edges. `normals` is the first of three attributes that are the corner's
    unit normal, which cuts keep as long as one; -1: there are none.
    """

    vertices: Floats
    starts: Whole
    attributes: Floats
    objects: Whole
    normals: int = -1

    def __len__(self) -> int:
        return len(self.starts) - 1

    @property
    def counts(self) -> Whole:
        """(m,) corners of each polygon."""
        return np.diff(self.starts)

    def corners(self, index: int | np.integer) -> Floats:
        """(c, 3) corners of one polygon."""
        return self.vertices[self.starts[index] : self.starts[index + 1]]

    def take(self, indices: Whole) -> Polygons:
        """The polygons at `indices`, in that order."""
        indices = np.asarray(indices, np.int64)
        counts = self.counts[indices]
        starts = np.concatenate([[0], np.cumsum(counts)])
        rows = np.repeat(self.starts[indices] - starts[:-1], counts) + np.arange(starts[-1])
        return Polygons(
            self.vertices[rows], starts, self.attributes[rows], self.objects[indices], self.normals
        )


def polygons_from(
    faces: Sequence[Sequence[Sequence[float]] | Floats],
    attributes: Sequence[Floats] | None = None,
    objects: Whole | None = None,
) -> Polygons:
    """Polygons from a list of (c, 3) corners each. Raises ValueError as `check` does."""
    loops = [np.asarray(face, np.float64).reshape(-1, 3) for face in faces]
    counts = np.array([len(loop) for loop in loops], np.int64)
    vertices = np.concatenate(loops) if loops else np.empty((0, 3))
    columns = (
        np.empty((len(vertices), 0))
        if attributes is None
        else np.concatenate([np.asarray(rows, np.float64) for rows in attributes])
    )
    labels = np.arange(len(loops)) if objects is None else np.asarray(objects)
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    result = Polygons(vertices, starts, columns, labels.astype(np.int64))
    check(result)
    return result


def triangles_from(
    vertices: Floats,
    triangles: NDArray[np.integer],
    attributes: Floats | None = None,
    objects: Whole | None = None,
) -> Polygons:
    """Polygons from (v, 3) vertices, (m, 3) vertex indices and (v, k) vertex attributes."""
    triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
    corners = triangles.ravel()
    columns = np.empty((len(vertices), 0)) if attributes is None else np.asarray(attributes)
    labels = np.zeros(len(triangles), np.int64) if objects is None else np.asarray(objects)
    result = Polygons(
        np.ascontiguousarray(np.asarray(vertices, np.float64)[corners]),
        np.arange(len(triangles) + 1, dtype=np.int64) * 3,
        np.ascontiguousarray(columns[corners], np.float64),
        labels.astype(np.int64),
    )
    check(result)
    return result


def join(parts: Sequence[Polygons]) -> Polygons:
    """All polygons of several sets, in order; objects are numbered on from part to part."""
    shift = np.concatenate([[0], np.cumsum([len(p.vertices) for p in parts])])
    starts = [p.starts[:-1] + s for p, s in zip(parts, shift, strict=False)]
    labels, base = [], 0
    for part in parts:
        labels.append(part.objects + base)
        base += int(part.objects.max(initial=-1)) + 1
    return Polygons(
        np.concatenate([p.vertices for p in parts]),
        np.concatenate([*starts, shift[-1:]]).astype(np.int64),
        np.concatenate([p.attributes for p in parts]),
        np.concatenate(labels),
        parts[0].normals,
    )


def newell(polygons: Polygons) -> Floats:
    """(m, 3) normals, as long as twice the area: Newell's sum over the corners."""
    first = polygons.starts[:-1]
    counts = polygons.counts
    base = np.repeat(polygons.vertices[first], counts, axis=0)
    local = polygons.vertices - base
    following = np.arange(1, len(local) + 1)
    following[polygons.starts[1:] - 1] = first
    return np.add.reduceat(np.cross(local, local[following]), first, axis=0)


def check(polygons: Polygons) -> None:
    """Refuse, by index and value, what cannot be ordered.

    Raises ValueError for a polygon of fewer than three corners, for coordinates or attributes
    that are not finite or too large, and for corners that do not lie in one plane.
    """
    counts = polygons.counts
    few = np.flatnonzero(counts < 3)
    if len(few):
        raise ValueError(f"polygon {few[0]}: {counts[few[0]]} vertices, expected three or more")
    if len(polygons) == 0:
        return
    with np.errstate(invalid="ignore"):
        usable = np.all(np.abs(polygons.vertices) < LARGEST, axis=1)
    _refuse(polygons, usable, polygons.vertices, f"finite and below {LARGEST:g}")
    finite = np.all(np.isfinite(polygons.attributes), axis=1)
    _refuse(polygons, finite, polygons.attributes, "finite values")
    _check_flatness(polygons)


def _refuse(polygons: Polygons, good: NDArray[np.bool_], values: Floats, expected: str) -> None:
    bad = np.flatnonzero(~good)
    if len(bad):
        owner = int(np.searchsorted(polygons.starts, bad[0], side="right")) - 1
        shown = ", ".join(f"{v:g}" for v in values[bad[0]])
        corner = bad[0] - polygons.starts[owner]
        raise ValueError(f"polygon {owner}: vertex {corner} = ({shown}), expected {expected}")


def _check_flatness(polygons: Polygons) -> None:
    larger = np.flatnonzero(polygons.counts > 3)
    if not len(larger):
        return
    some = polygons.take(larger)
    first = some.starts[:-1]
    local = some.vertices - np.repeat(some.vertices[first], some.counts, axis=0)
    size = np.sqrt(np.maximum.reduceat((local**2).sum(axis=1), first))
    rounding = 16 * np.finfo(float).eps * np.maximum.reduceat(np.abs(some.vertices).max(1), first)
    allowed = FLATNESS * size + rounding
    normal = newell(some)
    length = np.linalg.norm(normal, axis=1)
    # A normal this short is rounding: the corners must then lie on a line.
    flat = length > allowed * size
    unit = normal / np.where(flat, length, 1.0)[:, None]
    off = np.abs((local * np.repeat(unit, some.counts, axis=0)).sum(axis=1))
    off = np.where(np.repeat(flat, some.counts), off, _off_line(some, local))
    excess = off - np.repeat(allowed, some.counts)
    if (excess > 0).any():
        owner = int(np.searchsorted(some.starts, np.argmax(excess > 0), side="right")) - 1
        part = slice(some.starts[owner], some.starts[owner + 1])
        worst = int(np.argmax(excess[part]))
        raise ValueError(
            f"polygon {larger[owner]}: vertex {worst} lies {off[part][worst]:.3g} off its plane, "
            f"expected a flat polygon (within {allowed[owner]:.2g}; split it into triangles)"
        )


def _off_line(polygons: Polygons, local: Floats) -> Floats:
    """(n,) distance of each corner from the line to its polygon's farthest corner."""
    first, counts = polygons.starts[:-1], polygons.counts
    reach = (local**2).sum(axis=1)
    farthest = np.array(
        [f + np.argmax(reach[f : f + c]) for f, c in zip(first, counts, strict=True)]
    )
    line = local[farthest]
    length = np.linalg.norm(line, axis=1)
    unit = np.repeat(line / np.where(length > 0, length, 1.0)[:, None], counts, axis=0)
    return np.linalg.norm(np.cross(local, unit), axis=1)
