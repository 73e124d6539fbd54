"""Alpha masks as arrays: the gradient, and the geometry that the shaders turn into one.

A convex outline needs no picture of its own: see skirts.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import corners_cut
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
    around = width + 1.0
    if technique.mask in ("outline", "hull"):
        return extents + np.array([-around, -around, around, around])
    grow = np.full(len(extents), around)
    if technique.mask == "ring":
        cells = len(ring_opacities(technique, size)) + 1.5
        grow += cells * max(size) / technique.ring_size
    else:
        half = np.maximum(extents[:, 2:] - extents[:, :2], 0.0) / 2
        # A circle or ellipse about a box reaches no farther than its diagonal on all sides.
        grow += np.hypot(half[:, 0], half[:, 1])
    return extents + np.array([-1, -1, 1, 1]) * grow[:, None]


def reach_of_slants(
    slants: NDArray[np.float64], reached: NDArray[np.float64], technique: DynamicTransparency,
    width: float,
) -> NDArray[np.float64]:  # fmt: skip
    """(n, 4) the slants (Boxes) of what masks can cover at most: of those that follow an outline as
    far about an object's own (n, 4), of others those of what they reach (n, 4)."""
    if technique.mask not in ("outline", "hull"):
        return corners_cut(reached)
    around = (width + 1.0) * np.sqrt(2)
    return slants + np.array([-around, -around, around, around])


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
