"""An oracle in rational arithmetic: slow, simple, and without a line of the methods' code.

Coordinates are float64, so they are rationals; everything that decides is a `Fraction`. Floats
only decide what lies in the rounding band, where no order is demanded.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise
from types import SimpleNamespace

import numpy as np
import pytest

EPS = float(np.finfo(float).eps)


def exact(point):
    return tuple(Fraction(float(x)) for x in point)


def minus(p, q):
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def plane(corners):
    """Normal and offset through a polygon: exact for triangles, Newell's for the rest."""
    points = [exact(c) for c in corners]
    normal = (Fraction(0),) * 3
    for p, q in zip(points, points[1:] + points[:1], strict=True):
        normal = tuple(
            a + b
            for a, b in zip(normal, cross(minus(p, points[0]), minus(q, points[0])), strict=True)
        )
    return normal, dot(normal, points[0])


def vector_area(points):
    """Twice the area as a vector, of a loop of rational points."""
    total = (Fraction(0),) * 3
    for p, q in pairwise(points):
        total = tuple(
            a + b
            for a, b in zip(total, cross(minus(p, points[0]), minus(q, points[0])), strict=True)
        )
    return total


def inside(point, corners, normal):
    """Even-odd test of a point of the plane, in the projection where the polygon is widest."""
    axis = max(range(3), key=lambda k: abs(normal[k]))
    u, v = [k for k in range(3) if k != axis]
    odd = False
    for p, q in zip(corners, corners[1:] + corners[:1], strict=True):
        if (p[v] > point[v]) != (q[v] > point[v]):
            at = p[u] + (point[v] - p[v]) * (q[u] - p[u]) / (q[v] - p[v])
            odd ^= at > point[u]
    return odd


def border_distance(point, corners):
    """Float distance of a point from a polygon's border."""
    p = np.array(corners, float)
    q = np.roll(p, -1, axis=0)
    edge, x = q - p, np.array([float(c) for c in point])
    length = np.maximum((edge**2).sum(axis=1), 1e-300)
    t = np.clip(((x - p) * edge).sum(axis=1) / length, 0, 1)
    return float(np.linalg.norm(p + t[:, None] * edge - x, axis=1).min())


class Pieces:
    """Output polygons with the exact planes of the polygons they come from."""

    def __init__(self, polygons, prepared):
        drawn = prepared.drawable
        self.planes = [plane(polygons.corners(i)) for i in range(len(polygons))]
        self.source = [int(s) for s in drawn.source]
        self.float_corners = [drawn.polygons.corners(i) for i in range(len(drawn.polygons))]
        self.corners = [[exact(c) for c in corners] for corners in self.float_corners]
        self.middle = np.array([c.mean(axis=0) for c in self.float_corners]).reshape(-1, 3)
        self.radius = np.array(
            [
                np.linalg.norm(c - m, axis=1).max()
                for c, m in zip(self.float_corners, self.middle, strict=True)
            ]
        )

    def near(self, eye, direction, order, band):
        """The pieces whose sphere the ray's line comes near: a shortcut with room to spare."""
        away = self.middle - eye
        unit = direction / np.linalg.norm(direction)
        apart = np.linalg.norm(away - (away @ unit)[:, None] * unit, axis=1)
        close = apart <= 1.001 * self.radius + 1e3 * band
        return [piece for piece in order if close[piece]]

    def hits(self, eye, direction, order, band):
        """[(depth, piece)] in drawing order, and whether some hit is too near a border to tell."""
        found, unclear = [], False
        for piece in order:
            normal, offset = self.planes[self.source[piece]]
            slope = dot(normal, direction)
            if slope == 0:
                continue
            depth = (offset - dot(normal, eye)) / slope
            if depth <= 0:
                continue
            point = tuple(e + depth * d for e, d in zip(eye, direction, strict=True))
            near = border_distance(point, self.float_corners[piece]) <= band
            unclear |= near
            if not near and inside(point, self.corners[piece], normal):
                found.append((depth, piece, point))
        return found, unclear

    def close(self, first, second, band):
        """Whether two hits lie within the rounding band of each other's plane."""
        apart = np.array([float(a - b) for a, b in zip(first[2], second[2], strict=True)])
        for _, piece, _ in (first, second):
            normal = np.array([float(c) for c in self.planes[self.source[piece]][0]])
            if abs(apart @ normal) <= band * np.linalg.norm(normal):
                return True
        return False


def polygon_order(prepared, **camera):
    """Output polygons in drawing order, each once."""
    owners = prepared.drawable.owner[prepared.order(**camera)]
    _, first = np.unique(owners, return_index=True)
    return [int(p) for p in owners[np.sort(first)]]


