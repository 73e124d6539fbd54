"""What a frame is drawn from: which objects with which effects, in which order, and why."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from seethrough.renderer.arrays import Floats, Ints, Signs
from seethrough.renderer.plan import crossing, straddling
from seethrough.renderer.plan import swapping as swaps
from seethrough.renderer.scene.projection import Boxes
from seethrough.renderer.techniques.base import Shot

SHORTCUTS = {
    "cull": "objects outside the view are not drawn",
    "opaque": "only objects in front of a mask are blended and put in order",
    "masks": "only targets with something penetrable in front get a mask",
    "levels": "objects that overlap nowhere on the screen are drawn together",
    "prepass": "only concave objects in front of a mask get a pre-pass for depth",
    "hulls": "the mask of a convex target is its hull with a skirt, without a picture of its own",
    "counting": "layers are counted only where they could take more light than is allowed",
    "outside": "large objects are blended only where masks are, and drawn opaque elsewhere",
    "parts": "only parts of the picture whose order is in doubt are sorted by pixel",
    "crossing": "two targets that cross are drawn one within the other, not sorted by pixel",
    "held": "objects that lie in a part sorted by pixel are drawn there alone",
    "removed": "what a hole takes is not drawn: things, of large meshes single triangles",
    "still": "a frame in which nothing changed is shown again",
    "rooms": "where walls are opaque, only what shows through doorways is drawn",
}

# Why an object is drawn as it is (FramePlan.reasons).
OUTSIDE, OPAQUE, HARD, BLENDED, RULED, UNSEEN = range(6)


@dataclass(frozen=True, eq=False)
class Level:
    """Objects (indices) that overlap nowhere on the screen, then the masks of targets."""

    objects: Ints
    masks: Ints


@dataclass(frozen=True, eq=False)
class FramePlan:
    """What to draw, in this order: `opaque` with a depth buffer, each level, then `exact`.

    The first level holds masks only. `masked` are all targets that get a mask, `reach` (n, 4)
    what each mask can cover, `counted` those whose layers must be counted, `exact` (k, 4) the
    parts of the picture (left, top, right, bottom) to sort by pixel, of each only the blocks that
    `doubtful` (k, 4) touch if there are any; objects that are `held` show nowhere else and are
    drawn by that alone. `crossing` (k, 2) are targets that cross: the second one is drawn behind
    the first as well, where it lies there (plan/crossing.py). `straddling` (k, 3) are objects that
    reach to both sides of the border of a target's mask, the target, and whether the mask is drawn
    before the object: the border is told from them by depth, with a `strength` (k,) up to 1
    (plan/straddling.py). `swapping` (k, 2) are pairs whose order is about to turn round: the second
    one is drawn behind the first as well, as strongly as `beyond` (k,) says (plan/swapping.py).
    `wide` are blended objects to be drawn opaque outside `holes` (k, 4), the rectangles that hold
    all masks, before anything else. `clusters` are drawn polygon by polygon, in the place of their
    first members, which alone are in levels. `ruled` are drawn last, each surface as the
    technique's rule has it, which was asked about `shot` (None: there are none). `boxes` are the
    extents of all objects. `reasons` (n,) say why each object is drawn as it is; `relation` (n, n)
    is who is drawn before whom (order.decide), empty where nothing is put in order.
    """

    opaque: Ints
    levels: tuple[Level, ...]
    masked: Ints
    counted: Ints
    exact: Ints
    boxes: Boxes
    reach: Floats
    reasons: Ints
    relation: Signs = field(default_factory=lambda: np.zeros((0, 0), np.int8))
    without: frozenset[str] = field(default_factory=frozenset)
    wide: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    holes: Ints = field(default_factory=lambda: np.zeros((0, 4), np.int64))
    clusters: tuple[Ints, ...] = ()
    held: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    doubtful: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    ruled: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    shot: Shot | None = None
    crossing: Ints = field(default_factory=lambda: crossing.NONE)
    straddling: Ints = field(default_factory=lambda: straddling.NONE)
    strength: Floats = field(default_factory=lambda: np.zeros(0))
    swapping: Ints = field(default_factory=lambda: swaps.NONE)
    beyond: Floats = field(default_factory=lambda: np.zeros(0))

    @cached_property
    def single(self) -> Ints:
        """What is drawn by itself: targets that cross, what straddles the border of a mask, and
        what another is drawn behind."""
        alone = {*self.straddling[:, 0].tolist(), *self.swapping[:, 0].tolist()}
        return np.array([*self.crossing.ravel().tolist(), *sorted(alone)], np.int64)

    @cached_property
    def depths(self) -> tuple[float, float]:
        """View depths of the nearest and farthest corner in the picture: (inf, −inf) if it is
        empty."""
        seen, boxes = self.boxes.inside, self.boxes
        near = boxes.near.min(where=seen, initial=np.inf)
        return float(near), float(boxes.far.max(where=seen, initial=-np.inf))

    @cached_property
    def behind(self) -> Ints:
        """(n,) a masked target behind each blended object, −1 where there is none."""
        found = np.full(len(self.reasons), -1)
        if self.relation.any():
            over = np.zeros(self.relation.shape, dtype=bool)
            over[:, self.masked] = self.relation[:, self.masked] > 0
            over[self.reasons != BLENDED] = False
            found[over.any(axis=1)] = over.argmax(axis=1)[over.any(axis=1)]
        return found

    @property
    def ordered(self) -> int:
        """How many objects are put in order."""
        return sum(len(level.objects) for level in self.levels)
