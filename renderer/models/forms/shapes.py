"""What models are put together from: closed surfaces with a colour on every corner.

Shapes stay unshaded until `shade` makes one Mesh of a whole model: only then are vertices split
where an edge is sharp or the colour changes, all parts at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.scene.geometry import Mesh

Color = tuple[float, float, float]

SHARP = 50.0
"""Degrees between the faces at an edge from which on the edge looks sharp."""


LONGEST_CHAIN = 127
"""Most triangles round a vertex with sharp edges: more than the sides of any cap or pole."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """vertices (n, 3); triangles (m, 3), counter-clockwise from outside; colors (m, 3, 3), one RGB
    for each corner; crease (m,) cosine of the angle from which on an edge is sharp."""

    vertices: Floats
    triangles: NDArray[np.int64]
    colors: Floats
    crease: Floats

    def at(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Shape:
        """Moved by (x, y, z)."""
        return replace(self, vertices=np.add(self.vertices, (x, y, z)))

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

    def bent(self, move: Callable[[Floats], Floats]) -> Shape:
        """With every vertex moved by `move`, (n, 3) to (n, 3)."""
        return replace(self, vertices=move(self.vertices))

    def painted(self, color: Color, where: Callable[[Floats], NDArray[np.bool_]]) -> Shape:
        """Whole triangles whose centroid (m, 3) lies `where` in another colour: a hard border."""
        chosen = where(self.vertices[self.triangles].mean(axis=1))
        return replace(self, colors=np.where(chosen[:, None, None], color, self.colors))

    def tinted(self, color: Color, amount: Callable[[Floats], Floats]) -> Shape:
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


def assemble(*shapes: Shape, size: float | None = None) -> Shape:
    """All shapes as one, standing on y = 0, its bounds centred at x = z = 0.

    Its longest side becomes `size` world units where that is given.
    """
    whole = join(*shapes)
    low, high = whole.vertices.min(axis=0), whole.vertices.max(axis=0)
    scale = 1.0 if size is None else size / (high - low).max()
    middle = np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2])
    return replace(whole, vertices=(whole.vertices - middle) * scale)


def shade(whole: Shape) -> Mesh:
    """The Mesh of a Shape where it stands, its vertices split at sharp edges and colour borders.

    Normals are means of the adjacent faces weighted by area, so that large flat faces stay flat
    beside rounded edges, and by angle, so that it does not matter how a quad is cut in two.
    """
    faces, angles = _areas_and_angles(whole)
    label = _vertex_corners(whole)
    color = _color_numbers(whole.colors)
    sharp = _sharp_vertices(whole, label, color)[whole.triangles]
    near = np.flatnonzero(sharp[:, 0] | sharp[:, 1] | sharp[:, 2])
    if len(near):
        corners = (3 * near[:, None] + np.arange(3)).ravel()
        group = corners[_corner_groups(_across_smooth_edges(whole, faces, color, near))]
        label[corners] = np.where(sharp[near].ravel(), group, label[corners])
    kept = label == np.arange(len(label))
    triangles = (np.cumsum(kept) - 1)[label]
    weights = (angles * faces[:, None].transpose(2, 0, 1)).reshape(3, -1)
    normals: Floats = np.stack([np.bincount(triangles, w) for w in weights], axis=1)
    return Mesh(
        vertices=whole.vertices[whole.triangles.ravel()[kept]],
        normals=normals / _lengths(normals)[:, None],
        colors=np.clip(whole.colors.reshape(-1, 3)[kept], 0.0, 1.0),
        triangles=triangles.reshape(-1, 3).astype(np.int32),
    )


def _areas_and_angles(whole: Shape) -> tuple[Floats, Floats]:
    """(m, 3) outward normals of the triangles, as long as twice their area; (m, 3) angles."""
    p = whole.vertices.T
    a, b, c = (p[:, corner] for corner in whole.triangles.T)
    u, v, w = b - a, c - b, a - c
    faces = np.stack([u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)], axis=1)
    dot = [u[0] * w[0], u[0] * v[0], v[0] * w[0]]
    for i in (1, 2):
        dot = [dot[0] + u[i] * w[i], dot[1] + u[i] * v[i], dot[2] + v[i] * w[i]]
    cosines = -np.stack(dot, axis=1)
    return faces, np.arctan2(_lengths(faces)[:, None], cosines)


def _lengths(vectors: Floats) -> Floats:
    """(n,) of (n, 3) vectors."""
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))


def _vertex_corners(whole: Shape) -> NDArray[np.int64]:
    """(3m,) for each corner the first corner at its vertex."""
    start = whole.triangles.ravel()
    first = np.empty(len(whole.vertices), np.int64)
    first[start[::-1]] = np.arange(len(start))[::-1]
    return first[start]


def _color_numbers(colors: Floats) -> NDArray[np.int64]:
    """(3m,) one whole number for each corner's colour (m, 3, 3), to the thousandth."""
    red, green, blue = (colors.reshape(-1, 3).T * 1023).astype(np.int64)
    return (red << 20) + (green << 10) + blue


def _sharp_vertices(
    whole: Shape, first: NDArray[np.int64], color: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """(n,) vertices of triangles that may have sharp edges or a colour border."""
    border = (color != color[first]).reshape(-1, 3)
    chosen = (whole.crease > -1) | border[:, 0] | border[:, 1] | border[:, 2]
    sharp = np.zeros(len(whole.vertices), bool)
    sharp[whole.triangles[chosen]] = True
    return sharp


def _across_smooth_edges(
    whole: Shape, faces: Floats, color: NDArray[np.int64], chosen: NDArray[np.int64]
) -> NDArray[np.int64]:
    """(3k,) for each corner of the chosen faces the next corner round its vertex, or itself where
    the edge is sharp.

    Corner 3f + k is vertex k of triangle f; its edge leads to vertex k + 1. The triangle on the
    other side of that edge runs it the other way, so its corner at our vertex follows that edge's
    own corner. Edges of other than two triangles count as sharp.
    """
    corners, crease = whole.triangles[chosen], whole.crease[chosen]
    start, end = corners.ravel(), corners[:, [1, 2, 0]].ravel()
    following = np.arange(len(start)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    key = np.minimum(start, end) * len(whole.vertices) + np.maximum(start, end)
    order = np.argsort(key)
    same = np.concatenate([[False], np.diff(key[order]) == 0, [False]])
    pair = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])
    here, there = order[pair], order[pair + 1]
    unit = (faces[chosen] / _lengths(faces[chosen])[:, None]).T
    f, g = here // 3, there // 3
    cosine = sum(unit[i][f] * unit[i][g] for i in range(3))
    smooth = cosine >= np.minimum(crease[f], crease[g])
    smooth &= start[here] == end[there]
    color = color.reshape(-1, 3)[chosen].ravel()
    here2, there2 = following[here], following[there]
    smooth &= (color[here] == color[there2]) & (color[here2] == color[there])
    onward = np.arange(len(start))
    onward[here[smooth]] = there2[smooth]
    onward[there[smooth]] = here2[smooth]
    return onward


def _corner_groups(onward: NDArray[np.int64]) -> NDArray[np.int64]:
    """(3m,) one corner to stand for all those that `onward` chains together.

    A chain either ends, and its end stands for it, or runs round the vertex, and its lowest corner
    does. Steps double in length, so rounds are the logarithm of the longest chain.
    """
    lowest, jump = np.arange(len(onward)), onward
    for _ in range(LONGEST_CHAIN.bit_length()):
        lowest = np.minimum(lowest, lowest[jump])
        jump = jump[jump]
    return np.where(onward[jump] == jump, jump, lowest)
