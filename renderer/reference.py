"""The exact picture, on the CPU in float64: what every shader is measured against.

One fragment for each object and pixel, its front-most; at each pixel the objects are sorted from
front to back, i = 1…m. Object i shows with opacity a_i = Π M_s over the targets s behind it (1
where it is impenetrable), and its share of the pixel is w_i = a_i · Π_{j before i} (1 − a_j).
M_s is the mask of s: on its silhouette it lies where s lies, beside it at the depth of s's centre.
Distances are Euclidean, to the union of the target's visible triangles. Nothing here is shared
with the shaders but the light, the gradient and the projection.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from renderer import lighting, projection
from renderer.camera import Camera
from renderer.masks import opacity
from renderer.plan import Technique
from renderer.scene import Object, Scene
from renderer.techniques.standard import Standard

EDGE = 1.0 / 256.0


@dataclass(frozen=True, eq=False)
class Fragments:
    """What each object shows before anything is blended.

    depth (n, h, w): view depth of the front-most surface, inf where there is none; color
    (n, h, w, 3) lit; distance (n, h, w): pixels from the object's outline, 0 on it (only of
    targets, inf for others); near_edge (h, w): pixels whose centre lies within 1/256 pixel of a
    projected edge, where float32 and float64 may disagree.
    """

    depth: NDArray[np.float64]
    color: NDArray[np.float64]
    distance: NDArray[np.float64]
    near_edge: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class ExactPicture:
    """picture (h, w, 3) in [0, 1]; weights (n, h, w): each object's share of the pixel;
    transmittance (n, h, w): what the objects in front leave, 1 where the object is not."""

    picture: NDArray[np.float64]
    weights: NDArray[np.float64]
    transmittance: NDArray[np.float64]
    near_edge: NDArray[np.bool_]


def fragments(scene: Scene, camera: Camera, size: tuple[int, int], reach: float = 0.0) -> Fragments:
    """Rasterise every object. Distances are found up to `reach` pixels."""
    width, height = size
    n = len(scene.objects)
    depth = np.full((n, height, width), np.inf)
    color = np.zeros((n, height, width, 3))
    distance = np.full((n, height, width), np.inf)
    near_edge = np.zeros((height, width), dtype=np.bool_)
    for i, thing in enumerate(scene.objects):
        pieces = _visible_triangles(thing, camera, size)
        if len(pieces):
            normals = np.zeros((height, width, 3))
            points = np.zeros((height, width, 3))
            colors = np.zeros((height, width, 3))
            _rasterise(pieces, depth[i], normals, points, colors, near_edge)
            color[i] = _lit(depth[i], normals, points, colors, camera)
        if thing.target:
            _distances(pieces[:, :, :2], distance[i], reach)
            distance[i][np.isfinite(depth[i])] = 0.0
    return Fragments(depth, color, distance, near_edge)


def _lit(depth, normals, points, colors, camera):  # type: ignore[no-untyped-def]
    """Colours of one object's surface; its normals and points are in camera coordinates."""
    there = np.isfinite(depth)
    lit = np.zeros_like(colors)
    turned = camera.rotation.T
    factor = lighting.shade(normals[there] @ turned, -points[there] @ turned)
    lit[there] = np.minimum(colors[there] * factor[:, None], 1.0)
    return lit


