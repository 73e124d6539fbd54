"""Two targets that reach into one another, each drawn within the other.

Of two targets that no plane separates one would be lost where it lies behind, whoever goes first.
To sort these pixels costs as much as a third of a frame of little things; a handful of draws that
go by the depth buffer give the same picture (gpu/levels/crossing_painter.py), if one is convex, so
that it has one surface at a pixel.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Ints, Signs
from seethrough.renderer.plan.blending import Blending
from seethrough.renderer.plan.comparing import IN_FRONT
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

    Nothing goes last twice, and no pairs close a ring: then what is behind one of a pair, as the
    depth buffer tells, is behind that one and no other. Nor is it so where something impenetrable
    may stand before both.
    """
    # Each pair is there both ways round.
    places = [divmod(place, len(hard)) for place in np.flatnonzero(what.lost).tolist()]
    found = [(i, j) for i, j in places if i < j]
    if not found:
        return NONE
    kept: list[tuple[int, int]] = []
    chain = {t: t for pair in found for t in pair}  # of each target, one name for all it hangs on
    free = {t: bool(scene.convex[t]) for t in chain}
    for i, j in found:
        first, last = (i, j) if _goes_first(what, i, j) else (j, i)
        if not free[last]:
            first, last = last, first
        if free[last] and chain[i] != chain[j] and not _before(boxes, hard, i, j):
            kept.append((first, last))
            free[last] = False
            old, new = chain[j], chain[i]
            chain = {t: new if name == old else name for t, name in chain.items()}
    return np.array(kept, np.int64).reshape(-1, 2)


def _goes_first(what: Blending, i: int, j: int) -> bool:
    """Whether i is better drawn before j: something lies before i and behind j; else as said."""
    one_way, other_way = _between(what.relation, i, j), _between(what.relation, j, i)
    return bool(one_way if one_way != other_way else what.relation[j, i] > 0)


@njit(cache=True)
def _between(relation: Signs, i: int, j: int) -> bool:
    """Whether anything lies before i and behind j."""
    for k in range(len(relation)):
        if relation[k, i] > 0 and relation[k, j] < 0:
            return True
    return False


def in_order(what: Blending, found: Ints) -> Blending:
    """The same with these pairs (k, 2) in that order, which is in doubt no more."""
    if not len(found):
        return what
    relation, uncertain, lost = what.relation.copy(), what.uncertain.copy(), what.lost.copy()
    for first, last in found.tolist():
        relation[last, first], relation[first, last] = IN_FRONT, -IN_FRONT
        uncertain[first, last] = uncertain[last, first] = False
        lost[first, last] = lost[last, first] = False
    return replace(what, relation=relation, uncertain=uncertain, lost=lost)


def _before(boxes: Boxes, hard: Bools, i: int, j: int) -> bool:
    """Whether any of what is `hard` may stand before both."""
    if not hard.any():
        return False
    k = np.nonzero(hard & (boxes.near < max(boxes.far[i], boxes.far[j])))[0]
    both, extents = boxes.extents[[i, j]], boxes.extents[k]
    meets = (extents[:, :2] <= both[:, 2:].max(axis=0)) & (
        extents[:, 2:] >= both[:, :2].min(axis=0)
    )
    return bool(meets.all(axis=1).any())
