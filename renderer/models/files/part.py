"""What a reader makes of a file: triangles with a colour on every corner, linear, and textures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.source import Refused
from seethrough.renderer.models.files.texture import Texture

GREY = (0.7, 0.7, 0.7)
"""As shown, of what has no colour in its file."""
LARGEST = 1e30
"""Coordinates beyond this overflow in the cubic terms of a volume."""
MOST_TRIANGLES = 250_000
"""Half of the whole walkthrough: more in one object is a mistake more often than a wish."""
MOST_CORNERS = 5000
"""Of one polygon: the time to cut it into triangles grows with their square."""
WHITE = np.ones(4)


@dataclass(frozen=True, eq=False)
class Part:
    """vertices (n, 3); triangles (m, 3); colors (m, 3, 4) linear RGBA of each corner.

    Where there is a `texture`, its linear RGBA at uv (m, 3, 2) multiplies the colours. What has
    alpha 0 or less than `cutoff` is not shown, everything else is opaque; with a cutoff below 0
    alpha means nothing.
    """

    vertices: Floats
    triangles: NDArray[np.int64]
    colors: Floats
    uv: Floats | None = None
    texture: Texture | None = None
    cutoff: float = 0.0


@dataclass(eq=False)
class Found:
    """The parts of a file, where their colours come from, what is not shown as it is there, and
    what is `left_out` since it has no triangles."""

    parts: list[Part] = field(default_factory=list)
    colors: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)
    left_out: set[str] = field(default_factory=set)

    def note(self, text: str) -> None:
        """Something to tell the reader, once."""
        if text not in self.notes:
            self.notes.append(text)


def to_linear(shown: ArrayLike) -> Floats:
    """Colours as shown (sRGB, 0 to 1) as amounts of light (IEC 61966-2-1)."""
    c = np.asarray(shown, float)
    return np.where(c <= 0.04045, c / 12.92, ((np.maximum(c, 0.04045) + 0.055) / 1.055) ** 2.4)


def to_shown(linear: ArrayLike) -> Floats:
    """The other way round; amounts beyond 0 and 1 are cut."""
    c = np.clip(np.asarray(linear, float), 0.0, 1.0)
    large = 1.055 * np.maximum(c, 0.0031308) ** (1 / 2.4) - 0.055
    return np.clip(np.where(c <= 0.0031308, 12.92 * c, large), 0.0, 1.0)


def linear_rgba(shown: ArrayLike, alpha: ArrayLike = 1.0) -> Floats:
    """(..., 4) linear colours of (..., 3) shown ones and their alpha (...)."""
    rgb = to_linear(shown)
    return np.concatenate(
        [rgb, np.broadcast_to(np.asarray(alpha)[..., None], (*rgb.shape[:-1], 1))], -1
    )


def grey(count: int) -> Floats:
    """(count, 3, 4) corners of triangles without a colour."""
    return np.broadcast_to(linear_rgba(GREY), (count, 3, 4))


def checked_colors(values: Floats, what: str) -> Floats:
    """(n, 3 or 4) colours, none of which lacks a number. Raises Refused."""
    bad = np.flatnonzero(~np.isfinite(values).all(axis=-1))
    if len(bad):
        shown = ", ".join(f"{v:g}" for v in values[bad[0]])
        raise Refused(f"colour of {what} {bad[0]} = ({shown}): expected finite numbers")
    return values


def too_many(count: int, at_least: bool = False) -> None:
    """Raises Refused for more triangles than there may be."""
    if count > MOST_TRIANGLES:
        least = "at least " if at_least else ""
        raise Refused(f"{least}{count} triangles: expected at most {MOST_TRIANGLES}")


def cut_polygons(
    vertices: Floats, loops: Sequence[Sequence[int] | NDArray[np.int64]]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Polygons as triangles: places (m, 3) in the loops put one after the other, and (m,) which
    polygon each is of. Raises Refused for one of too many corners.

    `loops` are rows of `vertices`. Fans where they are convex, clipped ears where not.
    """
    from seethrough.renderer.polygons.polygons import Polygons, newell
    from seethrough.renderer.polygons.triangulation import triangulate

    counts = np.array([len(loop) for loop in loops], np.int64)
    if len(counts) and counts.max() > MOST_CORNERS:
        raise Refused(f"a polygon of {counts.max()} corners: expected at most {MOST_CORNERS}")
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    owner = np.repeat(np.arange(len(counts)), np.maximum(counts - 2, 0))
    too_many(len(owner))
    if not len(owner):
        return np.zeros((0, 3), np.int64), owner
    use = np.flatnonzero(counts >= 3)
    flat = np.concatenate([np.asarray(loop, np.int64) for loop in loops])
    every = Polygons(vertices[flat], starts, np.zeros((len(flat), 0)), np.arange(len(counts)))
    corners = np.concatenate([np.arange(starts[i], starts[i + 1]) for i in use])
    polygons = every.take(use)
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is refused later
        normals = newell(polygons)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
        triangles, _ = triangulate(polygons, normals)
    return corners[triangles.astype(np.int64)], owner