def wrong_pairs(polygons, prepared, rng, eyes=4, rays=12, factor=64.0):
    """Pairs drawn in the wrong order, and rays that meet a polygon twice or not at all.

    Rays go from random eyes, in and around the scene, through random points of the polygons.
    """
    pieces = Pieces(polygons, prepared)
    low, high = polygons.vertices.min(axis=0), polygons.vertices.max(axis=0)
    size = float((high - low).max()) or 1.0
    band = factor * EPS * max(size, float(np.abs(polygons.vertices).max()))
    wrong = []
    for _ in range(eyes):
        eye = (low + high) / 2 + size * rng.uniform(-1.5, 1.5, 3)
        order = polygon_order(prepared, eye=eye)
        assert sorted(order) == list(range(len(prepared.drawable.polygons)))
        for _ in range(rays):
            corners = polygons.corners(int(rng.integers(len(polygons))))
            goal = rng.dirichlet(np.ones(len(corners))) @ corners
            if not (goal - eye).any():
                continue
            start, direction = exact(eye), exact(goal - eye)
            near = pieces.near(eye, goal - eye, order, band)
            hits, unclear = pieces.hits(start, direction, near, band)
            for first, second in combinations(hits, 2):
                if first[0] < second[0] and not pieces.close(first, second, band):
                    wrong.append((first[1], second[1]))
            if not unclear:
                seen = sorted(pieces.source[p] for _, p, _ in hits)
                if seen != sources_hit(polygons, pieces.planes, start, direction):
                    wrong.append(("lost or doubled", seen))
    return wrong


def sources_hit(polygons, planes, eye, direction):
    """Input polygons that a ray meets, sorted."""
    seen = []
    for i, (normal, offset) in enumerate(planes):
        slope = dot(normal, direction)
        if slope == 0 or (depth := (offset - dot(normal, eye)) / slope) <= 0:
            continue
        point = tuple(e + depth * d for e, d in zip(eye, direction, strict=True))
        if inside(point, [exact(c) for c in polygons.corners(i)], normal):
            seen.append(i)
    return seen


def area_errors(polygons, prepared):
    """(m,) area lost or gained by each input polygon, over what rounding its cuts may cost.

    The allowance is 16 eps max(1, |coordinate| / size) of size², size being the polygon's own.
    """
    drawn, errors = prepared.drawable, []
    for i in range(len(polygons)):
        corners = polygons.corners(i)
        mine = np.flatnonzero(drawn.source == i)
        total = (Fraction(0),) * 3
        for piece in mine:
            part = vector_area([exact(c) for c in drawn.polygons.corners(int(piece))])
            total = tuple(a + b for a, b in zip(total, part, strict=True))
        whole = vector_area([exact(c) for c in corners])
        lost = max(abs(float(a - b)) for a, b in zip(whole, total, strict=True))
        size = float(np.linalg.norm(corners - corners[0], axis=1).max())
        allowed = 16 * EPS * max(1.0, np.abs(corners).max() / max(size, 1e-300)) * size**2
        errors.append(lost / allowed if allowed else lost)
    return np.array(errors)


def uneven_cuts(fragments, triples):
    """Cuts whose pieces, with exact cut points, do not add up to their parent's exact area.

    `triples` (m, 3, 3) are three corners of each source plane. A piece's corner is its parent's,
    or the rational point where a parent's edge meets the plane: the nearest one, and the rounded
    corner must lie within the band of it.
    """
    used = int(fragments.used[1])
    uneven = []
    children = {}
    for f in range(used):
        if fragments.parent[f] >= 0:
            children.setdefault(int(fragments.parent[f]), []).append(f)
    for parent, pieces in children.items():
        loop = [exact(c) for c in corners_of(fragments, parent)]
        a, b, c = (exact(p) for p in triples[fragments.cutter[pieces[0]]])
        normal = cross(minus(b, a), minus(c, a))
        heights = [dot(normal, minus(p, a)) for p in loop]
        crossings = [
            tuple(x + h / (h - k) * (y - x) for x, y in zip(p, q, strict=True))
            for p, q, h, k in zip(
                loop, loop[1:] + loop[:1], heights, heights[1:] + heights[:1], strict=True
            )
            if h * k < 0
        ]
        total = (Fraction(0),) * 3
        for piece in pieces:
            corners = [restored(exact(p), loop, crossings) for p in corners_of(fragments, piece)]
            total = tuple(s + t for s, t in zip(total, vector_area(corners), strict=True))
        if total != vector_area(loop):
            uneven.append(parent)
    return uneven, len(children)


def corners_of(fragments, f):
    begin = fragments.start[f]
    return fragments.rows[begin : begin + fragments.count[f], :3]


def restored(point, loop, crossings):
    """The parent's corner, or the exact crossing that this rounded one stands for."""
    if point in loop:
        return point
    return min(crossings, key=lambda c: max(abs(a - b) for a, b in zip(c, point, strict=True)))


@pytest.fixture
def oracle():
    """The oracle's questions, by name."""
    return SimpleNamespace(
        wrong_pairs=wrong_pairs,
        area_errors=area_errors,
        uneven_cuts=uneven_cuts,
        polygon_order=polygon_order,
        plane=plane,
        exact=exact,
        dot=dot,
    )
