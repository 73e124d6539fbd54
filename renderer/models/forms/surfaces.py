"""Closed surfaces from curves: boxes, lathes, sweeps and lofts, all of them tubes of rings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import SHARP, Shape, shape


def tube(
    rings: ArrayLike,
    color: ArrayLike,
    sharp: float = SHARP,
    closed: bool = False,
    strips: bool = False,
) -> Shape:
    """The surface through rings (n, m, 3), with caps, or joined end to start where `closed`.

    A ring runs counter-clockwise seen from the end of the tube, the side the rings advance to.
    Neighbours that coincide are one vertex, so a ring may shrink to a point. Caps are fans about
    the ring's mean, about which end rings must be star-shaped; or `strips` from each vertex of a
    ring's first half to the opposite one of its second half, for thin curved ends.
    """
    rings = np.asarray(rings, float)
    n, m = rings.shape[:2]
    step = np.abs(rings - rings[:, np.arange(m) - 1])
    same = step[..., 0] + step[..., 1] + step[..., 2] < 1e-9
    triangles = _tube_faces(n, m, closed, strips)
    vertices = rings.reshape(-1, 3)
    if not (closed or strips):
        vertices = np.concatenate([vertices, rings[[0, -1]].mean(axis=1)])
    if not same.any():
        return shape(vertices, triangles, color, sharp)
    ids = np.append(_weld(np.arange(n * m).reshape(n, m), same), [n * m, n * m + 1])
    triangles = ids[triangles]
    x, y, z = triangles.T
    kept = (x != y) & (y != z) & (z != x)
    # A cap over a ring that shrank to a point is no surface, though its corners differ.
    caps = np.repeat([0, n - 1], m) if not (closed or strips) else np.zeros(0, int)
    kept[len(kept) - len(caps) :] &= ~same.all(axis=1)[caps]
    return _compact(vertices, triangles[kept], color, sharp)


@lru_cache(maxsize=256)
def _tube_faces(n: int, m: int, closed: bool, strips: bool) -> NDArray[np.int64]:
    """Triangles over n rings of m vertices, then the centres of the two caps."""
    ids = np.arange(n * m).reshape(n, m)
    right = np.roll(ids, -1, axis=1)
    if closed:
        a, b, c, d = ids, right, np.roll(right, -1, axis=0), np.roll(ids, -1, axis=0)
    else:
        a, b, c, d = ids[:-1], right[:-1], right[1:], ids[1:]
    sides = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    if closed:
        return sides
    if strips:
        i = np.arange(m // 2 - 1)
        cap = np.concatenate(
            [np.stack([i, m - 1 - i, i + 1], 1), np.stack([i + 1, m - 1 - i, m - 2 - i], 1)]
        )
        return np.concatenate([sides, cap, cap[:, ::-1] + (n - 1) * m])
    low, high = np.full(m, n * m), np.full(m, n * m + 1)
    bottom = np.stack([right[0], ids[0], low], axis=-1)
    top = np.stack([ids[-1], right[-1], high], axis=-1)
    return np.concatenate([sides, bottom, top])


def _weld(ids: NDArray[np.int64], same: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Ids in which each vertex that is the `same` as its predecessor takes the predecessor's."""
    m = ids.shape[1]
    source = np.maximum.accumulate(np.where(same, -1, np.arange(m)), axis=1)
    last = np.where(same.all(axis=1), 0, source[:, -1])
    source = np.where(source < 0, last[:, None], source)
    return np.take_along_axis(ids, source, axis=1)


def _compact(
    vertices: Floats, triangles: NDArray[np.int64], color: ArrayLike, sharp: float
) -> Shape:
    """A Shape without the vertices no triangle uses."""
    used = np.zeros(len(vertices), bool)
    used[triangles] = True
    if used.all():
        return shape(vertices, triangles, color, sharp)
    return shape(vertices[used], (np.cumsum(used) - 1)[triangles], color, sharp)


def curve(points: ArrayLike, n: int) -> Floats:
    """(n, d) points on the Catmull-Rom spline through (k, d) points, chord-length steps."""
    p = np.asarray(points, float)
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    slope = np.gradient(p, knots, axis=0)
    t = np.linspace(0, knots[-1], n)
    i = np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(p) - 2)
    h = (knots[i + 1] - knots[i])[:, None]
    s = (t - knots[i])[:, None] / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * p[i]
        + s * (1 - s) ** 2 * h * slope[i]
        + s**2 * (3 - 2 * s) * p[i + 1]
        + s**2 * (s - 1) * h * slope[i + 1]
    )


