"""What reaches to both sides of a mask's border, and over how many pixels of it.

Beside its target a mask lies at the depth of the target's centre (Elmqvist2009 §V-D, as sorted
pixels have it). Something that reaches from before that depth to behind it should be seen through
where it is nearer and stand where it is farther; put in order, it comes before the border as a
whole, or after it. As the eye moves the order turns round, and all of these pixels jump at once.
So where they are more than a FEW, close to where that happens, the border is told from it by depth
(gpu/levels/straddling_painter.py); where they are not, no more than that can jump. The same goes
for what is wholly on one side and has its order from a plane that says otherwise.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT, compare, turning
from seethrough.renderer.plan.order import Placed
from seethrough.renderer.plan.separation import away
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import Boxes
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

FEW = 12  # pixels that may be on the wrong side of a border
MANY = 24  # of so many all are told; of fewer by how many they are, for that must not jump either
# Farther from where the order turns round than that part of a target's depth, or in depth of the
# two's radii, it will not turn round within a few steps.
CLOSE, DEEP = 0.03, 0.05
SEEN = 40 / 255  # of a pixel's colour: what is seen to jump
APART = 1.1  # of two spheres, what allows for perspective
WAYS = 16  # corners of an outline: in each of so many ways what lies farthest
ROWS = 12  # of pixels that are looked at, at most
NONE: Ints = np.zeros((0, 3), np.int64)


_TURNS = 2 * np.pi * np.arange(WAYS) / WAYS
_X, _Y = np.cos(_TURNS), np.sin(_TURNS)


class Straddling(NamedTuple):
    """`pairs` (k, 2) of an object and a target whose border it straddles; over how many pixels it
    is `nearer` and `farther` (k,), as their hulls have it; and how `close` the eye is to where
    their order turns round (k,), from 0 to 1."""

    pairs: Ints
    nearer: Floats
    farther: Floats
    close: Floats


def found(
    scene: Scene, camera: Camera, placed: Placed, near_by: Ints, boxes: Boxes,
    technique: DynamicTransparency, width: float, size: tuple[int, int],
) -> Straddling:  # fmt: skip
    """All that may be drawn on the wrong side of a border `width` pixels wide, over more than a FEW
    pixels. `near_by` (k, 2) are order.near_each_other.

    Only as much of the border counts as may change a pixel by what is SEEN. What the near plane
    cuts is left out. Of what is not convex, cavities count as filled, and a target's as border.
    """
    steep = 1 - technique.alpha_edge
    width *= max(0.0, 1 - SEEN / steep) if steep > 0 else 0.0
    if not width:
        return NO_ONE
    lens = np.array([camera.lens(size[1]), size[0] / 2, size[1] / 2, width, *size, CLOSE, DEEP])
    known, view = scene.separations, (camera.eye, camera.rotation, lens)
    while True:
        planes = (known.tried, known.pairs, known.planes)
        pairs, counts, new = _found(
            placed, near_by, boxes.crosses, scene.convex, planes, scene.hulls, view
        )
        if not len(new):
            break
        known.learn(new, scene)
    return Straddling(pairs, counts[:, 0], counts[:, 1], counts[:, 2])


NO_ONE = Straddling(np.zeros((0, 2), np.int64), *np.zeros((3, 0)))


def shown(these: Straddling, blend: Bools, mask: Bools) -> tuple[Bools, Bools]:
    """(n,) what blends and what has a mask, with what is nearer than more than a FEW pixels of a
    border, and the target: else that would not be drawn where nothing lies before the target."""
    if not len(these.pairs):
        return blend, mask
    much = these.nearer > FEW
    blend, mask = blend.copy(), mask.copy()
    blend[these.pairs[much, 0]] = mask[these.pairs[much, 1]] = True
    return blend, mask


def kept(these: Straddling, of_object: Ints, of_mask: Ints, apart: Bools) -> tuple[Ints, Floats]:
    """(k, 3) object, target and whether the object comes after the target's mask, of those where
    more than a FEW pixels are on the wrong side then, and how strongly (k,) they are to be told,
    up to 1; `of_object` and `of_mask` (n,) as levels.levels says. Nothing that is drawn `apart`
    (n,)."""
    if not len(these.pairs):
        return NONE, np.zeros(0)
    things, targets = these.pairs.T
    after = of_object[things] > of_mask[targets]
    wrong = np.where(after, these.farther, these.nearer)
    there = (of_object[things] >= 0) & (of_mask[targets] > -2) & ~apart[things]
    rows = np.stack([things, targets, after], axis=1)
    strength = np.minimum((wrong - FEW) / (MANY - FEW), 1.0) * these.close
    there &= strength > 0
    return rows[there], strength[there]


@njit(cache=True)
def _found(
    placed: Placed, close: Ints, crosses: Bools, convex: Bools,
    planes: tuple[Bools, Ints, Floats],
    hulls: tuple[Floats, Ints, Ints], view: tuple[Floats, Floats, Floats],
) -> tuple[Ints, Floats, Ints]:  # fmt: skip
    """(k, 2) objects and targets, and (k, 3) over how many pixels the object is nearer and farther
    than the target's border, and how close the eye is to where they turn round; or none, and the
    pairs between which a plane has to be looked for first. `planes` are what Separations knows
    (tried, pairs, planes), `hulls` as Scene has them; the `view` is the eye, the rotation, and a
    lens: pixels for a slope of 1, the middle of the picture, the width of borders, its size, CLOSE
    and DEEP."""
    (tried, separate, sides), (points, edges, starts) = planes, hulls
    eye, rotation, lens = view
    order, near, far = placed.seen, placed.near, placed.far
    pairs, depths, k = np.empty((2 * len(close), 2), np.int64), np.empty((2 * len(close), 2)), 0
    untried, new = np.empty((2 * len(close), 2), np.int64), 0
    for c in range(len(close)):
        for side in range(2):
            i, s = order[close[c, side]], order[close[c, 1 - side]]
            if not placed.targets[s] or crosses[s] or crosses[i] or placed.hard[i]:
                continue
            if near[i] < far[s] and far[i] > near[s] and _meet(placed, i, s, lens):
                depth = 0.0
                for axis in range(3):
                    depth -= placed.centers[s, axis] * rotation[axis, 2]
                plane, deep, asked = turning(placed, away(separate, sides, eye, i, s), i, s)
                if asked and not tried[i, s]:
                    untried[new, 0], untried[new, 1] = i, s
                    new += 1
                far_off = min(
                    plane / (lens[6] * max(depth, 1e-9)),
                    deep / (lens[7] * (placed.radius[i] + placed.radius[s])),
                )
                if far_off < 1 and _may_be_wrong(placed, i, s, depth):
                    pairs[k, 0], pairs[k, 1] = i, s
                    depths[k, 0], depths[k, 1] = depth, far_off
                    k += 1
    if new:
        return pairs[:0], np.empty((0, 3)), untried[:new]
    counts = np.empty((k, 3))
    if k == 0:
        return pairs[:0], counts, untried[:0]
    seen, known = np.empty((len(near), WAYS, 2)), np.zeros(len(near), np.bool_)  # their outlines
    cloud = np.empty((starts[-1, 0], 3))
    for p in range(k):
        i, s = pairs[p]
        for o in (i, s):
            if not known[o]:
                a, b = starts[o, 0], starts[o + 1, 0]
                for c in range(a, b):
                    for axis in range(3):
                        cloud[c, axis] = 0.0
                        for d in range(3):
                            cloud[c, axis] += (points[c, d] - eye[d]) * rotation[d, axis]
                seen[o] = _outline(cloud[a:b], lens)
                known[o] = True
        depth = depths[p, 0]
        whole, core = seen[i], seen[s]
        nearer = farther = whole
        if far[i] <= depth:
            farther = whole[:0]
        elif near[i] >= depth:
            nearer = whole[:0]
        else:
            own = cloud[starts[i, 0] : starts[i + 1, 0]]
            lines = edges[starts[i, 1] : starts[i + 1, 1]]
            nearer = _part(own, lines, depth, 1.0, lens)
            farther = whole if convex[i] else _part(own, lines, depth, -1.0, lens)
        counts[p, 2] = 1 - depths[p, 1]
        counts[p, 0], counts[p, 1] = _pixels(nearer, farther, core, convex[i], convex[s], lens)
    return pairs[:k], counts, untried[:0]


@njit(cache=True)
def _meet(placed: Placed, i: int, s: int, lens: Floats) -> bool:
    """Whether i and the border of s may share more than a FEW pixels: their boxes, and spheres."""
    extents, width = placed.extents, lens[3]
    x0, y0 = max(extents[i, 0], extents[s, 0] - width), max(extents[i, 1], extents[s, 1] - width)
    x1, y1 = min(extents[i, 2], extents[s, 2] + width), min(extents[i, 3], extents[s, 3] + width)
    x0, y0, x1, y1 = max(x0, 0.0), max(y0, 0.0), min(x1, lens[4]), min(y1, lens[5])
    if x1 <= x0 or y1 <= y0 or (x1 - x0) * (y1 - y0) <= FEW:
        return False
    # Their spheres, about the middles of the boxes.
    dx = extents[i, 0] + extents[i, 2] - extents[s, 0] - extents[s, 2]
    dy = extents[i, 1] + extents[i, 3] - extents[s, 1] - extents[s, 3]
    near = placed.near
    spheres = placed.radius[i] / max(near[i], 1e-9) + placed.radius[s] / max(near[s], 1e-9)
    return np.sqrt(dx * dx + dy * dy) / 2 <= lens[0] * spheres * APART + width


@njit(cache=True)
def _may_be_wrong(placed: Placed, i: int, s: int, depth: float) -> bool:
    """Whether i may come on the wrong side of the border of s, at that depth."""
    if placed.near[i] < depth and placed.far[i] > depth:
        return True
    way = compare(
        placed.centers, placed.sides, placed.radius, placed.near, placed.far, i, s
    )  # fmt: skip
    return way != (IN_FRONT if placed.far[i] <= depth else BEHIND)


@njit(cache=True)
def _pixels(
    nearer: Floats, farther: Floats, core: Floats, convex: bool, solid: bool, lens: Floats
) -> tuple[float, float]:
    """Over how many pixels of the border about a `core` (h, 2) hulls are nearer and farther: of
    what is `convex`, the farther one without the nearer. Is the core not `solid`, it is border."""
    none, width = (np.inf, -np.inf), lens[3]
    top, bottom = max(core[:, 1].min() - width, 0.0), min(core[:, 1].max() + width, lens[5])
    low, high = np.inf, -np.inf
    for hull in (nearer, farther):
        for p in range(len(hull)):
            low, high = min(low, hull[p, 1]), max(high, hull[p, 1])
    top, bottom = max(top, low), min(bottom, high)
    if bottom <= top:
        return 0.0, 0.0
    rows = min(int(bottom - top) // 2 + 1, ROWS)
    step = (bottom - top) / rows
    around, found, total = _around(core, width), 0.0, 0.0
    for r in range(rows):
        y = top + (r + 0.5) * step
        outer, inner = _across(around, y), _across(core, y) if solid else none
        outer = (max(outer[0], 0.0), min(outer[1], lens[4]))
        a, b = _across(nearer, y), _across(farther, y)
        found += _shared(a, outer) - _shared(a, inner)
        total += _shared(b, outer) - _shared(b, inner)
        if convex and len(nearer) and len(farther):
            total -= _shared(a, outer) - _shared(a, inner)
    return found * step, total * step


@njit(cache=True)
def _part(points: Floats, edges: Ints, depth: float, side: float, lens: Floats) -> Floats:
    """The outline of what of a hull is nearer than a depth (side 1), or farther (−1)."""
    out = np.empty((len(points) + len(edges), 3))
    k = 0
    for p in points:
        if side * (depth + p[2]) > 0:
            out[k] = p
            k += 1
    for e in range(len(edges)):
        a, b = points[edges[e, 0]], points[edges[e, 1]]
        if (-a[2] < depth) != (-b[2] < depth):
            out[k] = a + (b - a) * ((depth + a[2]) / (a[2] - b[2]))
            k += 1
    return _outline(out[:k], lens)


@njit(cache=True)
def _outline(points: Floats, lens: Floats) -> Floats:
    """(WAYS, 2) pixels of the hull about what points (p, 3) in camera space show of themselves,
    but for what reaches out between the WAYS; (0, 2) of no points."""
    out, most = np.empty((WAYS if len(points) else 0, 2)), np.full(WAYS, -np.inf)
    for p in range(len(points)):
        s = -lens[0] / points[p, 2]
        x, y = lens[1] + s * points[p, 0], lens[2] - s * points[p, 1]
        for k in range(WAYS):
            reach = _X[k] * x + _Y[k] * y
            if reach > most[k]:
                most[k], out[k, 0], out[k, 1] = reach, x, y
    return out


@njit(cache=True)
def _across(hull: Floats, y: float) -> tuple[float, float]:
    """From where to where a row of pixels lies in an outline (h, 2)."""
    low, high = np.inf, -np.inf
    last = len(hull) - 1
    for k in range(len(hull)):
        above = hull[last, 1] <= y
        if above != (hull[k, 1] <= y):
            t = (y - hull[last, 1]) / (hull[k, 1] - hull[last, 1])
            x = hull[last, 0] + (hull[k, 0] - hull[last, 0]) * t
            low, high = min(low, x), max(high, x)
        last = k
    return low, high


@njit(cache=True)
def _around(core: Floats, width: float) -> Floats:
    """(WAYS, 2) the outline of all within a width of another: a circle of as many corners moved
    along that."""
    out = np.empty((WAYS, 2))
    for k in range(WAYS):
        out[k, 0], out[k, 1] = core[k, 0] + width * _X[k], core[k, 1] + width * _Y[k]
    return out


@njit(cache=True)
def _shared(a: tuple[float, float], b: tuple[float, float]) -> float:
    return max(min(a[1], b[1]) - max(a[0], b[0]), 0.0)
