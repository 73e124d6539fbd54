"""Bodies: soft unions of limbs and lumps, meshed with surface nets.

The field is a signed distance blended with a polynomial smooth minimum (Quilez, "Smooth minimum"),
each part evaluated only near itself; the mesh has one vertex in each cell the surface crosses, at
the mean of the crossings on the cell's edges (Gibson 1998, "Constrained elastic surface nets").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats
from seethrough.renderer.models.forms.shapes import Color, Shape, shape

Field = NDArray[np.float32]
Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Limb:
    """A rounded bar from a to b whose radius runs from ra to rb; a ball where a == b.

    `flat` (3,) stretches the cross-section along the axes, `soft` is how far the joint to the
    other parts reaches, in world units.
    """

    a: Point
    b: Point
    ra: float
    rb: float
    color: Color
    flat: Point = (1.0, 1.0, 1.0)
    soft: float = 0.05


def chain(
    points: Sequence[Point] | Floats,
    radii: Sequence[float] | Floats,
    color: Color,
    soft: float = 0.05,
    flat: Point = (1.0, 1.0, 1.0),
) -> list[Limb]:
    """Limbs that join the points (k, 3) one after the other."""
    at = [(float(x), float(y), float(z)) for x, y, z in points]
    return [
        Limb(at[i], at[i + 1], radii[i], radii[i + 1], color, flat, soft)
        for i in range(len(at) - 1)
    ]


def body(limbs: Sequence[Limb], cell: float) -> Shape:
    """The closed surface of the soft union, on a grid of cells of the width `cell`."""
    reach = np.array([max(limb.ra, limb.rb) for limb in limbs])[:, None]
    flat = np.array([limb.flat for limb in limbs])
    margin = np.array([limb.soft for limb in limbs])[:, None] + 2 * cell
    ends = np.array([[limb.a, limb.b] for limb in limbs])
    low = ends.min(axis=1) - reach * flat - margin
    high = ends.max(axis=1) + reach * flat + margin
    origin = low.min(axis=0)
    # A grid that is its own mirror image in x = 0 gives symmetric bodies symmetric meshes.
    origin[0] = -cell * np.ceil(max(-origin[0], high[:, 0].max()) / cell)
    count = np.ceil((high.max(axis=0) - origin) / cell).astype(int) + 2
    # Far enough outside that no part blends with the background.
    field = np.full(count, margin.max() + 2 * cell, np.float32)
    owner = np.zeros(count, np.int8)
    axes = [(origin[i] + cell * np.arange(count[i])).astype(np.float32) for i in range(3)]
    first = np.maximum(((low - origin) / cell).astype(int), 0)
    last = np.minimum(np.ceil((high - origin) / cell).astype(int) + 1, count)
    for i, limb in enumerate(limbs):
        part = tuple(slice(a, b) for a, b in zip(first[i], last[i], strict=True))
        near = _distance(limb, *(axis[s] for axis, s in zip(axes, part, strict=True)))
        old = field[part]
        np.copyto(owner[part], i, where=near < old)
        overlap = np.maximum(limb.soft - np.abs(old - near), 0)
        field[part] = np.minimum(old, near) - overlap * overlap * np.float32(0.25 / limb.soft)
    corner, triangles, cells = _surface_net(field)
    palette = np.array([limb.color for limb in limbs])
    colors = palette[owner.ravel()[cells]]
    return shape(origin + cell * corner, triangles, colors[triangles], sharp=180)


def _distance(limb: Limb, x: Field, y: Field, z: Field) -> Field:
    """Distance to a limb at the grid points, exact where `flat` is 1 and the radius constant."""
    flat = np.array(limb.flat)
    a, b = np.array(limb.a) / flat, np.array(limb.b) / flat
    along = (b - a).astype(np.float32)
    length2 = float(along @ along)
    px = (x / np.float32(flat[0]) - np.float32(a[0]))[:, None, None]
    py = (y / np.float32(flat[1]) - np.float32(a[1]))[:, None]
    pz = z / np.float32(flat[2]) - np.float32(a[2])
    d2 = px * px + (py * py + pz * pz)
    if length2 < 1e-12:
        return (np.sqrt(d2, out=d2) - np.float32(limb.ra)) * _step(flat)
    # |p − t·along|² = |p|² − t·(2 p·along − t·|along|²)
    dot = px * along[0] + (py * along[1] + pz * along[2])
    t = np.clip(dot * np.float32(1 / length2), 0, 1)
    dot *= 2
    dot -= t * np.float32(length2)
    dot *= t
    d2 -= dot
    np.maximum(d2, 0, out=d2)
    np.sqrt(d2, out=d2)
    t *= np.float32(limb.rb - limb.ra)
    d2 -= t
    d2 -= np.float32(limb.ra)
    d2 *= _step(flat)
    return d2


def _step(flat: Floats) -> np.float32:
    """Factor that keeps distances in a stretched space from exceeding the true ones."""
    return np.float32(flat.min())


CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
EDGES = np.array([[a, a | bit] for bit in (1, 2, 4) for a in range(8) if not a & bit])


def _surface_net(field: Field) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Vertices (n, 3) in cells, triangles (m, 3), and the flat index (n,) of each vertex's cell.

    The border of the field lies outside, so flat indices may run over the end of a row: the cells
    they reach by mistake are never crossed.
    """
    strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
    offsets = CORNERS @ strides
    flat = field.ravel()
    _close_diagonals(flat, strides)
    inside = flat < 0
    nearby = np.zeros(field.size - offsets[-1], np.int8)
    for offset in offsets:
        nearby += inside[offset : offset + len(nearby)]
    cells = np.flatnonzero(nearby & 7)  # neither none nor all of the eight corners
    value = flat[cells[:, None] + offsets].astype(float)
    one, two = value[:, EDGES[:, 0]], value[:, EDGES[:, 1]]
    crossed = (one < 0) != (two < 0)
    # Crossings close to a corner would make slivers.
    t = crossed * np.clip(one / np.where(crossed, one - two, 1), 0.05, 0.95)
    start = CORNERS[EDGES[:, 0]].astype(float)
    step = CORNERS[EDGES[:, 1]] - start
    mean = (crossed @ start + t @ step) / (crossed @ np.ones(12))[:, None]
    vertices = np.stack(np.unravel_index(cells, field.shape), axis=1) + mean
    number = np.empty(field.size, np.int64)
    number[cells] = np.arange(len(cells))
    return vertices, _net_faces(inside, number, strides), cells


