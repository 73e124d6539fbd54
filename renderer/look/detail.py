"""Levels of detail: a mesh in fewer triangles of its own vertices, and how far off each is."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from seethrough.renderer.arrays import Floats, Ints
from seethrough.renderer.scene.geometry import Mesh

DETAILS = 6
STEPS = 0.00125 * 2.0 ** np.arange(DETAILS)  # of a mesh's radius, that a level may be off
LEAST = 200  # triangles from which on there are levels
WELD = 1e-6  # of a mesh's size: corners so near to one another are one


@dataclass(frozen=True, eq=False)
class Levels:
    """triangles: (k, 3) of each level, from fine to coarse; errors (levels,): how far they are off
    the mesh, in its units."""

    triangles: tuple[Ints, ...]
    errors: Floats


def levels(mesh: Mesh) -> Levels:
    """The levels of a mesh, none for a mesh of few triangles."""
    if len(mesh.triangles) < LEAST:
        return Levels((), np.zeros(0))
    from seethrough.renderer.look.collapse import collapsed  # its kernels take a moment to load

    size = float(np.ptp(mesh.bounds, axis=0).max())
    cells = np.round((mesh.vertices - mesh.bounds[0]) / (size * WELD)).astype(np.int64)
    _, first, place_of = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    triangles = mesh.triangles.astype(np.int64)
    place_of = place_of.ravel()
    corner = place_of[triangles]
    whole = (corner != np.roll(corner, 1, axis=1)).all(axis=1)
    triangles = triangles[whole]
    errors: Floats = np.asarray(STEPS * mesh.radius, dtype=np.float64)
    found, starts = collapsed(
        mesh.vertices[first], place_of, triangles, across(place_of[triangles]), errors
    )
    parts = tuple(found[a:b] for a, b in pairwise(starts.tolist()))
    return Levels(parts, errors)


def across(corners: Ints) -> Ints:
    """(m, 3) the corner 3 t + k whose edge runs the other way along each edge of triangles (m, 3);
    −1 where there is none, or where more than two triangles meet."""
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    n = int(corners.max(initial=0)) + 1
    key = np.minimum(start, end) * n + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    same = np.concatenate([[False], np.diff(key[order]) == 0, [False]])
    pair = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])
    one, two = order[pair], order[pair + 1]
    opposite = start[one] == end[two]
    found = np.full(len(start), -1)
    found[one[opposite]], found[two[opposite]] = two[opposite], one[opposite]
    return found.reshape(-1, 3)
