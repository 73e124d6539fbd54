"""Meshes as arrays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Points that are looked at in every frame, some nanoseconds each: vertices for which no hull is
# made (Qhull takes a quarter of a second to load, which standard frames of little things do
# without), and the most corners of a hull.
FEW, AROUND = 100, 500
# Which of its bounds a corner of a box has in x, y and z: corner k is high in x if k & 4, y 2, z 1.
CORNERS = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)])


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles with normals and colours, in the mesh's own frame (CONVENTIONS.md).

    vertices (n, 3) float64; normals (n, 3) float64, unit length; colors (n, 3) float64 in
    [0, 1]; triangles (m, 3) int32, counter-clockwise seen from outside. Scenes share meshes by
    identity, so the renderer draws all objects of one mesh in one instanced draw.
    """

    vertices: NDArray[np.float64]
    normals: NDArray[np.float64]
    colors: NDArray[np.float64]
    triangles: NDArray[np.int32]
    convex: bool = False

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3) lowest and highest corner."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @cached_property
    def center(self) -> NDArray[np.float64]:
        """(3,) centre of the bounds."""
        return self.bounds.mean(axis=0)

    @cached_property
    def hull(self) -> NDArray[np.float64]:
        """(k, 3) the vertices of the convex hull, all vertices where they lie in a plane."""
        return self.vertices[_hull(self.vertices, self.triangles)[0]]

    @cached_property
    def thin_hull(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(k, 3) corners of the hull, of many only those that reach farthest some way, and (e, 2)
        the rows of them between which edges run."""
        points = self.hull
        if len(points) > len(_WAYS):
            points = points[np.unique((points @ _WAYS.T).argmax(axis=0))]
        used, edges = _hull(points, np.zeros((0, 3), np.int64))
        return points[used], edges

    @cached_property
    def around(self) -> NDArray[np.float64]:
        """(k, 3) points whose convex hull holds the mesh: its vertices, or of many those of the
        hull, which fit closest wherever it is seen from; of too many the corners of its bounds."""
        places = np.unique(self.vertices, axis=0)
        if len(places) <= FEW:
            return places
        if len(self.hull) <= AROUND:
            return self.hull
        corners: NDArray[np.float64] = self.bounds[CORNERS, np.arange(3)]
        return corners

    @cached_property
    def closed(self) -> bool:
        """Whether it has an inside: each edge is run along as often one way as the other, corners
        at one place being one, as far as a millionth of its size tells."""
        size = max(float(np.ptp(self.bounds, axis=0).max()), 1e-300)
        places = np.round((self.vertices - self.bounds[0]) / size * 1e6).astype(np.int64)
        corner = np.unique(places, axis=0, return_inverse=True)[1].ravel()[self.triangles]
        edges = np.concatenate([corner[:, [k, (k + 1) % 3]] for k in range(3)])
        edges = edges[edges[:, 0] != edges[:, 1]]
        low, high = edges.min(axis=1), edges.max(axis=1)
        which = np.unique(np.stack([low, high], axis=1), axis=0, return_inverse=True)[1].ravel()
        turns = np.bincount(which, np.where(edges[:, 0] == low, 1.0, -1.0))
        return not turns.any()

    @cached_property
    def radius(self) -> float:
        """Radius of the sphere about `center` that holds every vertex."""
        return float(np.linalg.norm(self.vertices - self.center, axis=1).max())


def _ways(count: int) -> NDArray[np.float64]:
    """(count, 3) unit vectors spread over the sphere (a Fibonacci lattice)."""
    k = np.arange(count)
    z, turn = 1 - (2 * k + 1) / count, np.pi * (3 - 5**0.5) * k
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


_WAYS = _ways(32)


def _hull(
    points: NDArray[np.float64], faces: NDArray[np.integer]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of points (p, 3) that are corners of their hull, and (e, 2) between which of these its
    edges run, its faces cut into triangles. In a plane all are, with the edges of `faces` (m, 3).
    """
    from scipy.spatial import ConvexHull, QhullError

    used = np.arange(len(points))
    try:
        found = ConvexHull(points)
    except (QhullError, ValueError):
        pass
    else:
        used, faces = np.unique(found.vertices).astype(np.int64), found.simplices
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return used, np.searchsorted(used, np.unique(ends, axis=0)).astype(np.int64)


def _mesh(
    vertices: NDArray[np.float64],
    normals: NDArray[np.float64],
    triangles: ArrayLike,
    convex: bool,
) -> Mesh:
    """A white mesh; normals need not have unit length yet."""
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(
        np.asarray(vertices, float),
        normals / lengths,
        np.ones_like(vertices, dtype=float),
        np.asarray(triangles, dtype=np.int32),
        convex,
    )


def _check(**sizes: float) -> None:
    for name, value in sizes.items():
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value}, expected a size > 0")


