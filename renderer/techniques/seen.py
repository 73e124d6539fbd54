"""What a rule is asked about, all surfaces at all pixels, and its answer: how each shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Ints

if TYPE_CHECKING:
    from seethrough.renderer.techniques.base import Shot


@dataclass(frozen=True, eq=False)
class Surfaces:
    """All surfaces of all objects at all pixels, front and back: m rows in the order of pixels, at
    each pixel from the front to the back; of two at the same depth the later object comes first.

    pixel (m,) is row · width + column; depth (m,) the view depth; object and triangle (m,) say
    whose surface it is; front (m,) whether its outside faces the eye; offset (m, 3) leads from the
    eye to it, in the world; normal (m, 3) is the mesh's own, turned outwards, not of unit length;
    color (m, 3) is unlit; slack (m,) is by how much its depth may differ where float32 and float64
    put edges 1/256 pixel apart. starts (h·w + 1,) says where each pixel's rows begin; outlines has
    for each object its front-facing triangles (k, 3, 2) in pixels, cut at the near plane; edge
    (h·w,) are the pixels within 1/256 pixel of the edge of a triangle that faces the eye,
    `edges` of any triangle.
    """

    shot: Shot
    pixel: Ints
    depth: Floats
    object: Ints
    triangle: Ints
    front: Bools
    offset: Floats
    normal: Floats
    color: Floats
    slack: Floats
    starts: Ints
    outlines: tuple[Floats, ...]
    edge: Bools
    edges: Bools

    @property
    def targets(self) -> Bools:
        """(m,) which rows belong to targets."""
        return self.shot.scene.targets[self.object]

    @property
    def penetrable(self) -> Bools:
        """(m,) which rows belong to what is no target and not impenetrable."""
        scene = self.shot.scene
        return ~(scene.targets | scene.impenetrable)[self.object]

    @property
    def place(self) -> Floats:
        """(m, 2) column + 0.5 and row + 0.5: the middle of each row's pixel."""
        row, column = np.divmod(self.pixel, self.shot.size[0])
        return np.stack([column, row], axis=1) + 0.5

    def first(self, among: Bools) -> Bools:
        """(m,) which rows are the nearest of their object at their pixel, among some."""
        rows = np.nonzero(among)[0]
        key = self.pixel[rows] * (int(self.object.max(initial=0)) + 1) + self.object[rows]
        found = np.zeros(len(among), dtype=bool)
        found[rows[np.unique(key, return_index=True)[1]]] = True
        return found

    def nearest(self, among: Bools) -> Floats:
        """(h·w,) depth of each pixel's nearest row among some, inf where there is none."""
        return self._extreme(among, np.minimum, np.inf)

    def farthest(self, among: Bools) -> Floats:
        """(h·w,) depth of each pixel's farthest row among some, 0 where there is none."""
        return self._extreme(among, np.maximum, 0.0)

    def _extreme(self, among: Bools, ufunc: np.ufunc, none: float) -> Floats:
        found = np.full(len(self.starts) - 1, none)
        ufunc.at(found, self.pixel[among], self.depth[among])
        return found


@dataclass(frozen=True, eq=False)
class Look:
    """How each row of Surfaces shows: kept (m,); opacity (m,), of what is kept; tint (m, 4): a
    colour, and how much of it covers the lit one; doubt (m,): rows so near a border of the rule
    that float32 may decide otherwise, whose pixels are not compared. `additive`: opacities of a
    line of sight add up (Elmqvist2009 §III-A) instead of multiplying."""

    kept: Bools
    opacity: Floats
    tint: Floats | None = None
    doubt: Bools | None = None
    additive: bool = False
