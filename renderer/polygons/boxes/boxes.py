"""Objects ordered by their oriented bounding boxes, anew in every frame (Kang2008).

From the eye each box shows up to three faces; a six-bit code of these looks up its contour. Where
two contours overlap, one box is in front: the graph of these relations gives the order, and what
overlaps nothing is drawn whenever it suits. Nothing is prepared but the boxes, so objects may move.

The paper's rule counts the planes of one box that have all of the other in front: with exactly one
such plane the eye's side of it decides; with two, three or none, the nearest corner. Nearest
corners are wrong wherever a near, large box lies behind a small one: a wall that passes beside the
eye has a nearer corner than the cup that stands before its far end. `rule="plane"`, ours, takes
the widest plane between the two boxes and the eye's side of it, which is exact: the segment from
the eye to a point on the far side crosses the plane before it gets there.

Exact, with `rule="plane"`, for objects that are convex (their far faces are drawn first, then the
near ones) and whose boxes don't intersect. Boxes may be in front of each other in a circle,
whatever the rule: no order is right then. The circle is reported, and broken where two contours
overlap least. Intersecting boxes, which the paper excludes, are reported and ordered by the nearest
corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.boxes.box_geometry import Boxes, contour_table, fit
from seethrough.renderer.polygons.boxes.box_graph import draw_order
from seethrough.renderer.polygons.boxes.box_overlap import shared_views
from seethrough.renderer.polygons.boxes.box_relations import FIRST, INTERSECTING, SECOND, relate
from seethrough.renderer.polygons.polygons import Polygons, check
from seethrough.renderer.polygons.predicates import plane_corners, plane_rows
from seethrough.renderer.polygons.prepared import Drawable, Stats, drawable, viewpoint

RULES = ("plane", "paper")


@dataclass(frozen=True, eq=False, slots=True)
class BoxOrder:
    """Objects from back to front, and what stood in the way.

    `layers` (b,) is each object's: those of one layer overlap nowhere and may be drawn at once.
    `cycles` are the circles found, as tuples of objects; `broken` the relations (behind, front)
    that the order violates. `intersecting` are pairs whose boxes intersect and overlap in the
    picture. `tested` pairs overlapped.
    """

    objects: Whole
    layers: Whole
    cycles: tuple[tuple[int, ...], ...]
    broken: tuple[tuple[int, int], ...]
    intersecting: tuple[tuple[int, int], ...]
    tested: int


class PreparedBoxes:
    """Objects and their boxes. `boxes` may be replaced by `move` without a rebuild."""

    def __init__(self, polygons: Polygons, boxes: Boxes, rule: str) -> None:
        self.drawable: Drawable = drawable(polygons, np.arange(len(polygons)))
        self.rule = rule
        self._table, self._sizes = contour_table()
        rows = plane_rows(plane_corners(polygons))
        self._planes = np.column_stack([rows[:, 3:6], -(rows[:, 3:6] * rows[:, :3]).sum(axis=1)])
        _, self._object = np.unique(polygons.objects, return_inverse=True)
        self.stats = Stats(len(polygons), len(polygons), nodes={"box": len(boxes.centers)})
        self.move(boxes)

    def move(self, boxes: Boxes) -> None:
        """Other boxes for the same objects."""
        self.boxes = boxes
        self._corners = np.ascontiguousarray(boxes.corners())

    def arrange(self, eye: Floats | None = None, view: Floats | None = None) -> BoxOrder:
        """Objects from back to front."""
        point = viewpoint(eye, view)
        boxes = self.boxes
        relations, tested = relate(
            boxes.centers, boxes.axes, boxes.halves, self._corners, point, self._table,
            self._sizes, self.rule == "plane",
        )  # fmt: skip
        crossed = np.argwhere(relations == INTERSECTING)
        for i, j in crossed:
            near = [np.linalg.norm(self._corners[k] - point[:3], axis=1).min() for k in (i, j)]
            relations[i, j] = FIRST if near[0] < near[1] else SECOND
        objects, layers, cycles, broken = draw_order(
            relations, self._corners, point, lambda i, j: self._shared(i, j, point)
        )
        pairs = tuple((int(i), int(j)) for i, j in crossed)
        return BoxOrder(objects, layers, cycles, broken, pairs, int(tested))

    def _shared(self, first: Whole, second: Whole, point: Floats) -> Floats:
        boxes = self.boxes
        return shared_views(
            boxes.centers, boxes.axes, boxes.halves, self._corners, point, self._table,
            self._sizes, first, second,
        )  # fmt: skip

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """Triangle indices from back to front: object by object, far faces first."""
        point = viewpoint(eye, view)
        place = np.empty(len(self.boxes.centers), np.int64)
        place[self.arrange(eye, view).objects] = np.arange(len(place))
        toward = self._planes @ point > 0
        return self.drawable.triangle_order(np.lexsort((toward, place[self._object])))


def prepare(polygons: Polygons, boxes: Boxes | None = None, rule: str = "plane") -> PreparedBoxes:
    """Boxes about the objects of `polygons.objects`, fitted if not given.

    Raises ValueError for polygons that `polygons.check` refuses and for an unknown rule.
    """
    if rule not in RULES:
        raise ValueError(f"rule = {rule!r}, expected one of {', '.join(RULES)}")
    check(polygons)
    return PreparedBoxes(polygons, fit(polygons) if boxes is None else boxes, rule)
