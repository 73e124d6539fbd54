"""Alpha masks as arrays: the gradient, and the geometry that the shaders turn into one.

A convex outline needs no picture of its own: its hull is drawn with the opacity over the target,
and a skirt round it (a quad for each edge, a fan for each corner) carries the offset from the
outline, whose length is the Euclidean distance. Each pixel is covered once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Floats32, Ints
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object

if TYPE_CHECKING:
    from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency


def opacity(distance: NDArray[np.float64], technique: DynamicTransparency) -> NDArray[np.float64]:
    """Mask (…) at `distance` pixels from the outline, 0 on the target itself (Elmqvist2009 §V-D,
    Fig. 3)."""
    t, e = technique.alpha_target, technique.alpha_edge
    if technique.width == 0:
        return np.where(distance <= 0, t, 1.0)
    gradient = e + (1 - e) * np.minimum(distance / technique.width, 1.0)
    return np.where(distance <= 0, t, gradient)


def ring_opacities(technique: DynamicTransparency, size: tuple[int, int]) -> NDArray[np.float64]:
    """(k,) opacity of each ring of cells, from the target outwards (Elmqvist2009 §V-D, algorithm
    2).

    As many rings as cells fit into the width of the mask, at least one if it has a width.
    """
    if technique.width == 0:
        return np.zeros(0)
    count = max(1, round(technique.width * technique.ring_size / max(size)))
    e = technique.alpha_edge
    return e + (1 - e) * np.arange(count) / count


def light(size: tuple[int, int], technique: DynamicTransparency) -> NDArray[np.float64]:
    """(h, w) how far masks work at a pixel: 1 everywhere, or the searchlight of active mode."""
    width, height = size
    if technique.mode == "passive":
        return np.ones((height, width))
    if technique.pointer is None:
        return np.zeros((height, width))
    x = (np.arange(width) + 0.5) / height - technique.pointer[0]
    y = (np.arange(height) + 0.5) / height - technique.pointer[1]
    distance = np.hypot(x[None], y[:, None])
    if technique.softness == 0:
        return (distance <= technique.radius).astype(float)
    return np.clip(1 - (distance - technique.radius) / technique.softness, 0, 1)


def cap(count: NDArray[np.int64], technique: DynamicTransparency) -> NDArray[np.float64]:
    """The highest opacity of each of `count` layers that together let τ through; 1 for none."""
    tau, k = technique.min_transmittance, np.maximum(count, 1)
    share = (1 - tau) / k if technique.model == "additive" else 1 - tau ** (1 / k)
    return np.where(count > 0, share, 1.0)


def long_axis(thing: Object, camera: Camera) -> NDArray[np.float64]:
    """(2,) unit direction on the screen (y down) of the longest side of an object's box."""
    low, high = thing.mesh.bounds
    sides = (thing.transform[:3, :3] * (high - low)).T @ camera.rotation
    center = thing.transform[:3, :3] @ thing.mesh.center + thing.transform[:3, 3] - camera.eye
    x, y, z = center @ camera.rotation
    depth = max(-z, camera.near)
    # How the projection of the centre moves along each side.
    flat = np.stack(
        [sides[:, 0] + x * sides[:, 2] / depth, sides[:, 1] + y * sides[:, 2] / depth], 1
    )
    longest = flat[np.argmax(np.hypot(*flat.T))] * [1, -1]
    length = np.hypot(*longest)
    return longest / length if length > 0 else np.array([1.0, 0.0])


