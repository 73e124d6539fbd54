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
from seethrough.renderer.masks.silhouettes import Topology

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
    _skirt(pixels, way, starts, meets, reach, straight, out)
    for row in range(tile[3]):  # what the skirt put in are squares
        for column in range(tile[2]):
            if out[row, column] > 0:
                out[row, column] = np.sqrt(out[row, column])
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


@njit(cache=True, nogil=True)
def _straight(
    pixels: Floats, points: Ints, base: int, size: int, i: int, j: int, slack: float
) -> bool:
    """Whether the points between i and j of a walk lie along the way, and hardly beside it."""
    ax, ay = pixels[points[base + i], 0], pixels[points[base + i], 1]
    b = points[base + j % size]
    dx, dy = pixels[b, 0] - ax, pixels[b, 1] - ay
    length = np.sqrt(dx * dx + dy * dy)
    if length == 0:
        return False
    dx, dy = dx / length, dy / length
    last = 0.0
    for v in range(i + 1, j):
        x, y = pixels[points[base + v], 0] - ax, pixels[points[base + v], 1] - ay
        along = x * dx + y * dy
        if along < last - slack or along > length + slack or abs(x * dy - y * dx) > slack:
            return False
        last = max(last, along)
    return True


@njit(cache=True, nogil=True)
def _stretches(
    pixels: Floats, points: Ints, base: int, size: int, meets: Bools, slack: float, ends: Ints
) -> int:
    """Where the nearly straight stretches of a walk end, into `ends`; returns how many."""
    n = i = 0
    while i < size:
        j = i + 1
        while j < size and j - i < 48 and not meets[points[base + j]]:
            if not _straight(pixels, points, base, size, i, j + 1, slack):
                break
            j += 1
        ends[n] = j
        n += 1
        i = j
    return n


@njit(cache=True, nogil=True)
def _hidden(px: float, py: float, qx: float, qy: float, out: Floats32) -> bool:
    """Whether the target covers every pixel about a stretch: then a pixel beside the target has
    a nearer piece of the outline."""
    height, width = out.shape
    steps = 1 + int(min(np.sqrt((qx - px) ** 2 + (qy - py) ** 2), 1e6))
    for t in range(steps + 1):
        x, y = px + (qx - px) * t / steps, py + (qy - py) * t / steps
        if not (1 <= x < width - 1 and 1 <= y < height - 1):
            return False
        column, row = int(x), int(y)
        for r in range(row - 1, row + 2):
            for c in range(column - 1, column + 2):
                if out[r, c] >= 0:
                    return False
    return True


@njit(cache=True, nogil=True)
def _window(low: float, high: float, size: int) -> tuple[int, int]:
    """The pixels, of `size`, whose centres lie between two coordinates."""
    first = int(min(max(np.ceil(low - 0.5), 0.0), float(size)))
    return first, int(max(min(np.floor(high - 0.5) + 1.0, float(size)), 0.0))


@njit(cache=True, nogil=True)
def _beside(
    px: float, py: float, qx: float, qy: float, nx: float, ny: float, reach: float, out: Floats32
) -> None:
    """Squared distances of the pixels on the outer side (nx, ny) of a stretch from p to q."""
    height, width = out.shape
    ox, oy, length = nx * reach, ny * reach, np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
    first, last = _window(min(px, qx, px + ox, qx + ox), max(px, qx, px + ox, qx + ox), width)
    top, bottom = _window(min(py, qy, py + oy, qy + oy), max(py, qy, py + oy, qy + oy), height)
    for row in range(top, bottom):
        for column in range(first, last):
            x, y = column + 0.5 - px, row + 0.5 - py
            d = x * nx + y * ny
            along = x * ny - y * nx  # the stretch runs along (ny, −nx)
            if 0 <= d <= reach and -1e-9 <= along <= length + 1e-9 and d * d < out[row, column]:
                out[row, column] = d * d


@njit(cache=True, nogil=True)
def _about(
    px: float, py: float, ax: float, ay: float, bx: float, by: float, reach: float, out: Floats32
) -> None:
    """Squared distances of the pixels round a corner p from normal a to b, if it turns outwards;
    of all pixels round it where both are 0."""
    height, width = out.shape
    whole = ax == 0 and ay == 0
    if not whole and ax * by - ay * bx >= 0 and ax * bx + ay * by > -0.999999:
        return
    low_x, high_x, low_y, high_y = px - reach, px + reach, py - reach, py + reach
    cosine = ax * bx + ay * by
    if not whole and cosine > 0:  # a turn of less than a right angle lies in the tangents' hull
        mx, my = reach * (ax + bx) / (1 + cosine), reach * (ay + by) / (1 + cosine)
        low_x = px + min(0.0, ax * reach, bx * reach, mx)
        high_x = px + max(0.0, ax * reach, bx * reach, mx)
        low_y = py + min(0.0, ay * reach, by * reach, my)
        high_y = py + max(0.0, ay * reach, by * reach, my)
    first, last = _window(low_x, high_x, width)
    top, bottom = _window(low_y, high_y, height)
    for row in range(top, bottom):
        for column in range(first, last):
            x, y = column + 0.5 - px, row + 0.5 - py
            square = x * x + y * y
            # Beyond the stretch before, which runs along (ay, −ax), and before the one after.
            if square < out[row, column] and square <= reach * reach:
                if whole or (x * ay - y * ax >= -1e-9 and x * by - y * bx <= 1e-9):
                    out[row, column] = square


@njit(cache=True, nogil=True)
def _skirt(
    pixels: Floats,
    points: Ints,
    starts: Ints,
    meets: Bools,
    reach: float,
    slack: float,
    out: Floats32,
) -> None:
    """Put the square of the least distance into `out` for the pixels outside the walks.

    Beside each stretch and round each corner that turns outwards; all round where walks meet;
    nothing where the target covers both sides.
    """
    ends = np.empty(len(points) + 1, np.int64)
    normals = np.zeros((len(points) + 1, 2))
    shown = np.empty(len(points) + 1, np.bool_)
    for w in range(len(starts) - 1):
        base, size = starts[w], starts[w + 1] - starts[w]
        n = _stretches(pixels, points, base, size, meets, slack, ends)
        begin = 0
        for e in range(n):
            p, q = points[base + begin], points[base + ends[e] % size]
            begin = ends[e]
            px, py, qx, qy = pixels[p, 0], pixels[p, 1], pixels[q, 0], pixels[q, 1]
            length = np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
            nx = ny = 0.0
            if length > 0:
                nx, ny = -(qy - py) / length, (qx - px) / length
            normals[e, 0], normals[e, 1] = nx, ny
            shown[e] = not _hidden(px, py, qx, qy, out)
            if shown[e] and length > 0:
                _beside(px, py, qx, qy, nx, ny, reach, out)
        for e in range(n):
            after = (e + 1) % n
            if not (shown[e] or shown[after]):
                continue
            q = points[base + ends[e] % size]
            ax, ay, bx, by = normals[e, 0], normals[e, 1], normals[after, 0], normals[after, 1]
            if meets[q] or (ax == 0 and ay == 0) or (bx == 0 and by == 0):
                ax = ay = bx = by = 0.0
            _about(pixels[q, 0], pixels[q, 1], ax, ay, bx, by, reach, out)
