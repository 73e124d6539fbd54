"""The outline of a mesh as seen from a point: edges between a front and a back face.

The distance to an object on the screen is the distance to the union of its front-facing
triangles, and so to the nearest of these edges: all others have a front face on either side.
Edges inside the outline may come along; they do no harm, for they lie within the union.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.geometry import Mesh


@dataclass(frozen=True, eq=False)
class Topology:
    """A mesh without its seams: vertices at one place are one vertex.

    points (v, 3); faces (m, 3); planes (m, 4): normal (not unit) and offset, so that a point p is
    in front of the face where normal · p > offset; edges (e, 2) vertices; sides (e, 2) the faces
    on both sides, −1 where there is none; closed: every edge has two faces.
    """

    points: NDArray[np.float64]
    faces: NDArray[np.int64]
    planes: NDArray[np.float64]
    edges: NDArray[np.int64]
    sides: NDArray[np.int64]
    closed: bool


def topology(mesh: Mesh) -> Topology:
    """Weld the vertices that coincide and find the edges, without degenerate faces."""
    points, which = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = which.reshape(-1)[mesh.triangles].astype(np.int64).reshape(-1, 3)
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    normals = np.cross(b - a, c - a)
    solid = (normals != 0).any(axis=1)
    faces, normals, a = faces[solid], normals[solid], a[solid]
    planes = np.concatenate([normals, (normals * a).sum(axis=1, keepdims=True)], axis=1)
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(faces)), 3)
    by_edge = np.lexsort((owner, ends[:, 1], ends[:, 0]))
    ends, owner = ends[by_edge], owner[by_edge]
    first = np.ones(len(ends), dtype=bool)
    first[1:] = (ends[1:] != ends[:-1]).any(axis=1)
    last = np.roll(first, -1)
    # One row for each pair of faces that follow each other on an edge; a lone face has one row.
    lone = first & last
    pair = np.nonzero(~last)[0]
    edges = np.concatenate([ends[lone], ends[pair]])
    sides = np.concatenate(
        [
            np.stack([owner[lone], np.full(lone.sum(), -1)], 1),
            np.stack([owner[pair], owner[pair + 1]], 1),
        ]
    )
    return Topology(points, faces, planes, edges, sides, not lone.any())


def silhouette(shape: Topology, eye: NDArray[np.float64]) -> NDArray[np.int64]:
    """(k, 2) vertices of the edges with a front face on one side only; `eye` in mesh space."""
    front = shape.planes[:, :3] @ eye > shape.planes[:, 3]
    front = np.append(front, False)  # index −1: no face
    return shape.edges[front[shape.sides[:, 0]] != front[shape.sides[:, 1]]]


def near_cuts(
    shape: Topology, eye: NDArray[np.float64], depth: NDArray[np.float64], near: float
) -> NDArray[np.float64]:
    """(k, 2, 3) segments, in mesh space, in which the near plane cuts front-facing triangles.

    `depth` (v,) is the view depth of the vertices.
    """
    front = shape.planes[:, :3] @ eye > shape.planes[:, 3]
    ahead = depth[shape.faces] >= near
    faces = shape.faces[front & ahead.any(axis=1) & ~ahead.all(axis=1)]
    a, b = faces, np.roll(faces, -1, axis=1)
    da, db = depth[a], depth[b]
    cut = (da >= near) != (db >= near)  # two of the three edges
    t = (near - da[cut]) / (db[cut] - da[cut])
    points = shape.points[a[cut]] + t[:, None] * (shape.points[b[cut]] - shape.points[a[cut]])
    return points.reshape(-1, 2, 3)