def bounding_ellipse(
    points: NDArray[np.float64], shape: str, along: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(6,) centre x, y, unit axis x, y and semi-axes of a circle or ellipse about (v, 2) pixels.

    "circle" is about the middle of the points' box; "ellipse" goes through the corners of the
    upright box, "oriented-ellipse" through those of the box turned so that a side runs `along`.
    """
    axis = along if shape == "oriented-ellipse" else np.array([1.0, 0.0])
    frame = np.array([axis, [-axis[1], axis[0]]])
    turned = points @ frame.T
    low, high = turned.min(axis=0), turned.max(axis=0)
    middle = ((low + high) / 2) @ frame
    semi = np.maximum((high - low) / 2 * np.sqrt(2), 0.5)
    if shape == "circle":
        semi[:] = max(np.hypot(*(points - middle).T).max(), 0.5)
    return np.array([*middle, *axis, *semi])


def ellipse_distance(ellipse: NDArray[np.float64], size: tuple[int, int]) -> NDArray[np.float64]:
    """(h, w) pixels from the ellipse along the ray from its centre, 0 inside (our definition: it
    is the Euclidean distance for a circle, and needs no iteration for the others)."""
    width, height = size
    x = (np.arange(width) + 0.5 - ellipse[0])[None]
    y = (np.arange(height) + 0.5 - ellipse[1])[:, None]
    p = x * ellipse[2] + y * ellipse[3]
    q = y * ellipse[2] - x * ellipse[3]
    r = np.hypot(p / ellipse[4], q / ellipse[5])
    return np.where(r > 1, np.hypot(p, q) * (1 - 1 / np.maximum(r, 1)), 0.0)


def reach(
    extents: NDArray[np.float64],
    technique: DynamicTransparency,
    width: float,
    size: tuple[int, int],
) -> NDArray[np.float64]:
    """(n, 4) what the masks of objects with these (n, 4) extents can cover, at most."""
    # What lies behind the eye has an empty box, from inf to -inf: it stays one.
    half = np.maximum(extents[:, 2:] - extents[:, :2], 0.0) / 2
    grow = np.full(len(extents), width + 1.0)
    if technique.mask == "ring":
        cells = len(ring_opacities(technique, size)) + 1.5
        grow += cells * max(size) / technique.ring_size
    elif technique.mask not in ("outline", "hull"):
        # A circle or ellipse about a box reaches no farther than its diagonal on all sides.
        grow += np.hypot(half[:, 0], half[:, 1])
    return extents + np.array([-1, -1, 1, 1]) * grow[:, None]


def hulls_with_skirts(
    pixels: NDArray[np.float64], starts: NDArray[np.int64], width: float
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Triangles for convex outlines: vertices (k, 5) and the first vertex of each (n + 1,).

    `pixels` (v, 2) are the projected vertices of n targets, `starts` (n + 1,) where each begins.
    A vertex is x, y in pixels, then its offset from the outline x, y, then −1 (drawn as a skirt).
    """
    if len(starts) == 1:
        return np.zeros((0, 5), np.float32), np.zeros(1, np.int64)
    return _hulls_with_skirts(np.ascontiguousarray(pixels), starts, float(width))


@njit(cache=True)
def convex_hull(points: Floats) -> Floats:
    """(h, 2) corners of the hull of (v, 2) points, turning one way round (monotone chain)."""
    order = np.argsort(points[:, 0], kind="mergesort")
    n = len(points)
    # Equal x: by y, so that the chain is well defined.
    for a in range(1, n):
        b = a
        while b > 0 and (
            points[order[b], 0] == points[order[b - 1], 0]
            and points[order[b], 1] < points[order[b - 1], 1]
        ):
            order[b], order[b - 1] = order[b - 1], order[b]
            b -= 1
    chain = np.empty(2 * n + 1, np.int64)
    k = 0
    for turn in range(2):
        base = k + 1 if turn == 0 else k
        first = 0 if turn == 0 else n - 2
        step = 1 if turn == 0 else -1
        i = first
        while 0 <= i < n:
            p = points[order[i]]
            while k >= base + 1:
                u, v = points[chain[k - 2]], points[chain[k - 1]]
                if (v[0] - u[0]) * (p[1] - u[1]) - (v[1] - u[1]) * (p[0] - u[0]) > 0:
                    break
                k -= 1
            chain[k] = order[i]
            k += 1
            i += step
    k = max(k - 1, 1)  # the last point is the first again
    hull = np.empty((k, 2))
    for a in range(k):
        hull[a] = points[chain[a]]
    return hull


@njit(cache=True)
def _put(out: Floats32, k: int, x: float, y: float, ox: float, oy: float) -> int:
    out[k, 0], out[k, 1], out[k, 2], out[k, 3], out[k, 4] = x, y, ox, oy, -1.0
    return k + 1


_BLUNT = 1.0  # radians: the corner of two triangles lies an eighth of the width too far out


@njit(cache=True)
def _fan(out: Floats32, k: int, corner: Floats, a: Floats, b: Floats, width: float) -> int:
    """Two or three triangles round a corner from unit normal a to b, outside the circle of
    `width`, by little."""
    turn = np.arctan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    half = turn / 2 if turn < _BLUNT else turn / 4
    c, s, r = np.cos(half), np.sin(half), width / np.cos(half)
    rim = np.empty((4, 2))
    rim[0], rim[2], rim[3] = a * width, b * width, b * width
    rim[1, 0], rim[1, 1] = r * (c * a[0] - s * a[1]), r * (s * a[0] + c * a[1])
    if turn >= _BLUNT:
        rim[2, 0], rim[2, 1] = r * (c * b[0] + s * b[1]), r * (c * b[1] - s * b[0])
    for t in range(2 if turn < _BLUNT else 3):
        k = _put(out, k, corner[0], corner[1], 0.0, 0.0)
        for o in (rim[t], rim[t + 1]):
            k = _put(out, k, corner[0] + o[0], corner[1] + o[1], o[0], o[1])
    return k


@njit(cache=True)
def _hull_with_skirt(hull: Floats, width: float, out: Floats32, k: int) -> int:
    n = len(hull)
    normals = np.empty((n, 2))
    for a in range(n):
        edge = hull[(a + 1) % n] - hull[a]
        length = np.hypot(edge[0], edge[1])
        normals[a, 0], normals[a, 1] = edge[1] / length, -edge[0] / length
    for a in range(1, n - 1):
        for p in (hull[0], hull[a], hull[a + 1]):
            k = _put(out, k, p[0], p[1], 0.0, 0.0)
    if width == 0:
        return k
    for a in range(n):
        p, q, o = hull[a], hull[(a + 1) % n], normals[a] * width
        for t in ((p, 0), (q, 0), (q, 1), (p, 0), (q, 1), (p, 1)):
            x, y = t[0][0] + t[1] * o[0], t[0][1] + t[1] * o[1]
            k = _put(out, k, x, y, t[1] * o[0], t[1] * o[1])
        k = _fan(out, k, q, normals[a], normals[(a + 1) % n], width)
    return k


@njit(cache=True)
def _hulls_with_skirts(pixels: Floats, starts: Ints, width: float) -> tuple[Floats32, Ints]:
    n = len(starts) - 1
    out = np.empty((18 * len(pixels) + 72 * n, 5), np.float32)
    firsts = np.zeros(n + 1, np.int64)
    k = 0
    for a in range(n):
        hull = convex_hull(pixels[starts[a] : starts[a + 1]])
        if len(hull) < 3:  # seen edge-on, or smaller than the arithmetic: give it a tiny area
            low, high = hull[0] - 1e-4, hull[0] + 1e-4
            for p in hull:
                low, high = np.minimum(low, p - 1e-4), np.maximum(high, p + 1e-4)
            hull = np.empty((4, 2))
            hull[0, 0], hull[0, 1], hull[1, 0], hull[1, 1] = low[0], low[1], high[0], low[1]
            hull[2, 0], hull[2, 1], hull[3, 0], hull[3, 1] = high[0], high[1], low[0], high[1]
        k = _hull_with_skirt(hull, width, out, k)
        firsts[a + 1] = k
    return out[:k], firsts
