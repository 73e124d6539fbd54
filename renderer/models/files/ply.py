"""PLY: text and binary of both byte orders; polygons, strips, colours and textures."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats, Numbers
from seethrough.renderer.models.files.part import (
    Found,
    Part,
    checked_colors,
    cut_polygons,
    grey,
    linear_rgba,
    too_many,
)
from seethrough.renderer.models.files.ply_table import Table, tables
from seethrough.renderer.models.files.source import Refused, Source
from seethrough.renderer.models.files.texture import decoded

INDICES = ("vertex_indices", "vertex_index", "vertexindices")
TEXTURE_AXES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


@dataclass(frozen=True, eq=False)
class _Corners:
    """Triangles as vertices (m, 3), and the face of each (m,) and its places there (m, 3)."""

    triangles: NDArray[np.int64]
    face: NDArray[np.int64]
    places: NDArray[np.int64]


def read(source: Source) -> Found:
    """The triangles of a PLY file. Raises Refused."""
    read_tables, pictures = tables(source.main())
    found = Found()
    vertex = read_tables.get("vertex")
    if vertex is None or not {"x", "y", "z"} <= set(vertex.columns):
        raise Refused("no vertices with x, y and z: expected a mesh")
    points = np.stack([vertex.columns[a].astype(float) for a in "xyz"], axis=1)
    faces = read_tables.get("face")
    strips = read_tables.get("tristrips") or read_tables.get("tristrip")
    corners = []
    if faces is not None:
        corners.append(_polygons(points, faces))
    if strips is not None:
        corners.append(_strips(strips, len(points)))
    if not corners or not sum(len(c.triangles) for c in corners):
        raise Refused(f"0 triangles: expected a mesh (it has {len(points)} points)")
    for kind in ("edge", "rangegrid", "range_grid"):
        if kind in read_tables:
            found.note(f"its {kind} entries are not shown")
    too_many(sum(len(c.triangles) for c in corners))
    for corner, table in zip(corners, (t for t in (faces, strips) if t is not None), strict=True):
        found.parts += _colored(points, corner, vertex, table, pictures, source, found)
    return found


def _polygons(points: Floats, faces: Table) -> _Corners:
    name = next((n for n in INDICES if n in faces.lists), None)
    if name is None:
        return _Corners(*(np.zeros((0, 3), np.int64), np.zeros(0, np.int64)), np.zeros((0, 3), int))
    counts, named = faces.lists[name]
    flat = named.astype(np.int64)
    _check(flat, len(points))
    starts = np.concatenate([[0], np.cumsum(counts)])
    if len(counts) and (counts == 3).all():
        rows = flat.reshape(-1, 3)
        return _Corners(rows, np.arange(len(rows)), np.tile(np.arange(3), (len(rows), 1)))
    too_many(int(np.maximum(counts - 2, 0).sum()))
    loops = [flat[a:b] for a, b in pairwise(starts)]
    triangles, owner = cut_polygons(points, loops)
    return _Corners(flat[triangles], owner, triangles - starts[owner][:, None])


def _strips(strips: Table, count: int) -> _Corners:
    """Triangles of strips: every other one is turned, and −1 begins a new strip."""
    name = next((n for n in INDICES if n in strips.lists), None)
    if name is None:
        raise Refused("strips without vertex_indices: expected a mesh")
    lengths, flat = strips.lists[name]
    ends = np.cumsum(lengths)
    triangles = []
    for begin, end in zip(ends - lengths, ends, strict=True):
        run = flat[begin:end]
        cuts = np.flatnonzero(run == -1)
        for strip in np.split(run, cuts):
            strip = strip[strip != -1]
            if len(strip) >= 3:
                rows = np.lib.stride_tricks.sliding_window_view(strip, 3).copy()
                rows[1::2] = rows[1::2, [1, 0, 2]]
                triangles.append(rows)
    rows = np.concatenate(triangles) if triangles else np.zeros((0, 3), np.int64)
    _check(rows.ravel(), count)
    return _Corners(rows, np.zeros(len(rows), np.int64), np.zeros_like(rows))


def _check(flat: NDArray[np.int64], count: int) -> None:
    wrong = flat[(flat < 0) | (flat >= count)]
    if len(wrong):
        raise Refused(
            f"a triangle names vertex {wrong[0]} of {count}: expected vertices the file has"
        )


def _colored(
    points: Floats,
    corners: _Corners,
    vertex: Table,
    table: Table,
    pictures: list[str],
    source: Source,
    found: Found,
) -> list[Part]:
    """The triangles with the colours of their corners or faces, a part for each texture."""
    own, of_face = _rgba(vertex, "vertex", found), _rgba(table, "face", found)
    uv = _places(vertex, corners, table)
    textured = bool(pictures) and uv is not None
    if own is not None:
        colors = own[corners.triangles]
        found.colors.add("vertices")
    elif of_face is not None:
        colors = np.repeat(of_face[corners.face][:, None], 3, axis=1)
        found.colors.add("triangles")
    elif textured:
        colors = np.ones((len(corners.triangles), 3, 4))
    else:
        colors = grey(len(corners.triangles))
        found.colors.add("none in the file: grey")
    if not textured or uv is None:
        if pictures:
            found.note(f"texture {pictures[0]!r} is not shown: no texture coordinates")
        return [Part(points, corners.triangles, colors)]
    found.colors.add("texture")
    number = table.columns.get("texnumber", np.zeros(max(len(table), 1), int))
    which = number.astype(np.int64)[corners.face]
    parts = []
    for k in np.unique(which):
        if not 0 <= k < len(pictures):
            raise Refused(f"a triangle names texture {k} of {len(pictures)}: expected one it has")
        name, mine = pictures[k], which == k
        texture = decoded(source.beside(name, "texture"), f"texture {name!r}", upward=True)
        parts.append(Part(points, corners.triangles[mine], colors[mine], uv[mine], texture))
    return parts


def _places(vertex: Table, corners: _Corners, table: Table) -> Floats | None:
    """(m, 3, 2) texture coordinates: of faces' corners, or else of vertices."""
    if "texcoord" in table.lists:
        counts, flat = table.lists["texcoord"]
        starts = np.concatenate([[0], np.cumsum(counts)])
        rows = starts[corners.face][:, None] + 2 * corners.places
        ends = starts[corners.face + 1][:, None]
        if len(flat) and (rows + 1 < ends).all():
            return np.stack([flat[rows], flat[rows + 1]], axis=2).astype(float)
    for u, v in TEXTURE_AXES:
        if u in vertex.columns and v in vertex.columns:
            pairs = np.stack([vertex.columns[u], vertex.columns[v]], axis=1).astype(float)
            return pairs[corners.triangles]
    return None


