"""Which object of a scene fully encloses which other (Elmqvist2009 §VI: none may)."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object
from seethrough.renderer.scene.transforms import moved

# A vertex this far outside, relative to the mesh, still counts as inside: rather one scene
# object drawn again than one that hides another by a rounding error.
SLACK = 1e-9


def encloses(outer: Object, inner: Object) -> bool:
    """Whether `inner` lies in `outer` completely: exact for a convex `outer`, else conservative.

    A convex mesh holds another if it holds its vertices. A torus is judged by the smooth ring
    that holds its mesh: what it encloses has all its vertices in there.
    """
    inside = np.linalg.inv(outer.transform) @ inner.transform
    points = moved(inner.mesh.vertices, inside)
    if outer.mesh.convex:
        normals, offsets = half_spaces(outer.mesh)
        return bool((points @ normals.T <= offsets + SLACK).all())
    return bool(_in_ring(outer.mesh, points).all())


@lru_cache(maxsize=64)
def half_spaces(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outward unit normals (m, 3) and offsets (m,): inside is points @ normals ≤ offsets."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, np.einsum("mj,mj->m", normals, a)


def _in_ring(mesh: Mesh, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) points in the smooth torus that holds the mesh, which lies flat about the origin."""
    reach = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2])
    radius, tube = (reach.max() + reach.min()) / 2, (reach.max() - reach.min()) / 2
    away = np.hypot(np.hypot(points[:, 0], points[:, 2]) - radius, points[:, 1])
    inside: NDArray[np.bool_] = away <= tube + SLACK
    return inside


def enclosing_pairs(objects: list[Object] | tuple[Object, ...]) -> list[tuple[int, int]]:
    """(outer, inner) for every pair in which one object encloses the other.

    Only a pair whose bounding spheres allow it is looked at: the centre of what is enclosed lies
    in the sphere about what encloses it.
    """
    centers = np.array([o.transform[:3, 3] for o in objects])
    reach = np.array([bounding_radius(o) for o in objects])
    apart = np.linalg.norm(centers[:, None] - centers[None], axis=2)
    possible = apart <= reach[:, None] * (1 + SLACK)
    np.fill_diagonal(possible, False)
    pairs = np.argwhere(possible)
    return [(int(i), int(j)) for i, j in pairs if encloses(objects[i], objects[j])]


def bounding_radius(thing: Object) -> float:
    """Radius of the sphere about the object's origin that holds its vertices, in world units."""
    linear = thing.transform[:3, :3]
    return farthest(thing.mesh.vertices @ linear.T)


def farthest(points: NDArray[np.float64]) -> float:
    """Greatest distance of (n, 3) points from the origin."""
    return sqrt(np.add.reduce(points * points, axis=1).max())  # one root instead of n
