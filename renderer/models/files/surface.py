"""One surface of all parts of a file: joined at equal places, its outside out.

A closed part of the surface (each edge is run as often one way as the other) shows its outside.
What is open, or what no turning of triangles makes consistent, gets a second triangle for each,
turned round: only one of the two faces the eye, so nothing flickers, and nothing vanishes from
behind.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.files.part import Part
from seethrough.renderer.models.files.texture import Texture

_FLAT = 1e-9  # of its extent cubed: less volume has no inside


@dataclass(frozen=True, eq=False)
class Surface:
    """vertices (n, 3), no two at one place; triangles (m, 3); colors (m, 3, 4) linear RGBA and
    uv (m, 3, 2) of corners; texture (m,) which of `textures`, −1 for none; cutoff (m,)."""

    vertices: Floats
    triangles: NDArray[np.int64]
    colors: Floats
    uv: Floats
    texture: NDArray[np.int64]
    cutoff: Floats
    textures: tuple[Texture, ...]

    def take(self, rows: NDArray[np.int64] | NDArray[np.bool_]) -> Surface:
        """These triangles alone."""
        return replace(
            self,
            triangles=self.triangles[rows],
            colors=self.colors[rows],
            uv=self.uv[rows],
            texture=self.texture[rows],
            cutoff=self.cutoff[rows],
        )

    def turned(self, rows: NDArray[np.bool_]) -> Surface:
        """With the triangles `rows` (m,) turned round."""
        order = np.where(rows[:, None], (2, 1, 0), (0, 1, 2))
        corner = order[..., None]
        return replace(
            self,
            triangles=np.take_along_axis(self.triangles, order, 1),
            colors=np.take_along_axis(self.colors, corner, 1),
            uv=np.take_along_axis(self.uv, corner, 1),
        )


@dataclass(frozen=True)
class Sides:
    """What was done so that every side shows: how many triangles are part of a closed surface,
    were turned round, and got a second one for their back."""

    closed: int
    turned: int
    doubled: int


def joined(parts: list[Part]) -> Surface:
    """All parts as one surface, without triangles of no area and without the same one twice."""
    starts = np.cumsum([0, *(len(p.vertices) for p in parts)])
    corners = np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=False)])
    every = np.concatenate([p.vertices for p in parts])
    vertices, which = np.unique(every + 0.0, axis=0, return_inverse=True)  # no −0
    textures = tuple({id(p.texture): p.texture for p in parts if p.texture is not None}.values())
    number = {id(texture): i for i, texture in enumerate(textures)}
    counts = [len(p.triangles) for p in parts]
    none = [np.zeros((n, 3, 2)) for n in counts]
    whole = Surface(
        vertices=vertices,
        triangles=which.reshape(-1)[corners],
        colors=np.concatenate([p.colors for p in parts]),
        uv=np.concatenate([n if p.uv is None else p.uv for p, n in zip(parts, none, strict=True)]),
        texture=np.repeat([number.get(id(p.texture), -1) for p in parts], counts),
        cutoff=np.repeat([p.cutoff for p in parts], counts),
        textures=textures,
    )
    a, b, c = np.moveaxis(vertices[whole.triangles], 1, 0)
    extent = np.ptp(vertices, axis=0).max() if len(vertices) else 0.0
    size = extent if extent > 0 else 1.0
    area = np.linalg.norm(np.cross((b - a) / size, (c - a) / size), axis=1)
    # Relative to the extent, so that a model in millimetres is judged like one in kilometres.
    whole = whole.take(area > 1e-14)
    _, first = np.unique(_canonical(whole.triangles), axis=0, return_index=True)
    return whole.take(np.sort(first))


def _canonical(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Each triangle from its lowest vertex on, its direction kept."""
    first = triangles.argmin(axis=1, keepdims=True) if len(triangles) else triangles[:, :1]
    return np.take_along_axis(triangles, (first + np.arange(3)) % 3, 1)


