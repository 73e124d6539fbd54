"""What models are put together from: closed surfaces with a colour on every corner.

Shapes stay unshaded until `assemble` makes one Mesh of them: only then are vertices split where an
edge is sharp or the colour changes, all parts at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from renderer.geometry import Mesh

Array = NDArray[np.float64]
Color = tuple[float, float, float]

SHARP = 50.0
"""Degrees between the faces at an edge from which on the edge looks sharp."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """vertices (n, 3); triangles (m, 3), counter-clockwise from outside; colors (m, 3, 3), one RGB
    for each corner; crease (m,) cosine of the angle from which on an edge is sharp."""

    vertices: Array
    triangles: NDArray[np.int64]
    colors: Array
    crease: Array

    def at(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Shape:
        """Moved by (x, y, z)."""
        return replace(self, vertices=self.vertices + (x, y, z))

    def scaled(self, x: float, y: float | None = None, z: float | None = None) -> Shape:
        """Scaled by positive factors about the origin; by one factor where only one is given."""
        return replace(self, vertices=self.vertices * (x, y or x, z or x))

    def turned(self, axis: str, degrees: float) -> Shape:
        """Turned about the axis 'x', 'y' or 'z' through the origin, right-handed."""
        i = "xyz".index(axis)
        a, b = (i + 1) % 3, (i + 2) % 3
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        moved = self.vertices.copy()
        moved[:, a] = c * self.vertices[:, a] - s * self.vertices[:, b]
        moved[:, b] = s * self.vertices[:, a] + c * self.vertices[:, b]
        return replace(self, vertices=moved)

    def mirrored(self, axis: str = "x") -> Shape:
        """The mirror image in the plane through the origin across `axis`."""
        factors = np.where(np.arange(3) == "xyz".index(axis), -1.0, 1.0)
        return replace(
            self,
            vertices=self.vertices * factors,
            triangles=self.triangles[:, ::-1],
            colors=self.colors[:, ::-1],
        )

    def both(self, axis: str = "x") -> Shape:
        """The shape and its mirror image."""
        return join(self, self.mirrored(axis))

    def bent(self, move: Callable[[Array], Array]) -> Shape:
        """With every vertex moved by `move`, (n, 3) to (n, 3)."""
        return replace(self, vertices=move(self.vertices))

    def painted(self, color: Color, where: Callable[[Array], NDArray[np.bool_]]) -> Shape:
        """Whole triangles whose centroid (m, 3) lies `where` in another colour: a hard border."""
        chosen = where(self.vertices[self.triangles].mean(axis=1))
        return replace(self, colors=np.where(chosen[:, None, None], color, self.colors))

    def tinted(self, color: Color, amount: Callable[[Array], Array]) -> Shape:
        """Vertices (n, 3) blended towards a colour by `amount` (n,) in [0, 1]: a soft border."""
        share = np.clip(amount(self.vertices), 0, 1)[self.triangles][..., None]
        return replace(self, colors=self.colors * (1 - share) + np.array(color) * share)


def shape(
    vertices: ArrayLike, triangles: NDArray[np.int64], color: ArrayLike, sharp: float = SHARP
) -> Shape:
    """A Shape of one colour, (3,), or with one for each triangle (m, 3) or corner (m, 3, 3)."""
    rgb = np.asarray(color, float)
    rgb = rgb[:, None, :] if rgb.ndim == 2 else rgb
    colors = np.broadcast_to(rgb, (len(triangles), 3, 3))
    crease = np.full(len(triangles), np.cos(np.radians(sharp)))
    return Shape(np.asarray(vertices, float), triangles, colors, crease)


def join(*shapes: Shape) -> Shape:
    """All shapes as one."""
    starts = np.cumsum([0, *(len(s.vertices) for s in shapes)])
    return Shape(
        np.concatenate([s.vertices for s in shapes]),
        np.concatenate([s.triangles + start for s, start in zip(shapes, starts, strict=False)]),
        np.concatenate([s.colors for s in shapes]),
        np.concatenate([s.crease for s in shapes]),
    )


def assemble(*shapes: Shape, size: float | None = None) -> Mesh:
    """One Mesh of all shapes, standing on y = 0, its bounds centred at x = z = 0.

    Its longest side becomes `size` world units where that is given.
    """
    whole = join(*shapes)
    low, high = whole.vertices.min(axis=0), whole.vertices.max(axis=0)
    scale = 1.0 if size is None else size / (high - low).max()
    middle = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
    return shade(replace(whole, vertices=(whole.vertices - middle) * scale))


def shade(whole: Shape) -> Mesh:
    """The Mesh of a Shape where it stands, its vertices split at sharp edges and colour borders.

    Normals are means of the adjacent faces weighted by area, so that large flat faces stay flat
    beside rounded edges.
    """
    corners = whole.vertices[whole.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    label = _corner_groups(whole, faces)
    first, vertex_of = np.unique(label, return_inverse=True)
    weight = np.repeat(faces, 3, axis=0)
    normals = np.stack([np.bincount(vertex_of, weight[:, i]) for i in range(3)], axis=1)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(
        vertices=whole.vertices[whole.triangles.ravel()[first]],
        normals=normals / length,
        colors=np.clip(whole.colors.reshape(-1, 3)[first], 0.0, 1.0),
        triangles=vertex_of.reshape(-1, 3).astype(np.int32),
    )


def _corner_groups(whole: Shape, faces: Array) -> NDArray[np.int64]:
    """(3m,) for each corner the lowest corner that shares its vertex, across smooth edges only."""
    here, there = _smooth_edges(whole, faces)
    face, k = np.divmod(here, 3)
    face2, k2 = np.divmod(there, 3)
    # The edge runs a→b in one face and b→a in the other.
    one = np.concatenate([here, 3 * face + (k + 1) % 3])
    two = np.concatenate([3 * face2 + (k2 + 1) % 3, there])
    label = np.arange(3 * len(faces))
    while True:
        low = np.minimum(label[one], label[two])
        new = label.copy()
        np.minimum.at(new, label[one], low)
        np.minimum.at(new, label[two], low)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def _smooth_edges(whole: Shape, faces: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners that begin the two directions of each edge across which shading runs on."""
    start, end = whole.triangles.ravel(), np.roll(whole.triangles, -1, axis=1).ravel()
    key = np.minimum(start, end) * len(whole.vertices) + np.maximum(start, end)
    order = np.argsort(key)
    pair = np.flatnonzero(key[order[1:]] == key[order[:-1]])
    here, there = order[pair], order[pair + 1]
    unit = faces / np.linalg.norm(faces, axis=1, keepdims=True)
    f, g = here // 3, there // 3
    smooth = (unit[f] * unit[g]).sum(axis=1) >= np.minimum(whole.crease[f], whole.crease[g])
    smooth &= start[here] == end[there]
    colors = whole.colors.reshape(-1, 3)
    following = np.roll(np.arange(len(start)).reshape(-1, 3), -1, axis=1).ravel()
    smooth &= (colors[here] == colors[following[there]]).all(axis=1)
    smooth &= (colors[following[here]] == colors[there]).all(axis=1)
    return here[smooth], there[smooth]