def _rgba(table: Table, what: str, found: Found) -> Floats | None:
    """(n, 4) linear colours of a table's rows, None where it has none."""
    for prefix in ("", "diffuse_"):
        names = [prefix + c for c in ("red", "green", "blue")]
        if all(n in table.columns for n in names):
            break
    else:
        names = ["r", "g", "b"]
        if not all(n in table.columns for n in names):
            return None
    shown = checked_colors(_scaled([table.columns[n] for n in names]), what)
    alpha = np.ones(len(shown))
    for name in ("alpha", "diffuse_alpha", "a"):
        if name in table.columns:
            column = _scaled([table.columns[name]])
            alpha = checked_colors(column, f"{what}, alpha,")[:, 0]
            break
    if ((alpha < 1) & (alpha > 0)).any():
        found.note("half transparent colours are shown opaque")
    return linear_rgba(np.clip(shown, 0, 1), np.clip(alpha, 0, 1))


def _scaled(columns: list[Numbers]) -> Floats:
    """(n, k) in 0 to 1: whole numbers by what their type holds, others up to 255 by that."""
    values = np.stack([c.astype(float) for c in columns], axis=1)
    kind = columns[0].dtype
    if kind.kind in "iu":
        return values / (255 if kind.itemsize != 2 else 65535)
    with np.errstate(invalid="ignore"):
        beyond = bool((values > 1.0).any() and np.nanmax(values) > 2.0)
    return values / 255 if beyond else values
