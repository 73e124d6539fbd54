"""How far each pixel lies from the outline of a closed mesh, without drawing the mesh.

Summed over the front-facing triangles, every edge inside the outline is run through once in each
direction; what is left over are directed loops, and how often they wind round a pixel says how
many front faces cover it (Stokes' theorem on the screen). Distances are Euclidean, to the outer
side of the loops: exact, and the work grows with the outline instead of with the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from seethrough.renderer.arrays import Bools, Floats, Floats32, Ints, Ints32
from seethrough.renderer.masks.rims import surround
from seethrough.renderer.masks.silhouettes import Topology

# Compiled code is kept on disk until this file changes: change it with the kernels of rims.py.
# Pixels by which an outline may be moved where short edges are joined to one: a mask of 10 pixels
# is off by at most 0.4 % there, and a colour by a step of 1/255.
STRAIGHT = 0.04
FAR = 60000.0  # where there is nothing within reach


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Which faces run through each edge: edge e (ends (e, 2)) has the entries first[e] to
    first[e + 1] of faces and signs (+1: from its first end to its second)."""

    ends: NDArray[np.int32]
    first: NDArray[np.int64]
    faces: NDArray[np.int32]
    signs: NDArray[np.int8]


class Solid(NamedTuple):
    """A mesh as its outlines are found: a Topology's points (v, 3) and planes (f, 4), HalfEdges."""

    points: Floats
    planes: Floats
    ends: Ints32
    first: Ints
    faces: Ints32
    signs: NDArray[np.int8]


class Pose(NamedTuple):
    """The eye (3,) in mesh space, and turn (3, 3) and move (3,): camera coordinates are
    turn · p + move."""

    eye: Floats
    turn: Floats
    move: Floats


