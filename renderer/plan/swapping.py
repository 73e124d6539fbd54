"""Pairs whose order is about to turn round.

Of two objects that no plane separates the centres decide (order.py), and at whichever depth they
pass one another all pixels that both share behind a mask turn round at once. So close to that the
one to come last is drawn behind the first as well, where it lies there, as targets that cross are
(crossing.py): the more strongly the closer they are, so that nothing jumps there either. Not where
something else may stand before both.
"""

from __future__ import annotations

import numpy as np

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
    rows, columns = np.divmod(found, len(apart))
    free = what.blended & ~scene.targets & ~apart
    both = (rows < columns) & free[rows] & free[columns]
    both &= scene.group_of[rows] != scene.group_of[columns]
    i, j = rows[both], columns[both]
    if not len(i):
        return NONE, np.zeros(0)
    depth = camera.depth(scene.group_centers)
    away = np.abs(depth[i] - depth[j]) / (DEEP * (scene.radii[i] + scene.radii[j]))
    close = away < 1 - LEAST
    if not close.any():
        return NONE, np.zeros(0)
    i, j, away = i[close], j[close], away[close]
    low = np.maximum(what.extents[i, :2], what.extents[j, :2])
    high = np.minimum(what.extents[i, 2:], what.extents[j, 2:])
    shared = np.maximum(high - low, 0).prod(axis=1)
    strength = np.minimum(1 - away, shared / FEW - 1)
    turned = of_object[i] > of_object[j]
    pairs = np.where(turned[:, None], np.stack([j, i], axis=1), np.stack([i, j], axis=1))
    there = (strength > LEAST) & (of_object[i] != of_object[j])
    there &= (of_object[i] >= 0) & (of_object[j] >= 0)
    for k in np.nonzero(there)[0].tolist():
        there[k] = not _hidden(what, boxes, of_object, *pairs[k].tolist())
    return pairs[there], np.minimum(strength[there], 1.0)


def _hidden(what: Blending, boxes: Boxes, of_object: Ints, first: int, last: int) -> bool:
    """Whether what was drawn before the first one may lie before the last one where both are: then
    what is behind it, as the depth buffer tells, need not be behind the first one."""
    extents = what.extents
    low = np.maximum(extents[first, :2], extents[last, :2])
    high = np.minimum(extents[first, 2:], extents[last, 2:])
    there = boxes.inside & (boxes.near < boxes.far[last])
    there &= (extents[:, :2] <= high).all(axis=1) & (extents[:, 2:] >= low).all(axis=1)
    there &= ~what.blended | (of_object < of_object[first])
    surely = (what.relation[last] == IN_FRONT) & ~what.uncertain[last]
    there &= ~surely
    there[[first, last]] = False
    return bool(there.any())