def _check_segments(**counts: int) -> None:
    for name, value in counts.items():
        if value < 3:
            raise ValueError(f"{name} = {value}, expected at least 3")


def _circle(segments: int) -> NDArray[np.float64]:
    """(segments, 2) points (x, z) of the unit circle, from +x towards −z: left about +y."""
    angles = np.arange(segments) * (2 * np.pi / segments)
    return np.stack([np.cos(angles), -np.sin(angles)], axis=1)


def quad(width: float = 1.0, depth: float = 1.0) -> Mesh:
    """A rectangle about the origin in the plane y = 0, facing +y: x and z sizes."""
    _check(width=width, depth=depth)
    corners = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]) * [width / 2, 0, depth / 2]
    return _mesh(corners, np.tile([0.0, 1.0, 0.0], (4, 1)), [[0, 1, 2], [0, 2, 3]], True)


def box(width: float = 1.0, height: float = 1.0, depth: float = 1.0) -> Mesh:
    """A box about the origin (x, y, z sizes); each face has its own four vertices."""
    _check(width=width, height=height, depth=depth)
    vertices: list[NDArray[np.float64]] = []
    normals: list[NDArray[np.float64]] = []
    triangles: list[list[int]] = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            u = np.roll(np.array([1.0, 0.0, 0.0]), axis + 1)
            v = np.cross(normal, u)
            first = 4 * len(vertices)
            vertices.append(
                np.array([normal - u - v, normal + u - v, normal + u + v, normal - u + v])
            )
            normals.append(np.tile(normal, (4, 1)))
            triangles += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    corners = np.concatenate(vertices) * [width / 2, height / 2, depth / 2]
    return _mesh(corners, np.concatenate(normals), triangles, True)


def sphere(radius: float = 1.0, subdivisions: int = 2) -> Mesh:
    """A sphere about the origin: an icosahedron whose 20 faces are split in four, repeatedly.

    20 · 4^subdivisions triangles, every vertex on the sphere.
    """
    _check(radius=radius)
    if subdivisions < 0:
        raise ValueError(f"subdivisions = {subdivisions}, expected at least 0")
    g = (1 + 5**0.5) / 2
    plane = [(-1, g), (1, g), (-1, -g), (1, -g)]
    points = [(a, b, 0) for a, b in plane] + [(0, a, b) for a, b in plane]
    vertices = [np.array(p) / np.hypot(1, g) for p in points + [(b, 0, a) for a, b in plane]]
    faces = _icosahedron_faces(np.array(vertices))
    for _ in range(subdivisions):
        midpoints: dict[tuple[int, int], int] = {}

        def middle(i: int, j: int, midpoints: dict[tuple[int, int], int] = midpoints) -> int:
            key = (min(i, j), max(i, j))
            if key not in midpoints:
                point = vertices[i] + vertices[j]
                midpoints[key] = len(vertices)
                vertices.append(point / np.linalg.norm(point))
            return midpoints[key]

        split = [(a, b, c, middle(a, b), middle(b, c), middle(c, a)) for a, b, c in faces]
        faces = [
            t for a, b, c, d, e, f in split for t in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))
        ]
    unit = np.array(vertices)
    return _mesh(unit * radius, unit, faces, True)


def _icosahedron_faces(vertices: NDArray[np.float64]) -> list[tuple[int, int, int]]:
    """The 20 triples of mutually nearest vertices, counter-clockwise from outside."""
    apart = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    near = (apart > 0) & (apart < 1.1 * apart[apart > 0].min())
    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near[i, j] and near[j, k] and near[i, k]:
                    outward = np.linalg.det(vertices[[i, j, k]]) > 0
                    faces.append((i, j, k) if outward else (i, k, j))
    return faces


