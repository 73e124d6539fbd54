"""Pairs whose order is about to turn round.

Of two objects that no plane separates the centres decide (order.py), and at whichever depth they
pass one another all pixels that both share behind a mask turn round at once. So close to that the
one to come last is drawn behind the first as well, where it lies there, as targets that cross are
(crossing.py): the more strongly the closer they are, so that nothing jumps there either. Not where
something else may stand before both.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.plan.blending import Blending
from seethrough.renderer.plan.comparing import IN_FRONT
from seethrough.renderer.plan.straddling import DEEP, FEW
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import Boxes
from seethrough.renderer.scene.scene import Scene

LEAST = 1 / 64  # of what is multiplied in and divided out again, in 16 bits
NONE: Ints = np.zeros((0, 2), np.int64)


def swapping(
    what: Blending, scene: Scene, camera: Camera, boxes: Boxes, of_object: Ints, apart: Bools
) -> tuple[Ints, Floats]:
    """(k, 2) the objects of each pair, the one drawn first and the other, and how strongly that is
    to be drawn behind it (k,), up to 1; `of_object` (n,) are their levels. Targets have other rules
    (order.decide), and what is drawn `apart` (n,) is left out."""
    found = np.flatnonzero(what.uncertain)
    if not len(found):
        return NONE, np.zeros(0)
    depth = camera.depth(scene.group_centers)
    free = what.blended & ~scene.targets & ~apart
    i, j, away = _close(found, free, scene.group_of, depth, scene.radii)
    if not len(i):
        return NONE, np.zeros(0)
    low = np.maximum(what.extents[i, :2], what.extents[j, :2])
    high = np.minimum(what.extents[i, 2:4], what.extents[j, 2:4])
    shared = np.maximum(high - low, 0).prod(axis=1)
    strength = np.minimum(1 - away, shared / FEW - 1)
    turned = of_object[i] > of_object[j]
    pairs = np.where(turned[:, None], np.stack([j, i], axis=1), np.stack([i, j], axis=1))
    there = (strength > LEAST) & (of_object[i] != of_object[j])
    there &= (of_object[i] >= 0) & (of_object[j] >= 0)
    for k in np.nonzero(there)[0].tolist():
        there[k] = not _hidden(what, boxes, of_object, *pairs[k].tolist())
    return pairs[there], np.minimum(strength[there], 1.0)


@njit(cache=True)
def _close(
    places: Ints, free: Bools, group_of: Ints, depth: Floats, radii: Floats
) -> tuple[Ints, Ints, Floats]:
    """Of the pairs at these places of a table (n, n) the two objects (k,), i before j, and how far
    the depths (n,) of their groups are apart (k,), of what swaps them at most: those that are both
    `free` (n,) and close."""
    n, k = len(free), 0
    i, j, away = (
        np.empty(len(places), np.int64),
        np.empty(len(places), np.int64),
        np.empty(len(places)),
    )
    for place in places:
        a, b = place // n, place % n
        if a < b and free[a] and free[b] and group_of[a] != group_of[b]:
            apart = abs(depth[a] - depth[b]) / (DEEP * (radii[a] + radii[b]))
            if apart < 1 - LEAST:
                i[k], j[k], away[k] = a, b, apart
                k += 1
    return i[:k], j[:k], away[:k]


def _hidden(what: Blending, boxes: Boxes, of_object: Ints, first: int, last: int) -> bool:
    """Whether what was drawn before the first one may lie before the last one where both are: then
    what is behind it, as the depth buffer tells, need not be behind the first one."""
    extents = what.extents
    low = np.maximum(extents[first, :2], extents[last, :2])
    high = np.minimum(extents[first, 2:4], extents[last, 2:4])
    there = boxes.inside & (boxes.near < boxes.far[last])
    there &= (extents[:, :2] <= high).all(axis=1) & (extents[:, 2:4] >= low).all(axis=1)
    there &= ~what.blended | (of_object < of_object[first])
    surely = (what.relation[last] == IN_FRONT) & ~what.uncertain[last]
    there &= ~surely
    there[[first, last]] = False
    return bool(there.any())
