"""Light that does not get into hollows, baked into the colours of a model's vertices.

A model is cut into voxels. From each vertex rays go out over the hemisphere about its normal, as
many towards a direction as it sends light to; what a ray meets near by takes its light, less the
farther away it is. Convex models have no hollows, and models of few vertices nowhere to show
them: both stay as they are. It follows from the model
alone: what a technique does with the thing, and where it stands, changes nothing.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats
from seethrough.renderer.scene.geometry import Mesh

VOXELS = 40  # along a model's longest side
RAYS = 24
NEAR = 1.6  # voxels between a vertex and where its rays begin: the surface itself hides nothing
FAR = 14.0  # voxels, beyond which nothing hides
LEAST = 200  # vertices: what has fewer has none where hollows begin and end, as a wall
KEPT = 256  # models, each at one strength


@lru_cache(maxsize=KEPT)
def occluded(mesh: Mesh, strength: float) -> Mesh:
    """The mesh with its hollows darkened, by so much where no light gets in."""
    if mesh.convex or len(mesh.vertices) < LEAST:
        return mesh
    left = 1 - strength * hidden(mesh)
    return replace(mesh, colors=mesh.colors * left[:, None])


@lru_cache(maxsize=KEPT)
def hidden(mesh: Mesh) -> Floats:
    """(n,) how much of its light each vertex loses."""
    size = float(np.ptp(mesh.bounds, axis=0).max()) / VOXELS
    points = (mesh.vertices - mesh.bounds[0]) / size + 1.0
    shape = np.ceil(points.max(axis=0)).astype(int) + 2
    filled = np.zeros(tuple(shape.tolist()), np.bool_)
    _fill(points, mesh.triangles, filled)
    found = _hidden(points, mesh.normals, _rays(), filled)
    return _smoothed(mesh, found)


def _rays() -> Floats:
    """(RAYS, 3) directions about z, each of equal weight by the cosine, on a spiral."""
    k = np.arange(RAYS) + 0.5
    up = np.sqrt(1 - k / RAYS)
    around = k * np.pi * (3 - np.sqrt(5))
    flat = np.sqrt(k / RAYS)
    return np.stack([flat * np.cos(around), flat * np.sin(around), up], axis=1)


def _smoothed(mesh: Mesh, values: Floats) -> Floats:
    """Half of each vertex's own, half of its neighbours' mean: voxels are coarse."""
    total, count = np.zeros(len(values)), np.zeros(len(values))
    for a, b in ((0, 1), (1, 2), (2, 0)):
        for i, j in ((a, b), (b, a)):
            np.add.at(total, mesh.triangles[:, i], values[mesh.triangles[:, j]])
            np.add.at(count, mesh.triangles[:, i], 1.0)
    around = np.where(count > 0, total / np.maximum(count, 1), values)
    return np.asarray((values + around) / 2)


@njit(cache=True)
def _fill(points: Floats, triangles: NDArray[np.int32], filled: Bools) -> None:
    """Mark the voxels that surfaces run through, by points on them half a voxel apart."""
    for t in range(len(triangles)):
        a, b, c = points[triangles[t, 0]], points[triangles[t, 1]], points[triangles[t, 2]]
        longest = max(np.abs(b - a).max(), np.abs(c - a).max(), np.abs(c - b).max())
        steps = int(np.ceil(2 * longest)) + 1
        for i in range(steps + 1):
            for j in range(steps + 1 - i):
                u, v = i / steps, j / steps
                x = a[0] + u * (b[0] - a[0]) + v * (c[0] - a[0])
                y = a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1])
                z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
                filled[int(x), int(y), int(z)] = True


@njit(cache=True)
def _hidden(points: Floats, normals: Floats, rays: Floats, filled: Bools) -> Floats:
    found = np.zeros(len(points))
    for p in range(len(points)):
        n = normals[p]
        # Two directions across the normal (Duff et al. 2017).
        sign = 1.0 if n[2] >= 0 else -1.0
        a = -1.0 / (sign + n[2])
        b = n[0] * n[1] * a
        t = np.array([1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]])
        s = np.array([b, sign + n[1] * n[1] * a, -n[1]])
        total = 0.0
        for k in range(len(rays)):
            way = rays[k, 0] * t + rays[k, 1] * s + rays[k, 2] * n
            far = NEAR
            while far < FAR:
                x = int(points[p, 0] + NEAR * n[0] + (far - NEAR) * way[0])
                y = int(points[p, 1] + NEAR * n[1] + (far - NEAR) * way[1])
                z = int(points[p, 2] + NEAR * n[2] + (far - NEAR) * way[2])
                inside = 0 <= x < filled.shape[0] and 0 <= y < filled.shape[1]
                if not (inside and 0 <= z < filled.shape[2]):
                    break
                if filled[x, y, z]:
                    total += 1.0 - (far - NEAR) / (FAR - NEAR)
                    break
                far += 0.7
        found[p] = total / len(rays)
    return found
