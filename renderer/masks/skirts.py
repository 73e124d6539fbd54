"""The mask of a convex outline as triangles: its hull, and round it a skirt.

Two triangles for each edge reach out to where the masks of the next edges begin, halfway round the
corners: there the edge, with its ends, is what is nearest. They carry where a pixel lies along the
edge and off it, so that a shader finds the Euclidean distance. Each pixel is covered once; few
triangles matter, for on a software rasteriser a thin one costs as much as the pixels about it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints
from seethrough.renderer.masks.masks import convex_hull

# Cosine of the turn at a corner beyond which it is cut off: else it reaches out to two widths.
_SHARP = -0.5


def hulls_with_skirts(pixels: Floats, starts: Ints, width: float) -> tuple[Floats32, Ints]:
    """Triangles for convex outlines: vertices (k, 7) and the first vertex of each (n + 1,).

    `pixels` (v, 2) are the projected vertices of n targets, `starts` (n + 1,) where each begins.
    A vertex is x, y in pixels; where it lies along an edge and off it, in pixels; −1; how long the
    edge is; and 0. On the hull all but the −1 are 0.
    """
    if len(starts) == 1:
        return np.zeros((0, 7), np.float32), np.zeros(1, np.int64)
    return _hulls_with_skirts(np.ascontiguousarray(pixels), starts, float(width))


@njit(cache=True)
def _hulls_with_skirts(pixels: Floats, starts: Ints, width: float) -> tuple[Floats32, Ints]:
    n = len(starts) - 1
    hulls, ends, most = np.empty((len(pixels) + 4 * n, 2)), np.zeros(n + 1, np.int64), 0
    for a in range(n):
        hull = convex_hull(pixels[starts[a] : starts[a + 1]])
        if len(hull) < 3:  # seen edge-on, or smaller than the arithmetic: give it a tiny area
            low, high = hull[0] - 1e-4, hull[0] + 1e-4
            for p in hull:
                low, high = np.minimum(low, p - 1e-4), np.maximum(high, p + 1e-4)
            hull = np.empty((4, 2))
            hull[0, 0], hull[0, 1], hull[1, 0], hull[1, 1] = low[0], low[1], high[0], low[1]
            hull[2, 0], hull[2, 1], hull[3, 0], hull[3, 1] = high[0], high[1], low[0], high[1]
        ends[a + 1] = ends[a] + len(hull)
        hulls[ends[a] : ends[a + 1]] = hull
        most += 3 * (len(hull) - 2) + 12 * len(hull)
    out, firsts, k = np.zeros((most, 7), np.float32), np.zeros(n + 1, np.int64), 0
    for a in range(n):
        k = _hull_with_skirt(hulls[ends[a] : ends[a + 1]], width, out, k)
        firsts[a + 1] = k
    return out[:k], firsts


@njit(cache=True)
def _hull_with_skirt(hull: Floats, width: float, out: Floats32, k: int) -> int:
    n = len(hull)
    for a in range(1, n - 1):
        for c in (0, a, a + 1):
            out[k, 0], out[k, 1], out[k, 2], out[k, 3] = hull[c, 0], hull[c, 1], 0.0, 0.0
            out[k, 4], out[k, 5] = -1.0, 0.0
            k += 1
    if width == 0:
        return k
    edges = np.empty((n, 3))  # along, unit; how long
    for a in range(n):
        x, y = hull[(a + 1) % n, 0] - hull[a, 0], hull[(a + 1) % n, 1] - hull[a, 1]
        length = np.hypot(x, y)
        edges[a, 0], edges[a, 1], edges[a, 2] = x / length, y / length, length
    corners = np.empty((n, 7))
    for a in range(n):
        _corner(hull[a], edges[a - 1], edges[a], width, corners[a])
    for a in range(n):
        here, there = corners[a], corners[(a + 1) % n]
        p, q, edge = hull[a], hull[(a + 1) % n], edges[a]
        own, other = (here[4], here[5]), (there[0], there[1])
        k = _triangle(out, k, p, edge, (p[0], p[1]), (q[0], q[1]), other)
        k = _triangle(out, k, p, edge, (p[0], p[1]), other, own)
        if here[6]:
            k = _triangle(out, k, p, edge, (p[0], p[1]), own, (here[2], here[3]))
        if there[6]:
            k = _triangle(out, k, p, edge, (q[0], q[1]), (there[2], there[3]), other)
    return k


@njit(cache=True)
def _corner(corner: Floats, before: Floats, after: Floats, width: float, out: Floats) -> None:
    """Where the skirt of the edge `before` ends at a corner, the tip between the two skirts, and
    where that of the edge `after` begins (x, y each), and whether that is no single point."""
    ax, ay, bx, by = before[1], -before[0], after[1], -after[0]  # normals
    cosine = ax * bx + ay * by
    x, y = corner
    if cosine >= _SHARP:
        s = width / (1 + cosine)
        for i in range(0, 6, 2):
            out[i], out[i + 1] = x + s * (ax + bx), y + s * (ay + by)
        out[6] = 0.0
        return
    # Halfway between the normals; there are edges seen from both sides, whose normals are opposite.
    mx, my = before[0] - after[0], before[1] - after[1]
    length = np.hypot(mx, my)
    mx, my = mx / length, my / length
    s = width / (1 + ax * mx + ay * my)
    out[0], out[1] = x + s * (ax + mx), y + s * (ay + my)
    out[2], out[3] = x + width * mx, y + width * my
    s = width / (1 + bx * mx + by * my)
    out[4], out[5] = x + s * (bx + mx), y + s * (by + my)
    out[6] = 1.0


@njit(cache=True)
def _triangle(
    out: Floats32,
    k: int,
    origin: Floats,
    edge: Floats,
    a: tuple[float, float],
    b: tuple[float, float],
    c: tuple[float, float],
) -> int:
    """Three vertices of the skirt of an edge that begins at `origin`."""
    for point in (a, b, c):
        x, y = point[0] - origin[0], point[1] - origin[1]
        out[k, 0], out[k, 1] = point
        out[k, 2], out[k, 3] = x * edge[0] + y * edge[1], x * edge[1] - y * edge[0]
        out[k, 4], out[k, 5] = -1.0, edge[2]
        k += 1
    return k
