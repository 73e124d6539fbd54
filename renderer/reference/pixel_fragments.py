"""What each object shows at each pixel, before anything is blended: on the CPU, in float64."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.scene import lighting, projection
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene


@dataclass(frozen=True, eq=False)
class Fragments:
    """The front-most surface of each object at each pixel.

    depth (n, h, w): view depth, inf where there is none; color (n, h, w, 3) lit; surface
    (n, h, w): the triangle of the object's mesh; outlines: for each object its visible triangles
    (k, 3, 2) in pixels, cut at the near plane; near_edge (h, w): pixels whose centre lies within
    1/256 pixel of a projected edge, where float32 and float64 may disagree.
    """

    depth: NDArray[np.float64]
    color: NDArray[np.float64]
    surface: NDArray[np.int64]
    outlines: tuple[NDArray[np.float64], ...]
    near_edge: NDArray[np.bool_]


def fragments(scene: Scene, camera: Camera, size: tuple[int, int]) -> Fragments:
    """Rasterise every object."""
    width, height = size
    n = len(scene.objects)
    depth = np.full((n, height, width), np.inf)
    color = np.zeros((n, height, width, 3))
    surface = np.zeros((n, height, width), dtype=np.int64)
    near_edge = np.zeros((height, width), dtype=np.bool_)
    outlines = []
    for i, thing in enumerate(scene.objects):
        pieces, owners, _ = triangles(thing, camera, size)
        outlines.append(np.ascontiguousarray(pieces[:, :, :2]))
        if len(pieces):
            normals, points, colors = (np.zeros((height, width, 3)) for _ in range(3))
            _rasterise(pieces, owners, depth[i], normals, points, colors, surface[i], near_edge)
            color[i] = _lit(depth[i], normals, points, colors, camera)
    return Fragments(depth, color, surface, tuple(outlines), near_edge)


def _lit(depth: Floats, normals: Floats, points: Floats, colors: Floats, camera: Camera) -> Floats:
    """Colours of one object's surface; its normals and points are in camera coordinates."""
    there = np.isfinite(depth)
    lit = np.zeros_like(colors)
    turned = camera.rotation.T
    factor = lighting.shade(normals[there] @ turned, -points[there] @ turned)
    lit[there] = np.minimum(colors[there] * factor[:, None], 1.0)
    return lit


def triangles(
    thing: Object, camera: Camera, size: tuple[int, int], back: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_]]:
    """Triangles that face the eye, or with `back` all, between the near and far planes (k, 3, 12),
    the mesh triangle of each (k,), and whether it faces the eye (k,).

    A vertex is its pixel x, y and 1/depth, then normal, camera point and colour, each divided by
    the depth.
    """
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
    chosen = np.nonzero(front | back)[0]
    rows = np.concatenate([points, normals, colors], axis=1)[triangles[chosen]]
    rows, owners = _clipped(rows, chosen, camera.near, camera.far)
    depth = -rows[..., 2]
    flat = projection.to_pixels(rows[..., :3], camera, size)
    parts = [flat, 1 / depth[..., None]] + [
        rows[..., k : k + 3] / depth[..., None] for k in (3, 0, 6)
    ]
    return np.ascontiguousarray(np.concatenate(parts, axis=-1)), owners, front[owners]


def _clipped(
    rows: NDArray[np.float64], owners: NDArray[np.int64], near: float, far: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Triangles (k, 3, 9) cut at the near and far planes (Sutherland and Hodgman)."""
    for sign, limit in ((1.0, near), (-1.0, far)):
        above = sign * (-rows[..., 2] - limit)
        whole = (above >= 0).all(axis=1)
        cut = ~whole & (above >= 0).any(axis=1)
        pieces, names = [rows[whole]], [owners[whole]]
        for triangle, side, owner in zip(rows[cut], above[cut], owners[cut], strict=True):
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
            names.append(np.full(len(fan), owner))
        rows, owners = np.concatenate(pieces), np.concatenate(names)
    return rows, owners


@njit(cache=True)
def _rasterise(
    pieces: Floats,
    owners: Ints,
    depth: Floats,
    normals: Floats,
    points: Floats,
    colors: Floats,
    surface: Ints,
    near_edge: Bools,
) -> None:
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
                if to_edges(p, x, y) < 1.0 / 256.0:
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
                    surface[r, c] = owners[t]
                    for k in range(3):
                        m = z * (a * p[0, 3 + k] + b * p[1, 3 + k] + g * p[2, 3 + k])
                        normals[r, c, k] = m
                        m = z * (a * p[0, 6 + k] + b * p[1, 6 + k] + g * p[2, 6 + k])
                        points[r, c, k] = m
                        m = z * (a * p[0, 9 + k] + b * p[1, 9 + k] + g * p[2, 9 + k])
                        colors[r, c, k] = m


@njit(cache=True)
def to_edges(p: Floats, x: float, y: float) -> float:
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
def covered(outline: Floats, height: int, width: int) -> Bools:
    """(height, width) whether a pixel's centre lies in one of the (k, 3, 2) triangles."""
    found = np.zeros((height, width), np.bool_)
    for t in range(len(outline)):
        p = outline[t]
        y0, y1 = min(p[0, 1], p[1, 1], p[2, 1]), max(p[0, 1], p[1, 1], p[2, 1])
        x0, x1 = min(p[0, 0], p[1, 0], p[2, 0]), max(p[0, 0], p[1, 0], p[2, 0])
        for r in range(max(0, int(y0) - 1), min(height, int(min(y1, height)) + 2)):
            for c in range(max(0, int(x0) - 1), min(width, int(min(x1, width)) + 2)):
                x, y = c + 0.5, r + 0.5
                a = (p[1, 0] - x) * (p[2, 1] - y) - (p[1, 1] - y) * (p[2, 0] - x)
                b = (p[2, 0] - x) * (p[0, 1] - y) - (p[2, 1] - y) * (p[0, 0] - x)
                g = (p[0, 0] - x) * (p[1, 1] - y) - (p[0, 1] - y) * (p[1, 0] - x)
                if (a >= 0 and b >= 0 and g >= 0) or (a <= 0 and b <= 0 and g <= 0):
                    found[r, c] = True
    return found


@njit(cache=True)
def distances(outline: Floats, height: int, width: int, reach: float) -> Floats:
    """(height, width) distance of pixel centres to the nearest triangle's edge, inf if > reach."""
    distance = np.full((height, width), np.inf)
    for t in range(len(outline)):
        p = outline[t]
        x0, x1 = min(p[0, 0], p[1, 0], p[2, 0]), max(p[0, 0], p[1, 0], p[2, 0])
        y0, y1 = min(p[0, 1], p[1, 1], p[2, 1]), max(p[0, 1], p[1, 1], p[2, 1])
        low = max(0, int(max(y0 - reach, 0.0)) - 1)
        for r in range(low, min(height, int(min(y1 + reach, height)) + 2)):
            left = max(0, int(max(x0 - reach, 0.0)) - 1)
            for c in range(left, min(width, int(min(x1 + reach, width)) + 2)):
                d = to_edges(p, c + 0.5, r + 0.5)
                if d <= reach and d < distance[r, c]:
                    distance[r, c] = d
    return distance