def _visible_triangles(thing: Object, camera: Camera, size: tuple[int, int]) -> NDArray[np.float64]:
    """(k, 3, 12) front-facing triangles beyond the near plane; a vertex is its pixel x, y, 1/depth,
    then normal, camera point and colour, each divided by the depth."""
    matrix = thing.transform
    mesh = thing.mesh
    world = mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    normals = mesh.normals @ np.linalg.inv(matrix[:3, :3]) @ camera.rotation
    points = projection.to_camera(world, camera)
    colors = mesh.colors * np.asarray(thing.color)
    triangles = mesh.triangles
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
    a, b, c = (points[triangles[:, k]] for k in range(3))
    front = (np.cross(b - a, c - a) * -a).sum(axis=1) > 0
    rows = np.concatenate([points, normals, colors], axis=1)[triangles[front]]
    rows = _clipped(rows, camera.near, camera.far)
    depth = -rows[..., 2]
    flat = projection.to_pixels(rows[..., :3], camera, size)
    parts = [flat, 1 / depth[..., None]] + [
        rows[..., k : k + 3] / depth[..., None] for k in (3, 0, 6)
    ]
    return np.ascontiguousarray(np.concatenate(parts, axis=-1))


def _clipped(rows: NDArray[np.float64], near: float, far: float) -> NDArray[np.float64]:
    """Triangles (k, 3, 9) cut at the near and far planes (Sutherland and Hodgman)."""
    for sign, limit in ((1.0, near), (-1.0, far)):
        above = sign * (-rows[..., 2] - limit)
        whole = (above >= 0).all(axis=1)
        pieces = [rows[whole]]
        for triangle, side in zip(rows[~whole], above[~whole], strict=True):
            polygon = []
            for k in range(3):
                j = (k + 1) % 3
                if side[k] >= 0:
                    polygon.append(triangle[k])
                if (side[k] >= 0) != (side[j] >= 0):
                    t = side[k] / (side[k] - side[j])
                    polygon.append(triangle[k] + t * (triangle[j] - triangle[k]))
            fan = [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
            pieces.append(np.array(fan).reshape(-1, 3, rows.shape[2]))
        rows = np.concatenate(pieces)
    return rows


@njit(cache=True)
def _rasterise(pieces, depth, normals, points, colors, near_edge):  # type: ignore[no-untyped-def]
    """Keep the nearest surface of one object at each pixel centre."""
    height, width = depth.shape
    for t in range(len(pieces)):
        p = pieces[t]
        area = (p[1, 0] - p[0, 0]) * (p[2, 1] - p[0, 1]) - (p[1, 1] - p[0, 1]) * (p[2, 0] - p[0, 0])
        x0, x1 = min(p[0, 0], p[1, 0], p[2, 0]), max(p[0, 0], p[1, 0], p[2, 0])
        y0, y1 = min(p[0, 1], p[1, 1], p[2, 1]), max(p[0, 1], p[1, 1], p[2, 1])
        for r in range(max(0, int(y0) - 1), min(height, int(min(y1, height)) + 2)):
            for c in range(max(0, int(x0) - 1), min(width, int(min(x1, width)) + 2)):
                x, y = c + 0.5, r + 0.5
                if _to_edges(p, x, y) < 1.0 / 256.0:
                    near_edge[r, c] = True
                if area == 0:
                    continue
                a = ((p[1, 0] - x) * (p[2, 1] - y) - (p[1, 1] - y) * (p[2, 0] - x)) / area
                b = ((p[2, 0] - x) * (p[0, 1] - y) - (p[2, 1] - y) * (p[0, 0] - x)) / area
                g = 1.0 - a - b
                if a < 0 or b < 0 or g < 0:
                    continue
                z = 1.0 / (a * p[0, 2] + b * p[1, 2] + g * p[2, 2])
                if z < depth[r, c]:
                    depth[r, c] = z
                    for k in range(3):
                        m = z * (a * p[0, 3 + k] + b * p[1, 3 + k] + g * p[2, 3 + k])
                        normals[r, c, k] = m
                        m = z * (a * p[0, 6 + k] + b * p[1, 6 + k] + g * p[2, 6 + k])
                        points[r, c, k] = m
                        m = z * (a * p[0, 9 + k] + b * p[1, 9 + k] + g * p[2, 9 + k])
                        colors[r, c, k] = m


@njit(cache=True)
def _to_edges(p, x, y):  # type: ignore[no-untyped-def]
    """Distance from (x, y) to the nearest edge of a triangle."""
    best = np.inf
    for k in range(3):
        j = (k + 1) % 3
        ex, ey = p[j, 0] - p[k, 0], p[j, 1] - p[k, 1]
        fx, fy = x - p[k, 0], y - p[k, 1]
        t = min(max((fx * ex + fy * ey) / max(ex * ex + ey * ey, 1e-300), 0.0), 1.0)
        best = min(best, (fx - t * ex) ** 2 + (fy - t * ey) ** 2)
    return np.sqrt(best)


@njit(cache=True)
def _distances(pieces, distance, reach):  # type: ignore[no-untyped-def]
    """Distance of each pixel centre to the nearest edge of any triangle, where within reach."""
    height, width = distance.shape
    for t in range(len(pieces)):
        p = pieces[t]
        x0, x1 = min(p[0, 0], p[1, 0], p[2, 0]), max(p[0, 0], p[1, 0], p[2, 0])
        y0, y1 = min(p[0, 1], p[1, 1], p[2, 1]), max(p[0, 1], p[1, 1], p[2, 1])
        low = max(0, int(max(y0 - reach, 0.0)) - 1)
        for r in range(low, min(height, int(min(y1 + reach, height)) + 2)):
            left = max(0, int(max(x0 - reach, 0.0)) - 1)
            for c in range(left, min(width, int(min(x1 + reach, width)) + 2)):
                d = _to_edges(p, c + 0.5, r + 0.5)
                if d <= reach and d < distance[r, c]:
                    distance[r, c] = d


def exact(
    scene: Scene, camera: Camera, technique: Technique, size: tuple[int, int]
) -> ExactPicture:
    """The picture of `size` (width, height) as `technique` defines it, without approximation."""
    plain = isinstance(technique, Standard)
    seen = fragments(scene, camera, size, 0.0 if plain else technique.width)
    alpha = np.ones_like(seen.depth)
    if not plain:
        alpha = _opacities(scene, camera, technique, seen)
    alpha[~np.isfinite(seen.depth)] = 0.0
    return _composed(scene, seen, alpha)


def _opacities(scene, camera, technique, seen):  # type: ignore[no-untyped-def]
    """(n, h, w) a_i: the product of the masks behind each fragment."""
    alpha = np.ones_like(seen.depth)
    centers = camera.depth(scene.centers)
    for s in np.nonzero(scene.targets)[0]:
        there = np.isfinite(seen.depth[s])
        place = np.where(there, seen.depth[s], centers[s])
        mask = np.where(np.isfinite(seen.distance[s]), opacity(seen.distance[s], technique), 1.0)
        alpha *= np.where(seen.depth < place, mask, 1.0)
    alpha[scene.impenetrable] = 1.0
    return alpha


def _composed(scene: Scene, seen: Fragments, alpha: NDArray[np.float64]) -> ExactPicture:
    """Sort each pixel from front to back (ties: the later object in front) and add up."""
    n = len(scene.objects)
    background = np.broadcast_to(np.array(scene.background), (*seen.near_edge.shape, 3))
    if n == 0:
        return ExactPicture(background.copy(), alpha, alpha.copy(), seen.near_edge)
    order = n - 1 - np.argsort(seen.depth[::-1], axis=0, kind="stable")
    front = np.take_along_axis(alpha, order, axis=0)
    through = np.cumprod(1 - front, axis=0)
    before = np.concatenate([np.ones_like(through[:1]), through[:-1]])
    weights, transmittance = np.empty_like(alpha), np.empty_like(alpha)
    np.put_along_axis(weights, order, front * before, axis=0)
    np.put_along_axis(transmittance, order, before, axis=0)
    transmittance[~np.isfinite(seen.depth)] = 1.0
    picture = np.einsum("nhw,nhwc->hwc", weights, seen.color) + through[-1][..., None] * background
    return ExactPicture(picture, weights, transmittance, seen.near_edge)
