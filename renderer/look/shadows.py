"""Soft shadows on the floor, of all that stands or floats above it, as a map of the floor.

The space above the floor is cut into layers, thinner ones below. What a layer holds of things is
laid onto the floor and blurred, the more the higher it is: where a thing touches the floor its
shadow is sharp and dark, and it fades as the thing is lifted. A point of the floor keeps the
product of what all layers leave. The map follows from the scene alone: no technique changes it, so
that a thing which has turned transparent still shows where it stands.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.look.floor import facing_up, floors
from seethrough.renderer.scene.scene import Object, Scene

TEXELS = 512  # of the map's longer side
LAYERS = 6
REACH = 1 / 6  # of the floor's shorter side: how high above it things cast shadows
SPREAD = 0.45  # by how much a shadow's border widens for each unit of height
SHARPEST = 1.5  # texels
DARKEST = 0.75  # of what the lowest layer takes
KEPT = 4  # scenes whose maps are kept


@dataclass(frozen=True, eq=False)
class FloorMap:
    """light (h, w): what is left of a floor's colour, row by row along z, column by column along x;
    `corner` (x, z) is the map's, `size` (x, z) its sides."""

    light: NDArray[np.float32]
    corner: tuple[float, float]
    size: tuple[float, float]

    def at(self, x: Floats, z: Floats) -> Floats:
        """(k,) what is left at points of the floor: bilinear between the texels' middles."""
        high, wide = self.light.shape
        u = np.clip((x - self.corner[0]) / self.size[0] * wide - 0.5, 0, wide - 1)
        v = np.clip((z - self.corner[1]) / self.size[1] * high - 0.5, 0, high - 1)
        i, j = np.minimum(v.astype(int), high - 2), np.minimum(u.astype(int), wide - 2)
        s, t = v - i, u - j
        light = self.light.astype(float)
        top = (1 - t) * light[i, j] + t * light[i, j + 1]
        bottom = (1 - t) * light[i + 1, j] + t * light[i + 1, j + 1]
        found: Floats = (1 - s) * top + s * bottom
        return found


@lru_cache(maxsize=KEPT)
def floor_map(scene: Scene) -> FloorMap:
    """The map of a scene that has a floor, for its look's `ground_shadows`."""
    is_floor = floors(tuple(thing.kind for thing in scene.objects))
    corners = scene.corners[is_floor].reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    sides = (high - low)[::2]
    texel = sides.max() / TEXELS
    wide, deep = (max(int(np.ceil(side / texel)), 2) for side in sides)
    reach = scene.look.shadow_reach or REACH * float(sides.min())
    steps = 2.0 ** np.arange(LAYERS + 1) - 1
    bounds: Floats = np.asarray(reach * steps / steps[-1], np.float64)
    there = np.zeros((LAYERS, deep, wide))
    for thing in np.array(scene.objects, dtype=object)[~is_floor].tolist():
        _lay(thing, there, np.array([low[0], high[1], low[2]]), texel, bounds)
    return FloorMap(
        _light(there, bounds, texel, scene.look.ground_shadows).astype(np.float32),
        (float(low[0]), float(low[2])),
        (wide * texel, deep * texel),
    )


def _light(there: Floats, bounds: Floats, texel: float, strength: float) -> Floats:
    """(h, w) what the layers leave together."""
    from scipy.ndimage import uniform_filter

    left = np.ones(there.shape[1:])
    for layer, low, high in zip(there, bounds[:-1], bounds[1:], strict=True):
        middle = (low + high) / 2
        # Three boxes in a row are a bell of the same width to a few per cent.
        width = 2 * round(max(SHARPEST, SPREAD * middle / texel)) + 1
        blurred = layer
        for _ in range(3):
            blurred = uniform_filter(blurred, width, mode="constant")
        left *= 1 - DARKEST * (1 - middle / bounds[-1]) ** 2 * blurred
    return 1 - strength * (1 - left)


def _lay(thing: Object, there: Floats, origin: Floats, texel: float, bounds: Floats) -> None:
    """Mark where a thing is in each layer."""
    matrix = thing.transform
    points = thing.mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3] - origin
    if points[:, 1].min() >= bounds[-1]:
        return
    flat = points[:, ::2] / texel
    deep, wide = there.shape[1:]
    first = np.clip(np.floor(flat.min(axis=0)).astype(int), 0, [wide, deep])
    last = np.clip(np.ceil(flat.max(axis=0)).astype(int), 0, [wide, deep])
    if (last <= first).any():
        return
    window = there[:, first[1] : last[1], first[0] : last[0]]
    _mark(flat - first, points[:, 1], thing.mesh.triangles, window, bounds)


@njit(cache=True)
def _mark(
    flat: Floats, height: Floats, triangles: NDArray[np.int32], there: Floats, bounds: Floats
) -> None:
    """Put 1 into all layers between a thing's lowest and highest surface above each texel."""
    layers, deep, wide = there.shape
    low, high = np.full((deep, wide), np.inf), np.full((deep, wide), -np.inf)
    for v in range(len(flat)):  # what is thinner than a texel
        c, r = int(np.floor(flat[v, 0])), int(np.floor(flat[v, 1]))
        if 0 <= c < wide and 0 <= r < deep:
            low[r, c], high[r, c] = min(low[r, c], height[v]), max(high[r, c], height[v])
    for t in range(len(triangles)):
        i, j, k = triangles[t]
        ax, ay = flat[j, 0] - flat[i, 0], flat[j, 1] - flat[i, 1]
        bx, by = flat[k, 0] - flat[i, 0], flat[k, 1] - flat[i, 1]
        area = ax * by - ay * bx
        if area == 0.0:
            continue
        x0 = max(0, int(min(flat[i, 0], flat[j, 0], flat[k, 0])))
        x1 = min(wide, int(max(flat[i, 0], flat[j, 0], flat[k, 0])) + 1)
        y0 = max(0, int(min(flat[i, 1], flat[j, 1], flat[k, 1])))
        y1 = min(deep, int(max(flat[i, 1], flat[j, 1], flat[k, 1])) + 1)
        for r in range(y0, y1):
            for c in range(x0, x1):
                px, py = c + 0.5 - flat[i, 0], r + 0.5 - flat[i, 1]
                s, u = (px * by - py * bx) / area, (ax * py - ay * px) / area
                if s < 0 or u < 0 or s + u > 1:
                    continue
                h = height[i] + s * (height[j] - height[i]) + u * (height[k] - height[i])
                low[r, c], high[r, c] = min(low[r, c], h), max(high[r, c], h)
    for r in range(deep):
        for c in range(wide):
            for m in range(layers):
                if low[r, c] < bounds[m + 1] and high[r, c] >= bounds[m] and high[r, c] >= 0:
                    there[m, r, c] = 1.0


def shadowed(color: Floats, point: Floats, normal: Floats, scene: Scene) -> Floats:
    """(k, 3) lit colours of floors at (k, 3) points of the world, in the shadows of `scene`."""
    light = floor_map(scene).at(point[:, 0], point[:, 2])
    return np.where(facing_up(normal)[:, None], color * light[:, None], color)