@lru_cache(maxsize=64)
def circle(n: int) -> Floats:
    """(n, 2) points of the unit circle, counter-clockwise."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def rounded(width: float, height: float, radius: float, steps: int = 3) -> Floats:
    """(4 (steps + 1), 2) a rectangle about the origin with round corners, counter-clockwise."""
    angle = np.linspace(0, np.pi / 2, steps + 1) + np.pi / 2 * np.arange(4)[:, None]
    corner = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * (
        width / 2 - radius,
        height / 2 - radius,
    )
    arc = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * radius
    return (arc + corner[:, None]).reshape(-1, 2)


def lathe(profile: ArrayLike, color: ArrayLike, sides: int = 24, sharp: float = SHARP) -> Shape:
    """A profile of (radius, height) pairs, from the bottom up, turned about the y axis."""
    p = np.asarray(profile, float)
    ring = circle(sides)[:, ::-1]  # counter-clockwise seen from above is x = sin, z = cos
    rings = np.empty((len(p), sides, 3))
    rings[..., [0, 2]] = p[:, :1, None] * ring
    rings[..., 1] = p[:, 1:]
    return tube(rings, color, sharp)


def ring(profile: ArrayLike, color: ArrayLike, sides: int = 32, sharp: float = SHARP) -> Shape:
    """A closed profile (k, 2) of (radius, height), counter-clockwise, turned about the y axis."""
    p = np.asarray(profile, float)
    angle = circle(sides)
    rings = np.empty((sides, len(p), 3))
    rings[..., 0] = angle[:, :1] * p[:, 0]
    rings[..., 2] = -angle[:, 1:] * p[:, 0]
    rings[..., 1] = p[:, 1]
    return tube(rings[:, ::-1], color, sharp, closed=True)


def disc(radius: float, height: float, color: ArrayLike, sides: int = 24, edge: float = 0) -> Shape:
    """A cylinder about the y axis, its middle at the origin, with an edge bevelled by `edge`."""
    h = height / 2
    if not edge:
        return lathe([(radius, -h), (radius, h)], color, sides)
    steps = [(radius - edge, h), (radius - edge * 0.3, h - edge * 0.3), (radius, h - edge)]
    return lathe([(r, -y) for r, y in steps] + steps[::-1], color, sides)


def ball(size: Sequence[float] | float, color: ArrayLike, sides: int = 16) -> Shape:
    """An ellipsoid about the origin with semi-axes `size`."""
    one = _unit_ball(sides)
    return shape(one.vertices * np.asarray(size), one.triangles, color, sharp=180)


@lru_cache(maxsize=32)
def _unit_ball(sides: int) -> Shape:
    angle = np.linspace(-np.pi / 2, np.pi / 2, sides // 2 + 1)
    radius = np.cos(angle)
    radius[[0, -1]] = 0
    return lathe(np.stack([radius, np.sin(angle)], axis=1), (0, 0, 0), sides)


def box(size: Sequence[float], color: ArrayLike, edge: float = 0.0, steps: int = 2) -> Shape:
    """A box about the origin, with edges rounded by the radius `edge`."""
    x, y, z = size
    if not edge:
        ring2 = np.array([[x, -z], [x, z], [-x, z], [-x, -z]])[::-1] / 2
        rings = np.empty((2, 4, 3))
        rings[..., [0, 2]] = ring2
        rings[..., 1] = np.array([[-y / 2], [y / 2]])
        return tube(rings, color, sharp=30)
    edge = min(edge, 0.499 * min(size))
    angle = np.linspace(0, np.pi / 2, steps + 1)
    radius = np.concatenate([np.cos(angle[::-1]), np.cos(angle)]) * edge
    radius[[0, -1]] = 0
    height = np.sin(np.concatenate([-angle[::-1], angle])) * edge
    height += np.repeat([-1, 1], steps + 1) * (y / 2 - edge)
    inner = rounded(x - 2 * edge, z - 2 * edge, 0.0, steps)
    arc = rounded(2.0, 2.0, 1.0, steps)
    rings = np.empty((2 * steps + 2, len(inner), 3))
    rings[..., [0, 2]] = (inner + radius[:, None, None] * arc)[:, ::-1]
    rings[..., 1] = height[:, None]
    return tube(rings, color)


def sweep(
    path: ArrayLike,
    radius: ArrayLike,
    color: ArrayLike,
    sides: int = 8,
    closed: bool = False,
    section: ArrayLike | None = None,
    sharp: float = SHARP,
) -> Shape:
    """A tube along a path (n, 3) that lies near a plane; `radius` may change along it.

    `section` (m, 2), counter-clockwise, replaces the unit circle: its first coordinate lies in the
    plane of the path, its second along the plane's normal.
    """
    p = np.asarray(path, float)
    if closed:
        tangent = np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0)
    else:
        tangent = np.gradient(p, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = _plane_normal(p)
    side = np.cross(normal, tangent)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    normal = np.cross(tangent, side)
    flat = circle(sides) if section is None else np.asarray(section, float)
    scale = np.broadcast_to(np.asarray(radius, float), len(p))[:, None, None]
    rings = p[:, None] + scale * (flat[:, :1] * side[:, None] + flat[:, 1:] * normal[:, None])
    return tube(rings, color, sharp, closed)


def _plane_normal(path: Floats) -> Floats:
    """(3,) unit normal of the plane nearest to a path; across y where the path is straight."""
    centred = path - path.mean(axis=0)
    _, spread, axes = np.linalg.svd(centred, full_matrices=False)
    if len(path) > 2 and spread[1] > 1e-6 * spread[0]:
        return axes[2]
    along = axes[0]
    helper = (0.0, 0.0, 1.0) if abs(along[1]) > 0.9 else (0.0, 1.0, 0.0)
    across = np.cross(along, helper)
    return across / np.linalg.norm(across)


def rod(a: ArrayLike, b: ArrayLike, radius: float, color: ArrayLike, sides: int = 8) -> Shape:
    """A straight round bar from a to b."""
    start, along = np.asarray(a, float), np.subtract(b, a)
    x, y, z = along
    across = np.array([-y, x, 0.0] if abs(z) < 0.9 * np.sqrt(along @ along) else [0.0, -z, y])
    across *= radius / np.sqrt(across @ across)
    third = np.cross(along, across) / np.sqrt(along @ along)
    flat = circle(sides)
    ring = start + flat[:, :1] * across + flat[:, 1:] * third
    return tube(np.stack([ring, ring + along]), color)


def slab(
    outline: ArrayLike, thickness: float, color: ArrayLike, edge: float = 0.0, sharp: float = 40
) -> Shape:
    """An outline (m, 2) in x and y, counter-clockwise, star-shaped about its mean, drawn out along
    z about the origin; its edges bevelled by `edge`."""
    flat = np.asarray(outline, float)
    levels = [(0.0, -thickness / 2), (0.0, thickness / 2)]
    if edge:
        levels = [
            (edge, -thickness / 2),
            (0.0, edge - thickness / 2),
            (0.0, thickness / 2 - edge),
            (edge, thickness / 2),
        ]
    inward = _inward(flat)
    rings = [np.column_stack([flat + e * inward, np.full(len(flat), z)]) for e, z in levels]
    return tube(rings, color, sharp)


def _inward(outline: Floats) -> Floats:
    """(m, 2) steps that shrink a counter-clockwise outline by one unit at every corner."""
    out = np.roll(outline, -1, axis=0) - outline
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    left = np.stack([-out[:, 1], out[:, 0]], axis=1)
    before = np.roll(left, 1, axis=0)
    return (left + before) / np.maximum(1 + (left * before).sum(axis=1, keepdims=True), 0.3)


def pillow(
    size: Sequence[float], color: ArrayLike, roundness: float = 0.35, sides: int = 24
) -> Shape:
    """A superellipsoid of the given full size: a box at roundness 0, an ellipsoid at 1."""
    soft = ball(1.0, color, sides)
    ring, height = soft.vertices[:, [0, 2]], soft.vertices[:, 1]
    cos = np.linalg.norm(ring, axis=1)
    unit = ring / np.maximum(cos, 1e-12)[:, None]
    flat = np.sign(unit) * np.abs(unit) ** roundness * (cos**roundness * (cos > 1e-9))[:, None]
    moved = np.empty_like(soft.vertices)
    moved[:, [0, 2]] = flat
    moved[:, 1] = np.sign(height) * np.abs(height) ** roundness
    return soft.bent(lambda _: moved * (np.asarray(size) / 2))


def copies(one: Shape, places: ArrayLike) -> Shape:
    """The shape once at each of the places (k, 3)."""
    at = np.asarray(places, float)
    return _repeated(one, one.vertices + at[:, None])


def spun(one: Shape, count: int) -> Shape:
    """The shape `count` times round the x axis, evenly."""
    c, s = circle(count).T[..., None]
    x, y, z = one.vertices.T
    turned = np.stack([np.broadcast_to(x, (count, len(x))), c * y - s * z, s * y + c * z], axis=-1)
    return _repeated(one, turned)


def boxes(sizes: ArrayLike, centers: ArrayLike, colors: ArrayLike, edge: float) -> Shape:
    """Boxes (k, 3) of colours (k, 3), their edges bevelled by `edge`."""
    one = box((1, 1, 1), (0, 0, 0), edge, 1)
    side = np.sign(one.vertices.round(9))
    grown = side * (np.asarray(sizes, float)[:, None] - 1) / 2
    many = _repeated(one, one.vertices + grown + np.asarray(centers, float)[:, None])
    rgb = np.repeat(np.asarray(colors, float), len(one.triangles), axis=0)
    return replace(many, colors=np.broadcast_to(rgb[:, None], many.colors.shape))


def _repeated(one: Shape, vertices: Floats) -> Shape:
    """The shape's triangles over each of k sets of its vertices (k, n, 3)."""
    k, n = vertices.shape[:2]
    return Shape(
        vertices.reshape(-1, 3),
        (one.triangles + n * np.arange(k)[:, None, None]).reshape(-1, 3),
        np.tile(one.colors, (k, 1, 1)),
        np.tile(one.crease, k),
    )
