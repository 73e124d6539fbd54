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

from renderer.models.shapes import Array, Color, Shape, shape

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
    points: Sequence[Point], radii: Sequence[float], color: Color, soft: float = 0.05, **kw
) -> list[Limb]:
    """Limbs that join the points one after the other."""
    return [
        Limb(points[i], points[i + 1], radii[i], radii[i + 1], color, soft=soft, **kw)
        for i in range(len(points) - 1)
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
    count = np.ceil((high.max(axis=0) - origin) / cell).astype(int) + 2
    field = np.full(count, 4 * cell, np.float32)
    owner = np.zeros(count, np.int8)
    axes = [(origin[i] + cell * np.arange(count[i])).astype(np.float32) for i in range(3)]
    first = np.maximum(((low - origin) / cell).astype(int), 0)
    last = np.minimum(np.ceil((high - origin) / cell).astype(int) + 1, count)
    for i, limb in enumerate(limbs):
        part = tuple(slice(a, b) for a, b in zip(first[i], last[i], strict=True))
        near = _distance(limb, *(axis[s] for axis, s in zip(axes, part, strict=True)))
        old = field[part]
        owner[part][near < old] = i
        overlap = np.maximum(limb.soft - np.abs(old - near), 0)
        field[part] = np.minimum(old, near) - overlap * overlap * np.float32(0.25 / limb.soft)
    corner, triangles, cells = _surface_net(field)
    palette = np.array([limb.color for limb in limbs])
    colors = palette[owner[tuple(cells.T)]]
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
    if length2 < 1e-12:
        return (np.sqrt(px * px + py * py + pz * pz) - np.float32(limb.ra)) * _step(flat)
    t = (px * along[0] + py * along[1] + pz * along[2]) * np.float32(1 / length2)
    np.clip(t, 0, 1, out=t)
    d2 = (px - t * along[0]) ** 2
    d2 += (py - t * along[1]) ** 2
    d2 += (pz - t * along[2]) ** 2
    return (np.sqrt(d2) - (np.float32(limb.ra) + np.float32(limb.rb - limb.ra) * t)) * _step(flat)


def _step(flat: Array) -> np.float32:
    """Factor that keeps distances in a stretched space from exceeding the true ones."""
    return np.float32(flat.min())


CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
EDGES = np.array([[a, a | bit] for bit in (1, 2, 4) for a in range(8) if not a & bit])


def _surface_net(field: Field) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    """Vertices (n, 3) in cells, triangles (m, 3), and the cell (n, 3) each vertex lies in."""
    inside = field < 0
    nearby = np.zeros(np.array(field.shape) - 1, np.int8)
    for i, j, k in CORNERS:
        nearby += inside[i : i - 1 or None, j : j - 1 or None, k : k - 1 or None]
    cells = np.argwhere((nearby > 0) & (nearby < 8))
    number = np.full(nearby.shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    value = field[tuple((cells[:, None] + CORNERS).transpose(2, 0, 1))]
    one, two = value[:, EDGES[:, 0]], value[:, EDGES[:, 1]]
    crossed = (one < 0) != (two < 0)
    t = np.where(crossed, one / np.where(crossed, one - two, 1), 0)
    start, step = CORNERS[EDGES[:, 0]], CORNERS[EDGES[:, 1]] - CORNERS[EDGES[:, 0]]
    crossings = crossed[..., None] * (start + t[..., None] * step)
    vertices = cells + crossings.sum(axis=1) / crossed.sum(axis=1)[:, None]
    return vertices, _net_faces(inside, number), cells


def _net_faces(inside: NDArray[np.bool_], number: NDArray[np.int64]) -> NDArray[np.int64]:
    """A quad, as two triangles, round each grid edge that crosses the surface."""
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        low = inside.take(range(inside.shape[axis] - 1), axis)
        high = inside.take(range(1, inside.shape[axis]), axis)
        at = np.argwhere(low != high)
        outward = low[tuple(at.T)]
        around = []
        for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
            cell = at.copy()
            cell[:, u] += du
            cell[:, v] += dv
            around.append(number[tuple(cell.T)])
        quad = np.stack(around, axis=1)
        quad = np.where(outward[:, None], quad, quad[:, ::-1])
        faces += [quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]]
    return np.concatenate(faces)
