"""Meshes as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles with normals and colours, in the mesh's own frame (CONVENTIONS.md).

    vertices (n, 3) float64; normals (n, 3) float64, unit length; colors (n, 3) float64 in
    [0, 1]; triangles (m, 3) int32, counter-clockwise seen from outside. Scenes share meshes by
    identity, so the renderer draws all objects of one mesh in one instanced draw.
    """

    vertices: NDArray[np.float64]
    normals: NDArray[np.float64]
    colors: NDArray[np.float64]
    triangles: NDArray[np.int32]
    convex: bool = False

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) lowest and highest corner."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def center(self) -> NDArray[np.float64]:
        """(3,) centre of the bounds."""
        return self.bounds.mean(axis=0)

    @cached_property
    def radius(self) -> float:
        """Radius of the sphere about `center` that holds every vertex."""
        return float(np.linalg.norm(self.vertices - self.center, axis=1).max())
