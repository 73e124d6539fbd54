"""Sort by distance, again whenever the camera moved (WebSorting), or by view depth (Elmqvist2009).

A heuristic: it is exact only where no polygon reaches past another's centre, so for small
polygons of about one size that don't intersect. Long polygons next to short ones, cyclic overlap
and intersections come out wrong. Depth writes stay off while its order is drawn, so that a wrong
order costs a wrong blend and not a hole. Nothing is cut; polygons are added and moved freely.

Equal distances keep their input order. (The paper's map keyed by distance drops all but one.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.polygons import Polygons, check
from seethrough.renderer.polygons.prepared import Stats, drawable, viewpoint

METRICS = ("distance", "depth")


class PreparedDistance:
    """Polygons and their centres. `sorts` counts how often a new camera made it sort again."""

    def __init__(self, polygons: Polygons, metric: str) -> None:
        if metric not in METRICS:
            raise ValueError(f"metric = {metric!r}, expected one of {', '.join(METRICS)}")
        check(polygons)
        self.metric = metric
        self.sorts = 0
        self._camera: tuple[bytes, bytes | None] | None = None
        self._set(polygons)

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """Triangle indices from back to front (see `prepared.Prepared`).

        Depth in a perspective picture needs both the eye and the view vector; ValueError if the
        metric is "depth" and there is no view vector.
        """
        if self.metric == "depth" and view is None:
            raise ValueError("view = None, expected a view vector to measure depth along")
        camera = (
            viewpoint(eye, view).tobytes(),
            None if view is None else np.asarray(view).tobytes(),
        )
        if camera != self._camera:
            self._order = self._sorted(eye, view)
            self._camera = camera
            self.sorts += 1
        return self._order

    def add(self, polygons: Polygons) -> Whole:
        """Take in more polygons; returns their indices. Raises ValueError as `check` does."""
        check(polygons)
        old = self.drawable.polygons
        begin = len(old)
        self._set(
            Polygons(
                np.concatenate([old.vertices, polygons.vertices]),
                np.concatenate([old.starts, polygons.starts[1:] + old.starts[-1]]),
                np.concatenate([old.attributes, polygons.attributes]),
                np.concatenate([old.objects, polygons.objects]),
            )
        )
        return np.arange(begin, begin + len(polygons))

    def move(self, indices: Whole, vertices: Floats) -> None:
        """Give the polygons at `indices` new corners, one after the other in `vertices` (n, 3)."""
        old = self.drawable.polygons
        indices = np.asarray(indices, np.int64)
        moved = old.vertices.copy()
        counts = old.counts[indices]
        if len(vertices) != counts.sum():
            raise ValueError(f"vertices: {len(vertices)} corners, expected {counts.sum()}")
        places = np.concatenate([[0], np.cumsum(counts)])
        rows = np.repeat(old.starts[indices] - places[:-1], counts) + np.arange(places[-1])
        moved[rows] = vertices
        polygons = Polygons(moved, old.starts, old.attributes, old.objects)
        check(polygons.take(indices))
        self._set(polygons)

    def _set(self, polygons: Polygons) -> None:
        self.drawable = drawable(polygons, np.arange(len(polygons)))
        self.stats = Stats(inputs=len(polygons), outputs=len(polygons))
        self._centers = centers(polygons)
        self._camera = None
        self._order = np.empty(0, np.int32)

    def _sorted(self, eye: Floats | None, view: Floats | None) -> NDArray[np.int32]:
        if self.metric == "depth" or eye is None:
            away = self._centers @ np.asarray(view, float)
        else:
            away = np.linalg.norm(self._centers - np.asarray(eye, float), axis=1)
        return self.drawable.triangle_order(np.argsort(-away, kind="stable"))


def prepare(polygons: Polygons, metric: str = "distance") -> PreparedDistance:
    """Keep polygons for sorting: by `distance` of the centre (WebSorting), or by view `depth`
    (Elmqvist2009)."""
    return PreparedDistance(polygons, metric)


def centers(polygons: Polygons) -> Floats:
    """(m, 3) mean of each polygon's corners."""
    if len(polygons) == 0:
        return np.empty((0, 3))
    sums = np.add.reduceat(polygons.vertices, polygons.starts[:-1], axis=0)
    return sums / polygons.counts[:, None]