def cylinder(
    radius: float = 0.5, height: float = 1.0, segments: int = 16, top: float | None = None
) -> Mesh:
    """A cylinder about the origin, its axis along y; `top` is the upper radius (frustum, or 0).

    Smooth round the side, sharp at the rims.
    """
    _check(radius=radius, height=height)
    _check_segments(segments=segments)
    top = radius if top is None else top
    if not (np.isfinite(top) and top >= 0):
        raise ValueError(f"top = {top}, expected a radius ≥ 0")
    circle = _circle(segments)
    # A tip has one vertex for each side triangle, whose normal points along the middle of it.
    half = np.pi / segments
    turn = np.array([[np.cos(half), -np.sin(half)], [np.sin(half), np.cos(half)]])
    rounds = (circle, circle @ turn if top == 0 else circle)
    vertices, normals = [], []
    for circle_, level, size in zip(rounds, (-0.5, 0.5), (radius, top), strict=True):
        ring = np.insert(circle_ * size, 1, level * height, axis=1)
        vertices.append(ring)
        normals.append(np.insert(circle_ * height, 1, radius - top, axis=1))
    i = np.arange(segments)
    j = (i + 1) % segments
    triangles = [np.stack([i, j, segments + i], axis=1)]
    if top > 0:
        triangles.append(np.stack([j, segments + j, segments + i], axis=1))
    for level, size, sign in ((-0.5, radius, -1.0), (0.5, top, 1.0)):
        if size > 0:
            first = sum(len(v) for v in vertices)
            vertices.append(np.insert(circle * size, 1, level * height, axis=1))
            normals.append(np.tile([0.0, sign, 0.0], (segments, 1)))
            k = np.arange(1, segments - 1)
            fan = np.stack([np.zeros_like(k), k, k + 1][:: int(sign)], axis=1)
            triangles.append(first + fan)
    return _mesh(np.concatenate(vertices), np.concatenate(normals), np.concatenate(triangles), True)


def cone(radius: float = 0.5, height: float = 1.0, segments: int = 16) -> Mesh:
    """A cone about the origin, tip up (+y): half its height lies above y = 0."""
    return cylinder(radius, height, segments, top=0.0)


def torus(radius: float = 1.0, tube: float = 0.3, segments: int = 24, sides: int = 12) -> Mesh:
    """A torus about the origin in the plane y = 0: `radius` to the middle of its tube.

    2 · segments · sides triangles.
    """
    _check(radius=radius, tube=tube)
    _check_segments(segments=segments, sides=sides)
    around = _circle(segments)
    turn = np.arange(sides) * (2 * np.pi / sides)
    out, up = np.cos(turn), np.sin(turn)
    normals = np.empty((segments, sides, 3))
    normals[..., 0] = around[:, None, 0] * out
    normals[..., 1] = up
    normals[..., 2] = around[:, None, 1] * out
    vertices = tube * normals
    vertices[..., 0] += radius * around[:, None, 0]
    vertices[..., 2] += radius * around[:, None, 1]
    i, j = np.meshgrid(np.arange(segments), np.arange(sides), indexing="ij")
    a, b = i * sides + j, (i + 1) % segments * sides + j
    c, d = (i + 1) % segments * sides + (j + 1) % sides, i * sides + (j + 1) % sides
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    return _mesh(vertices.reshape(-1, 3), normals.reshape(-1, 3), triangles.reshape(-1, 3), False)


def transformed(mesh: Mesh, matrix: NDArray[np.float64]) -> Mesh:
    """The mesh moved by an invertible affine (4, 4) matrix (new frame ← mesh's frame).

    Normals go by the inverse transpose; a mirror turns the triangles round, so that they stay
    counter-clockwise from outside. Raises ValueError for a matrix that flattens the mesh.
    """
    linear = np.asarray(matrix, float)[:3, :3]
    volume = np.linalg.det(linear)
    if not np.isfinite(matrix).all() or abs(volume) <= 1e-300:
        raise ValueError("matrix flattens the mesh or is not finite, expected an invertible one")
    normals = mesh.normals @ np.linalg.inv(linear)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    triangles = mesh.triangles if volume > 0 else mesh.triangles[:, ::-1].copy()
    vertices = mesh.vertices @ linear.T + np.asarray(matrix, float)[:3, 3]
    return Mesh(vertices, normals, mesh.colors, triangles, mesh.convex)


def colored(mesh: Mesh, color: tuple[float, float, float]) -> Mesh:
    """The mesh in one colour. Raises ValueError for a colour outside [0, 1]."""
    value = np.asarray(color, float)
    if value.shape != (3,) or not ((value >= 0) & (value <= 1)).all():
        raise ValueError(f"color = {color}, expected three numbers from 0 to 1")
    return replace(mesh, colors=np.tile(value, (len(mesh.vertices), 1)))


def merged(*meshes: Mesh) -> Mesh:
    """One mesh of several. It counts as convex only if it is made of one that is."""
    if not meshes:
        raise ValueError("no meshes to merge, expected at least one")
    firsts = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    triangles = np.concatenate([m.triangles + f for m, f in zip(meshes, firsts, strict=True)])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.colors for m in meshes]),
        triangles.astype(np.int32),
        len(meshes) == 1 and meshes[0].convex,
    )
