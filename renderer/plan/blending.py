"""What a frame puts in order, and what of it no order gets right."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Ints, Signs
from seethrough.renderer.plan import doubt as doubts
from seethrough.renderer.plan import levels, order

# Where masks cover the picture so many times over, borders lie on whatever is beside their targets,
# and no order of whole objects is near what they show.
CROWDED = 4
MOSTLY = 0.4  # where this share of all masks is to be sorted by pixel, all of it may as well be


class Ordered(NamedTuple):
    """The level of each object and of each mask (levels.levels), whether an order was `broken`;
    the parts that are `doubtful` (k, 4), and whether these are so `much` that all is sorted."""

    of_object: Ints
    of_mask: Ints
    broken: bool
    doubtful: Floats
    much: bool


@dataclass(frozen=True, eq=False)
class Blending:
    """What is put in order: objects `seen`, from far to near, of n with `extents` and `reach` of
    masks (n, 8); of each pair the `relation` and whether it is `uncertain` (n, n); which of them
    are `blended` and `masked` (n,). See order.decide. `lost` (n, n): of which pairs a target may be
    lost whatever goes first."""

    seen: Ints
    extents: Floats
    reach: Floats
    relation: Signs
    uncertain: Bools
    blended: Bools
    masked: Bools
    lost: Bools

    @property
    def related(self) -> order.Related:
        """The same as compiled code takes it."""
        return order.Related(
            self.seen, self.extents, self.reach, self.relation, self.blended, self.masked
        )

    def ordered(self, size: tuple[int, int], doubt: float, part_by_part: bool) -> Ordered:
        """Everything in levels, as far as that is wanted: not of what is sorted by pixel anyway,
        if that may be done `part_by_part`."""
        doubtful, much = self.doubtful(np.zeros_like(self.uncertain), size, doubt)
        none = np.zeros(0, np.int64)
        if much and part_by_part:
            return Ordered(none, none, False, doubtful, True)
        of_object, of_mask, broken = levels.levels(self.related)
        if broken.any():
            doubtful, much = self.doubtful(broken, size, doubt)
        return Ordered(of_object, of_mask, bool(broken.any()), doubtful, much and part_by_part)

    def doubtful(self, broken: Bools, size: tuple[int, int], doubt: float) -> tuple[Floats, bool]:
        """The parts to sort by pixel, and whether they are so much that all masks may be.

        Where a target may be lost no doubt is allowed, for the rest see doubt.chosen. If masks are
        CROWDED, all of them are.
        """
        whole = np.array(size, float)
        reach = np.clip(self.reach[self.masked, :4], 0, [*size, *size])
        if (reach[:, 2:] - reach[:, :2]).prod(axis=1).sum() > CROWDED * whole.prod():
            return reach, True
        found, lost = order.doubtful(self.related, self.uncertain, broken, self.lost, whole)
        chosen = np.concatenate([found[lost], doubts.chosen(found[~lost], size, doubt)])
        if not len(chosen):
            return chosen, False
        return chosen, doubts.union(chosen) > MOSTLY * _area(self.parts(size))

    def parts(self, size: tuple[int, int]) -> Ints:
        """Where masks can be."""
        return merged_parts(self.reach[self.masked, :4], size)


def merged_parts(boxes: Floats, size: tuple[int, int]) -> Ints:
    """(k, 4) whole pixels that hold all boxes and do not overlap; one for all if nearly all."""
    if not len(boxes):
        return np.zeros((0, 4), np.int64)
    low = np.maximum(np.floor(boxes[:, :2]) - 1, 0)
    high = np.minimum(np.ceil(boxes[:, 2:]) + 1, size)
    rows = np.concatenate([low, high], axis=1)[(low < high).all(axis=1)]
    parts = order.merge(np.ascontiguousarray(rows)).astype(np.int64)
    if (parts[:, 2:] - parts[:, :2]).prod(axis=1).sum() > 0.6 * size[0] * size[1]:
        return np.array([[0, 0, *size]])
    return parts


def _area(parts: Ints) -> int:
    return int((parts[:, 2:] - parts[:, :2]).prod(axis=1).sum())
