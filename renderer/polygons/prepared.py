"""What every method's `prepare` returns, and how a frame asks for an order."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.polygons import Polygons
from seethrough.renderer.polygons.predicates import plane_corners, plane_rows
from seethrough.renderer.polygons.triangulation import triangulate

DENSE_CROSSINGS = "DENSE CROSSINGS"  # begins the warning
DENSE = 8  # times as many out as in: soups of random triangles stay below 5


@dataclass(frozen=True, slots=True)
class Stats:
    """What a method cost.

    `splits` counts cuts, so a concave polygon's may give more than two pieces each; `relations`
    counts tests of one polygon against another's plane (Chen1996's one-way relations), or of
    one box against another; `depth` is the longest way from the root; `nodes` are by kind.
    """

    inputs: int
    outputs: int
    splits: int = 0
    relations: int = 0
    depth: int = 0
    nodes: dict[str, int] = field(default_factory=dict)

    @property
    def dense(self) -> str:
        """A warning with figures where polygons cross so densely that cutting them made many more;
        empty otherwise."""
        if self.outputs <= DENSE * max(self.inputs, 1):
            return ""
        times = self.outputs / max(self.inputs, 1)
        return (
            f"{DENSE_CROSSINGS}: {self.inputs} polygons cut into {self.outputs}, "
            f"{times:.0f} × as many"
        )


@dataclass(frozen=True, eq=False, slots=True)
class Drawable:
    """Output polygons and the triangles to draw them with.

    `source` (m,) is the input polygon of each output polygon, `triangles` (t, 3) index
    `polygons.vertices`, and polygon i has triangles bounds[i] to bounds[i + 1].
    """

    polygons: Polygons
    source: Whole
    triangles: NDArray[np.int32]
    bounds: Whole

    @property
    def owner(self) -> Whole:
        """(t,) output polygon of each triangle."""
        return np.repeat(np.arange(len(self.polygons)), np.diff(self.bounds))

    def triangle_order(self, polygons: Whole) -> NDArray[np.int32]:
        """Triangle indices of output polygons in the order given."""
        first, counts = self.bounds[polygons], np.diff(self.bounds)[polygons]
        starts = np.cumsum(counts) - counts
        return (np.repeat(first - starts, counts) + np.arange(counts.sum())).astype(np.int32)


def drawable(polygons: Polygons, source: Whole, planes: Floats | None = None) -> Drawable:
    """Output polygons as triangles; `planes` are `plane_rows` of the source polygons."""
    if planes is None:
        planes = plane_rows(plane_corners(polygons))
        normals = planes[:, 3:6]
    else:
        normals = planes[source, 3:6]
    triangles, bounds = triangulate(polygons, normals)
    return Drawable(polygons, source, triangles, bounds)


class Prepared(Protocol):
    """A set of polygons that can be ordered for any eye."""

    @property
    def drawable(self) -> Drawable:
        """What comes out, and is drawn."""

    @property
    def stats(self) -> Stats:
        """What it cost."""

    def order(self, eye: Floats | None = None, view: Floats | None = None) -> NDArray[np.int32]:
        """(t,) indices into `drawable.triangles`, from back to front.

        `eye` (3,) in world units for a perspective picture; `view` (3,), into the picture, for a
        parallel one. Both together: perspective, with depth measured along `view`.
        """


def viewpoint(eye: Floats | None, view: Floats | None) -> Floats:
    """(4,) homogeneous point the rays come from: the eye, or the direction opposite to `view`.

    Raises ValueError if neither is given, or a value is not finite, or the view vector is zero.
    """
    if eye is None and view is None:
        raise ValueError("order needs an eye (3,) or a view vector (3,), got neither")
    value = np.asarray(view if eye is None else eye, np.float64)
    if value.shape != (3,) or not np.isfinite(value).all():
        raise ValueError(f"{'view' if eye is None else 'eye'} = {value}, expected 3 finite numbers")
    if eye is not None:
        return np.append(value, 1.0)
    if not value.any():
        raise ValueError(f"view = {value}, expected a direction")
    return np.append(-value, 0.0)
