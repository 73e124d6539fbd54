"""The right picture of a model, cast ray by ray from its description: nothing of the loader's.

A description is a list of faces: flat polygons of any shape, seen from both sides, each with one
colour, with one for each of three corners, or with a picture. Colours are those a viewer shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

DIRECTIONS = np.array(
    [[0.48, 0.36, 0.80], [-0.62, 0.31, 0.72], [0.55, -0.42, -0.72], [-0.37, 0.83, -0.42]]
)
RAYS = 41


@dataclass(frozen=True)
class Face:
    """corners (k, 3); color (3,) as shown, or (3, 3) of the corners of a triangle as light; or a
    `picture` (h, w, 3 or 4) of bytes, row 0 at v = 0, with `uv` (k, 2), times `tint` as light;
    `wrap` along u and v: 'repeat', 'clamp', 'mirror'; `cutoff` of alpha."""

    corners: object
    color: object = (0.7, 0.7, 0.7)
    picture: object = None
    uv: object = None
    tint: object = (1.0, 1.0, 1.0)
    wrap: tuple = ("repeat", "repeat")
    cutoff: float = 0.0


def light(shown):
    """Of colours as shown: sRGB's curve."""
    c = np.asarray(shown, float)
    return np.where(c > 0.04045, ((c + 0.055) / 1.055) ** 2.4, c / 12.92)


def shown(amount):
    """Of light, cut at 1."""
    c = np.minimum(np.asarray(amount, float), 1.0)
    return np.where(c > 0.0031308, 1.055 * np.maximum(c, 1e-9) ** (1 / 2.4) - 0.055, c * 12.92)


def standing(faces, size=1.5, up="y", turned=False):
    """Corners of faces as `load_model` promises to put them: y up, on the ground, so large."""
    loops = [np.asarray(f.corners, float) for f in faces]
    if up == "z":
        loops = [np.stack([p[:, 0], p[:, 2], -p[:, 1]], axis=1) for p in loops]
    if turned:
        loops = [p * [-1, 1, -1] for p in loops]
    every = np.concatenate(loops)
    low, high = every.min(axis=0), every.max(axis=0)
    base = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
    return [(p - base) * size / (high - low).max() for p in loops]


def rays(direction, about):
    """Origins (n, 3) and the direction (3,) of parallel rays over a square about the model.

    Their grid is shifted and stretched by odd amounts, so that none meets an edge.
    """
    d = direction / np.linalg.norm(direction)
    u = np.cross([0, 1, 0], d)
    u /= np.linalg.norm(u)
    v = np.cross(d, u)
    middle = (about.min(axis=0) + about.max(axis=0)) / 2
    half = 0.53 * np.linalg.norm(np.ptp(about, axis=0))
    s = (np.arange(RAYS) + 0.5137) / RAYS * 2 - 1
    a, b = (x.ravel() for x in np.meshgrid(s * 1.0071, s * 0.9913))
    start = middle + 10 * half * d
    return start + half * (a[:, None] * u + b[:, None] * v), -d


def cast(faces, loops, direction):
    """(n, 3) colours, NaN where a ray meets nothing."""
    origins, way = rays(direction, np.concatenate(loops))
    nearest = np.full(len(origins), np.inf)
    colors = np.full((len(origins), 3), np.nan)
    for face, p in zip(faces, loops, strict=True):
        normal = sum(np.cross(p[i - 1] - p[0], p[i] - p[0]) for i in range(len(p)))
        slope = normal @ way
        if abs(slope) < 1e-12:
            continue
        t = ((p[0] - origins) @ normal) / slope
        hits = origins + t[:, None] * way
        axis = np.argmax(np.abs(normal))
        flat = [i for i in range(3) if i != axis]
        ok = _inside(hits[:, flat], p[:, flat]) & (t < nearest)
        if not ok.any():
            continue
        rgb, solid = _color(face, p[:, flat], hits[ok][:, flat])
        where = np.flatnonzero(ok)[solid]
        nearest[where], colors[where] = t[where], rgb[solid]
    return colors