def half_edges(shape: Topology) -> HalfEdges:
    """The directed edges of a mesh's faces, put together by edge."""
    starts = shape.faces.reshape(-1)
    stops = np.roll(shape.faces, -1, axis=1).reshape(-1)
    owner = np.repeat(np.arange(len(shape.faces)), 3)
    low, high = np.minimum(starts, stops), np.maximum(starts, stops)
    by_edge = np.lexsort((high, low))
    low, high, owner = low[by_edge], high[by_edge], owner[by_edge]
    signs = np.where(starts[by_edge] == low, 1, -1)
    new = np.ones(len(low), dtype=bool)
    new[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    first = np.append(np.nonzero(new)[0], len(low))
    ends = np.stack([low[new], high[new]], axis=1).astype(np.int32)
    return HalfEdges(ends, first, owner.astype(np.int32), signs.astype(np.int8))


def distances(
    shape: Topology,
    edges: HalfEdges,
    pose: Pose,
    lens: tuple[float, float, float],
    tile: tuple[int, int, int, int],
    reach: float,
    straight: float = STRAIGHT,
) -> NDArray[np.float32]:
    """Distance in pixels (height, width) from a target's outline, −1 on the target itself.

    Every point must lie in front of the eye. `lens`: the scale in pixels, and the picture's centre
    x, y. `tile`: left, top, width, height in pixels, what of the window to fill. Pixels farther
    than `reach` have FAR. Outlines may be moved by `straight` pixels.
    """
    solid = Solid(shape.points, shape.planes, edges.ends, edges.first, edges.faces, edges.signs)
    return outline_distances(solid, pose, np.array(lens), np.array(tile), reach, straight)


@njit(cache=True, nogil=True)
def outline_distances(
    solid: Solid, pose: Pose, lens: Floats, tile: Ints, reach: float, straight: float
) -> Floats32:
    """`distances` of arrays alone, for other kernels."""
    pixels, edges = _loops(solid, pose, lens)
    for v in range(len(pixels)):
        pixels[v, 0] -= tile[0]
        pixels[v, 1] -= tile[1]
    out = np.full((tile[3], tile[2]), FAR * FAR, np.float32)
    _cover(pixels, edges, out)
    way, starts, meets = _walks(edges, len(pixels))
    surround(pixels, way, starts, meets, reach, straight, out)
    flat = out.ravel()
    for k in range(len(flat)):  # what the skirt put in are squares; −1 stays
        root = np.sqrt(abs(flat[k]))
        flat[k] = root if flat[k] > 0 else flat[k]
    return out


@njit(cache=True, nogil=True)
def _cover(pixels: Floats, edges: Ints, out: Floats32) -> None:
    """Put −1 where the edges wind round a pixel's centre."""
    height, width = out.shape
    change = np.zeros((height, width + 1), np.int32)
    for e in range(len(edges)):
        ax, ay = pixels[edges[e, 0], 0], pixels[edges[e, 0], 1]
        bx, by = pixels[edges[e, 1], 0], pixels[edges[e, 1], 1]
        sign = 1
        if ay > by:
            ax, ay, bx, by, sign = bx, by, ax, ay, -1
        low, high = max(np.ceil(ay - 0.5), 0.0), min(np.ceil(by - 0.5), float(height))
        for row in range(int(min(low, float(height))), int(max(high, 0.0))):
            x = ax + (row + 0.5 - ay) / (by - ay) * (bx - ax)
            column = int(min(max(np.ceil(x - 0.5), 0.0), width))
            change[row, column] += sign
    for row in range(height):
        turns = 0
        for column in range(width):
            turns += change[row, column]
            if turns != 0:
                out[row, column] = -1.0


@njit(cache=True, nogil=True)
def _loops(solid: Solid, pose: Pose, lens: Floats) -> tuple[Floats, Ints]:
    points, planes, ends, first, faces, signs = solid
    eye, turn, move = pose
    front = np.empty(len(planes), np.bool_)
    for f in range(len(planes)):
        p = planes[f]
        front[f] = p[0] * eye[0] + p[1] * eye[1] + p[2] * eye[2] > p[3]
    mirrored = np.linalg.det(turn) < 0  # the loops then run the other way round on the screen
    found = np.empty((len(ends), 2), np.int64)
    pixels = np.empty((len(points), 2))
    known = np.zeros(len(points), np.bool_)
    k = 0
    for e in range(len(ends)):
        net = 0
        for h in range(first[e], first[e + 1]):
            if front[faces[h]]:
                net += signs[h]
        if net == 0:
            continue
        a, b = ends[e, 0], ends[e, 1]
        if (net < 0) != mirrored:
            a, b = b, a
        net = abs(net)
        for v in (a, b):
            if not known[v]:
                known[v] = True
                x, y, z = move[0], move[1], move[2]
                for i in range(3):
                    x += turn[0, i] * points[v, i]
                    y += turn[1, i] * points[v, i]
                    z += turn[2, i] * points[v, i]
                pixels[v, 0] = lens[1] - lens[0] * x / z
                pixels[v, 1] = lens[2] + lens[0] * y / z
        for _ in range(net):
            if k == len(found):
                bigger = np.empty((2 * k, 2), np.int64)
                bigger[:k] = found
                found = bigger
            found[k, 0], found[k, 1] = a, b
            k += 1
    return pixels, found[:k]


@njit(cache=True, nogil=True)
def _walks(edges: Ints, count: int) -> tuple[Ints, Ints, Bools]:
    """Closed walks that together take each directed edge (k, 2) once: points (k,), where each walk
    begins (w + 1,), and for each of `count` points whether it is met more than once."""
    n = len(edges)
    newest = np.full(count, -1, np.int64)
    older = np.empty(n, np.int64)
    leaves = np.zeros(count, np.int64)
    for e in range(n):
        older[e] = newest[edges[e, 0]]
        newest[edges[e, 0]] = e
        leaves[edges[e, 0]] += 1
    points, starts = np.empty(n, np.int64), np.empty(n + 1, np.int64)
    starts[0] = 0
    w = k = 0
    for e in range(n):
        here = edges[e, 0]
        begun = k
        while newest[here] >= 0:
            edge = newest[here]
            newest[here] = older[edge]
            points[k] = here
            k += 1
            here = edges[edge, 1]
            if here == points[begun]:
                break
        if k > begun:
            w += 1
            starts[w] = k
    return points, starts[: w + 1], leaves > 1
