"""Two targets that reach into one another, each drawn within the other.

Of two targets that no plane separates one would be lost where it lies behind, whoever goes first.
To sort these pixels costs as much as a third of a frame of little things; a handful of draws that
go by the depth buffer give the same picture (gpu/levels/pair_painter.py), if one is convex, so that
it has one surface at a pixel.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Ints
from seethrough.renderer.plan.blending import Blending
from seethrough.renderer.plan.order import IN_FRONT
from seethrough.renderer.scene.projection import Boxes
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

# What masks leave of the light is multiplied in and divided out again, in 16 bits.
LEAST = 1 / 64
NONE: Ints = np.zeros((0, 2), np.int64)


def fits(technique: DynamicTransparency) -> bool:
    """Whether masks go by the outline, and what they leave can be divided out."""
    plain = technique.mask == "outline" and technique.mode == "passive"
    plain &= technique.combine == "product" and technique.min_transmittance == 0
    return plain and min(technique.alpha_target, technique.alpha_edge) >= LEAST


def pairs(what: Blending, scene: Scene, boxes: Boxes, hard: Bools) -> Ints:
    """(k, 2) the targets of each pair that is lost, if they can be drawn one within the other: the
    one to go first, then the other, which is convex.

    Not what crosses two others, nor where something impenetrable may stand before both: the depth
    buffer tells whose surface lies behind.
    """
    found = np.argwhere(what.lost)  # of each pair both ways round
    found = found[found[:, 0] < found[:, 1]]
    if not len(found):
        return NONE
    many = np.bincount(found.ravel(), minlength=len(hard)) > 1
    near, far, extents, convex = boxes.near, boxes.far, what.extents, scene.convex
    kept = []
    for i, j in found.tolist():
        first, last = (i, j) if _goes_first(what, i, j) else (j, i)
        if not convex[last]:
            first, last = last, first
        low = np.minimum(extents[i, :2], extents[j, :2])
        high = np.maximum(extents[i, 2:], extents[j, 2:])
        before = hard & (near < max(far[i], far[j])) & _meets(extents, low, high)
        if convex[last] and not (many[i] or many[j] or before.any()):
            kept.append((first, last))
    return np.array(kept, np.int64).reshape(-1, 2)


def _goes_first(what: Blending, i: int, j: int) -> bool:
    """Whether i is better drawn before j: something lies before i and behind j; else as said."""
    own, other = what.relation[:, i], what.relation[:, j]
    one_way, other_way = ((own > 0) & (other < 0)).any(), ((own < 0) & (other > 0)).any()
    return bool(one_way if one_way != other_way else what.relation[j, i] > 0)


def in_order(what: Blending, found: Ints) -> Blending:
    """The same with these pairs (k, 2) in that order, which is in doubt no more."""
    relation, uncertain, lost = what.relation.copy(), what.uncertain.copy(), what.lost.copy()
    first, last = found.T
    relation[last, first], relation[first, last] = IN_FRONT, -IN_FRONT
    for doubts in (uncertain, lost):
        doubts[first, last] = doubts[last, first] = False
    return replace(what, relation=relation, uncertain=uncertain, lost=lost)


def _meets(extents: Floats, low: Floats, high: Floats) -> Bools:
    """(n,) which extents (n, 4) overlap the box from `low` to `high` on the screen."""
    return (extents[:, :2] <= high).all(axis=1) & (extents[:, 2:] >= low).all(axis=1)