def _inside(points, loop):
    """By the even-odd rule."""
    inside = np.zeros(len(points), bool)
    for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True):
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            x = a[0] + (points[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        inside ^= crosses & (points[:, 0] < x)
    return inside


def _color(face, loop, points):
    """Colours as shown (n, 3), and whether there is anything (n,)."""
    solid = np.ones(len(points), bool)
    if face.picture is None:
        color = np.asarray(face.color, float)
        if color.ndim == 1:
            return np.tile(color, (len(points), 1)), solid
        return _affine(loop[:3], shown(color), points), solid
    uv = _affine(loop, np.asarray(face.uv, float), points)
    rgba = _looked_up(np.asarray(face.picture, float) / 255, uv, face.wrap)
    if rgba.shape[1] == 4:
        solid = rgba[:, 3] >= face.cutoff
    return shown(rgba[:, :3] * np.asarray(face.tint)), solid


def _affine(loop, values, points):
    """Values at points, of the affine map that has `values` at the corners."""
    system = np.column_stack([loop, np.ones(len(loop))])
    solved = np.linalg.lstsq(system, values, rcond=None)[0]
    return np.column_stack([points, np.ones(len(points))]) @ solved


def _looked_up(picture, uv, wrap):
    """Bilinear, in light, (n, 3 or 4)."""
    texels = picture.copy()
    texels[..., :3] = light(picture[..., :3])
    h, w = texels.shape[:2]
    out = 0
    x, y = uv[:, 0] * w - 0.5, uv[:, 1] * h - 0.5
    for dy in (0, 1):
        for dx in (0, 1):
            i, j = np.floor(y).astype(int) + dy, np.floor(x).astype(int) + dx
            weight = (1 - np.abs(y - i)) * (1 - np.abs(x - j))
            out = out + weight[:, None] * texels[_row(i, h, wrap[1]), _row(j, w, wrap[0])]
    return out


def _row(i, n, way):
    if way == "clamp":
        return i.clip(0, n - 1)
    if way == "mirror":
        return np.where((i // n) % 2 == 0, i % n, n - 1 - i % n)
    return i % n


def cast_mesh(mesh, direction):
    """What the renderer would show of a Mesh without light: the nearest triangle whose front is
    turned to the eye, colours straight between vertices. Written apart from the renderer."""
    origins, way = rays(direction, mesh.vertices)
    colors = np.full((len(origins), 3), np.nan)
    _nearest(mesh.vertices, mesh.colors, mesh.triangles, origins, way, colors)
    return colors


@njit(cache=True)
def _nearest(vertices, paints, triangles, origins, way, colors):
    first, across, down = origins[0], origins[1] - origins[0], origins[RAYS] - origins[0]
    best = np.full(len(origins), np.inf)
    low, high = np.empty(2), np.empty(2)
    for t in range(len(triangles)):
        a, b, c = vertices[triangles[t, 0]], vertices[triangles[t, 1]], vertices[triangles[t, 2]]
        normal = np.cross(b - a, c - a)
        slope = np.dot(normal, way)
        if slope >= 0:
            continue
        low[:], high[:] = np.inf, -np.inf
        for p in (a, b, c):
            for k, step in enumerate((across, down)):
                at = np.dot(p - first, step) / np.dot(step, step)
                low[k], high[k] = min(low[k], at), max(high[k], at)
        for i in range(max(int(np.ceil(low[1] - 1e-6)), 0), min(int(high[1] + 1e-6) + 1, RAYS)):
            for j in range(max(int(np.ceil(low[0] - 1e-6)), 0), min(int(high[0] + 1e-6) + 1, RAYS)):
                r = i * RAYS + j
                distance = np.dot(a - origins[r], normal) / slope
                hit = origins[r] + distance * way - a
                square = np.dot(normal, normal)
                v = np.dot(np.cross(hit, c - a), normal) / square
                w = np.dot(np.cross(b - a, hit), normal) / square
                if v < -1e-9 or w < -1e-9 or v + w > 1 + 1e-9 or distance >= best[r]:
                    continue
                best[r] = distance
                for k in range(3):
                    x, y = paints[triangles[t, 0], k], paints[triangles[t, 1], k]
                    z = paints[triangles[t, 2], k]
                    colors[r, k] = (1 - v - w) * x + v * y + w * z