def shown_from_outside(surface: Surface) -> tuple[Surface, NDArray[np.bool_], int]:
    """The surface with its triangles turned to one side in each connected part, outwards where
    that is closed; (m,) which lie in no closed part; how many were turned."""
    triangles = surface.triangles
    component, flip = _consistent(triangles)
    turned = surface.turned(flip)
    closed = _closed(turned.triangles, component)
    a, b, c = np.moveaxis(surface.vertices[turned.triangles], 1, 0)
    count = int(component.max(initial=-1)) + 1
    middle: Floats = np.stack([np.bincount(component, a[:, i], count) for i in range(3)], axis=1)
    middle /= np.maximum(np.bincount(component, minlength=count), 1)[:, None]
    at = middle[component]
    sixth = np.einsum("ij,ij->i", a - at, np.cross(b - at, c - at)) / 6
    volume = np.bincount(component, sixth, count)
    extent = np.ptp(surface.vertices, axis=0).max()
    inside_out = closed & (volume < -_FLAT * extent**3)
    again = inside_out[component]
    return turned.turned(again), ~closed[component], int((flip ^ again).sum())


def doubled(surface: Surface, both: NDArray[np.bool_]) -> tuple[Surface, NDArray[np.int64]]:
    """The surface with a turned copy of the triangles `both` (m,) behind them, and (k,) which
    were copied; what has one in the file already keeps that."""
    back = _canonical(surface.triangles[:, ::-1])
    n = len(surface.vertices) + 1
    codes = [(t[:, 0] * n + t[:, 1]) * n + t[:, 2] for t in (_canonical(surface.triangles), back)]
    rows = np.flatnonzero(both & ~np.isin(codes[1], codes[0]))
    copy = surface.take(rows).turned(np.ones(len(rows), bool))
    both_sides = replace(
        surface,
        triangles=np.concatenate([surface.triangles, copy.triangles]),
        colors=np.concatenate([surface.colors, copy.colors]),
        uv=np.concatenate([surface.uv, copy.uv]),
        texture=np.concatenate([surface.texture, copy.texture]),
        cutoff=np.concatenate([surface.cutoff, copy.cutoff]),
    )
    return both_sides, rows


def _edges(triangles: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """(3 m,) a number for each side's edge, and whether the side runs from its lower vertex."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    n = int(triangles.max(initial=0)) + 1
    return np.minimum(start, end) * n + np.maximum(start, end), start < end


def _consistent(triangles: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """(m,) the connected part of each triangle, over edges of two triangles; (m,) whether it is to
    be turned to agree with the most of its part, no more than needed.

    Each triangle stands twice in a graph, as it is and turned; sides that agree join equals,
    others join opposites. A part whose two copies are one graph has only one side (Möbius).
    """
    # Where it is called: it takes a third of a second, and most programs read no such file.
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    m = len(triangles)
    edge, upward = _edges(triangles)
    order = np.argsort(edge, kind="stable")
    same = np.concatenate([[False], edge[order][1:] == edge[order][:-1], [False]])
    pair = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])
    here, there = order[pair], order[pair + 1]
    f, g = here // 3, there // 3
    opposite = upward[here] == upward[there]  # both run the edge the same way: they disagree
    rows = np.concatenate([f, f + m])
    columns = np.concatenate([np.where(opposite, g + m, g), np.where(opposite, g, g + m)])
    graph = coo_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(2 * m, 2 * m))
    _, label = connected_components(graph, directed=False)
    plain, mirror = label[:m], label[m:]
    _, component = np.unique(np.minimum(plain, mirror), return_inverse=True)
    # Of the two copies of a part, the one in which more triangles stay as they are.
    stays = np.bincount(label[:m], minlength=int(label.max(initial=-1)) + 1)
    flip = (stays[mirror] > stays[plain]) | ((stays[mirror] == stays[plain]) & (mirror < plain))
    return component.reshape(-1), flip & (plain != mirror)


def _closed(triangles: NDArray[np.int64], component: NDArray[np.int64]) -> NDArray[np.bool_]:
    """(parts,) whether each edge is run as often one way as the other in each part."""
    edge, upward = _edges(triangles)
    owner = np.repeat(component, 3)
    order = np.lexsort((edge, owner))
    edge, owner, way = edge[order], owner[order], np.where(upward, 1, -1)[order]
    new = np.ones(len(edge), bool)
    new[1:] = (edge[1:] != edge[:-1]) | (owner[1:] != owner[:-1])
    first = np.flatnonzero(new)
    sums = np.add.reduceat(way, first) if len(first) else way[:0]
    closed = np.ones(int(component.max(initial=-1)) + 1, bool)
    closed[owner[first][sums != 0]] = False
    return closed