def _close_diagonals(flat: Field, strides: NDArray[np.int64]) -> None:
    """Fill a corner of each grid square whose diagonals lie inside and outside.

    Two sheets of the surface would meet in one edge there, which then had four triangles.
    """
    depth = np.float32(-0.1) * flat.max()
    for _ in range(8):
        inside = flat < 0
        open_corners = []
        for u, v in zip(np.roll(strides, -1), np.roll(strides, -2), strict=True):
            a, b, c, d = (inside[s : len(inside) - u - v + s] for s in (0, u, v, u + v))
            at = np.flatnonzero((a == d) & (b == c) & (a != b))
            first = np.where(inside[at], at + u, at)
            second = np.where(inside[at], at + v, at + u + v)
            open_corners.append(np.where(flat[first] < flat[second], first, second))
        chosen = np.concatenate(open_corners)
        if not len(chosen):
            return
        flat[chosen] = depth


def _net_faces(
    inside: NDArray[np.bool_], number: NDArray[np.int64], strides: NDArray[np.int64]
) -> NDArray[np.int64]:
    """A quad, as two triangles, round each grid edge that crosses the surface."""
    faces = []
    for axis in range(3):
        along, u, v = (strides[(axis + i) % 3] for i in range(3))
        at = np.flatnonzero(inside[along:] != inside[:-along])
        outward = inside[at]
        a, c = number[at - u - v], number[at]
        b, d = number[at - v], number[at - u]
        b, d = np.where(outward, b, d), np.where(outward, d, b)
        faces += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    return np.concatenate(faces)
