"""The edges of a mesh that may show in a picture: where a smooth surface turns away from the eye,
and where colour or shading breaks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.masks.silhouettes import Topology, topology
from seethrough.renderer.scene.geometry import Mesh

TURNED = 0.08  # of two normals at one place, from which on shading breaks: less is not seen
TINTED = 0.03  # the same of colours


@dataclass(frozen=True, eq=False)
class EdgeSet:
    """ends (e, 2, 3) in mesh space; sides (e, 2) the faces on both sides, f where there is none;
    crease (e,) whether colour or shading breaks there; planes (f, 4) as Topology has them."""

    ends: Floats
    sides: NDArray[np.int32]
    crease: Bools
    planes: Floats


def edge_set(mesh: Mesh) -> EdgeSet:
    """The edges of a mesh."""
    shape = topology(mesh)
    sides = np.where(shape.sides < 0, len(shape.planes), shape.sides)
    return EdgeSet(shape.points[shape.edges], sides.astype(np.int32), _creases(mesh, shape),
                   shape.planes)  # fmt: skip


def _creases(mesh: Mesh, shape: Topology) -> Bools:
    """(e,) where the faces of an edge have other normals or colours at its ends."""
    points, which = np.unique(mesh.vertices, axis=0, return_inverse=True)
    welded = which.reshape(-1)[mesh.triangles].reshape(-1, 3)
    a, b, c = (points[welded[:, k]] for k in range(3))
    solid = (np.cross(b - a, c - a) != 0).any(axis=1)  # those that the topology has
    corners = mesh.triangles[solid]
    found = np.zeros(len(shape.edges), dtype=bool)
    both = (shape.sides >= 0).all(axis=1)
    attributes = np.concatenate([mesh.normals / TURNED, mesh.colors / TINTED], axis=1)
    for end in range(2):
        at = []
        for side in range(2):
            faces = shape.sides[both, side]
            corner = (shape.faces[faces] == shape.edges[both, end][:, None]).argmax(axis=1)
            at.append(attributes[corners[faces, corner]])
        found[both] |= (np.abs(at[0] - at[1]) > 1).any(axis=1)
    return found
