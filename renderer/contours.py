"""The outline of any closed mesh as loops on the screen, and the triangles that make masks of it.

Summed over the front-facing triangles, every edge inside the outline is run through once in each
direction; what is left over are directed loops, and how often they wind round a pixel says how
many front faces cover it (Stokes' theorem on the screen). So triangles
that fill the loops, counted by their turn, cover the target, and they are far fewer than the mesh
has; a skirt on the outer side of the loops carries the distance (masks.py).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from renderer.silhouettes import Topology

# Pixels by which an outline may be moved where short edges are joined to one: a mask of 10 pixels
# is off by 0.3 % there, less than a step of 1/255.
STRAIGHT = 0.03
SMALL_TURN = 0.25  # radians: up to here one triangle is enough for a corner of the skirt
VERTEX = 8  # of a skirt: x, y in pixels, offset from the outline x, y, two probes x, y


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Which faces run through each edge: edge e (ends (e, 2)) has the entries first[e] to
    first[e + 1] of faces and signs (+1: from its first end to its second)."""

    ends: NDArray[np.int64]
    first: NDArray[np.int64]
    faces: NDArray[np.int64]
    signs: NDArray[np.int64]


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
    return HalfEdges(np.stack([low[new], high[new]], axis=1), first, owner, signs)


def loops(
    shape: Topology,
    edges: HalfEdges,
    eye: NDArray[np.float64],
    turn: NDArray[np.float64],
    move: NDArray[np.float64],
    lens: tuple[float, float, float],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Pixels (v, 2) of the mesh's points, and directed edges (k, 2) of the outline's loops.

    `eye` is in mesh space; camera coordinates are turn · p + move; `lens` is the scale in pixels
    and the picture's centre x, y. Every point must lie in front of the eye. The target lies to
    the left of an edge on the screen as one sees it. Points that no loop uses are not projected.
    """
    return _loops(
        shape.points, shape.planes, edges.ends, edges.first, edges.faces, edges.signs,
        eye, turn, move, np.array(lens),
    )  # fmt: skip


@njit(cache=True, nogil=True)
def _loops(points, planes, ends, first, faces, signs, eye, turn, move, lens):  # type: ignore[no-untyped-def]
    front = np.empty(len(planes), np.bool_)
    for f in range(len(planes)):
        p = planes[f]
        front[f] = p[0] * eye[0] + p[1] * eye[1] + p[2] * eye[2] > p[3]
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
        if net < 0:
            a, b, net = b, a, -net
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
def walks(edges, count):  # type: ignore[no-untyped-def]
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
def winding(pixels, points, starts, out):  # type: ignore[no-untyped-def]
    """Triangles (3 rows each of out (v, 2)) that turn as often round a pixel as the walks do.

    Each walk is halved again and again, so that most triangles are small. Returns the rows.
    """
    k = 0
    stack = np.empty((64, 2), np.int64)
    for w in range(len(starts) - 1):
        base, size = starts[w], starts[w + 1] - starts[w]
        stack[0, 0], stack[0, 1] = 0, size
        top = 1
        while top:
            top -= 1
            i, j = stack[top, 0], stack[top, 1]
            if j - i < 2:
                continue
            m = (i + j) // 2
            if not (i == 0 and j == size):
                for v in (i, m, j):
                    p = points[base + v % size]
                    out[k, 0], out[k, 1] = pixels[p, 0], pixels[p, 1]
                    k += 1
            stack[top, 0], stack[top, 1] = i, m
            stack[top + 1, 0], stack[top + 1, 1] = m, j
            top += 2
    return k


@njit(cache=True, nogil=True)
def _put(out, k, x, y, ox, oy, ax, ay, bx, by):  # type: ignore[no-untyped-def]
    out[k, 0], out[k, 1], out[k, 2], out[k, 3] = x, y, ox, oy
    out[k, 4], out[k, 5], out[k, 6], out[k, 7] = ax, ay, bx, by
    return k + 1


@njit(cache=True, nogil=True)
def _corner(out, k, px, py, ax, ay, bx, by, width):  # type: ignore[no-untyped-def]
    """A skirt round a corner from unit normal a to b, where it turns outwards."""
    turn = np.arctan2(ay * bx - ax * by, ax * bx + ay * by)
    if turn <= 0:
        return k
    pieces = 1 if turn < SMALL_TURN else int(np.ceil(turn / 0.8))
    reach = width / np.cos(turn / pieces / 2)
    ox, oy = ax * reach, ay * reach
    for t in range(pieces):
        angle = -turn * (t + 1) / pieces
        c, s = np.cos(angle), np.sin(angle)
        qx, qy = reach * (c * ax - s * ay), reach * (s * ax + c * ay)
        probe = (px + ax, py + ay, px + bx, py + by)
        k = _put(out, k, px, py, 0.0, 0.0, *probe)
        k = _put(out, k, px + ox, py + oy, ox, oy, *probe)
        k = _put(out, k, px + qx, py + qy, qx, qy, *probe)
        ox, oy = qx, qy
    return k


@njit(cache=True, nogil=True)
def _round(out, k, px, py, width):  # type: ignore[no-untyped-def]
    """A skirt all round a point where walks meet; never left out (its probes lie far apart)."""
    reach = width / np.cos(np.pi / 8)
    for t in range(8):
        k = _put(out, k, px, py, 0.0, 0.0, -1e4, 0.0, 1e4, 0.0)
        for side in (t, t + 1):
            ox, oy = reach * np.cos(side * np.pi / 4), reach * np.sin(side * np.pi / 4)
            k = _put(out, k, px + ox, py + oy, ox, oy, -1e4, 0.0, 1e4, 0.0)
    return k


@njit(cache=True, nogil=True)
def _straight(pixels, points, base, size, i, j):  # type: ignore[no-untyped-def]
    """Whether the points between i and j of a walk lie along the way, and hardly beside it."""
    ax, ay = pixels[points[base + i], 0], pixels[points[base + i], 1]
    b = points[base + j % size]
    dx, dy = pixels[b, 0] - ax, pixels[b, 1] - ay
    length = np.hypot(dx, dy)
    if length == 0:
        return False
    dx, dy = dx / length, dy / length
    last = 0.0
    for v in range(i + 1, j):
        x, y = pixels[points[base + v], 0] - ax, pixels[points[base + v], 1] - ay
        along = x * dx + y * dy
        if along < last or along > length or abs(x * dy - y * dx) > STRAIGHT:
            return False
        last = along
    return True


@njit(cache=True, nogil=True)
def _stretches(pixels, points, base, size, meets, ends):  # type: ignore[no-untyped-def]
    """Where the nearly straight stretches of a walk end, into `ends`; returns how many."""
    n = i = 0
    while i < size:
        j = i + 1
        while j < size and j - i < 48 and not meets[points[base + j]]:
            if not _straight(pixels, points, base, size, i, j + 1):
                break
            j += 1
        ends[n] = j
        n += 1
        i = j
    return n


@njit(cache=True, nogil=True)
def skirt(pixels, points, starts, meets, width, out):  # type: ignore[no-untyped-def]
    """The skirt outside the walks, into out (v, 8); returns the rows.

    A quad on the outer side of each stretch and a fan at each corner that turns outwards; a full
    round where walks meet. Pieces overlap: the least distance counts. A row is x, y, offset x, y,
    and two points a pixel outside the outline: a piece may be left out if the target covers them
    and the middle between them. `out` needs 48 rows for each point of the walks.
    """
    k = 0
    ends = np.empty(len(points) + 1, np.int64)
    normals = np.empty((len(points) + 1, 2))
    for w in range(len(starts) - 1):
        base, size = starts[w], starts[w + 1] - starts[w]
        n = _stretches(pixels, points, base, size, meets, ends)
        begin = 0
        for e in range(n):
            p, q = points[base + begin], points[base + ends[e] % size]
            dx, dy = pixels[q, 0] - pixels[p, 0], pixels[q, 1] - pixels[p, 1]
            length = np.hypot(dx, dy)
            if length > 0:
                normals[e, 0], normals[e, 1] = -dy / length, dx / length
            else:
                normals[e, 0], normals[e, 1] = 0.0, 0.0
            begin = ends[e]
        begin = 0
        for e in range(n):
            p, q = points[base + begin], points[base + ends[e] % size]
            begin = ends[e]
            nx, ny = normals[e, 0], normals[e, 1]
            mx, my = normals[(e + 1) % n, 0], normals[(e + 1) % n, 1]
            px, py, qx, qy = pixels[p, 0], pixels[p, 1], pixels[q, 0], pixels[q, 1]
            whole = (nx == 0 and ny == 0) or (mx == 0 and my == 0)
            if nx != 0 or ny != 0:
                ox, oy = nx * width, ny * width
                probe = (px + nx, py + ny, qx + nx, qy + ny)
                k = _put(out, k, px, py, 0.0, 0.0, *probe)
                k = _put(out, k, qx, qy, 0.0, 0.0, *probe)
                k = _put(out, k, qx + ox, qy + oy, ox, oy, *probe)
                k = _put(out, k, px, py, 0.0, 0.0, *probe)
                k = _put(out, k, qx + ox, qy + oy, ox, oy, *probe)
                k = _put(out, k, px + ox, py + oy, ox, oy, *probe)
            if whole or meets[q]:
                k = _round(out, k, qx, qy, width)
            else:
                k = _corner(out, k, qx, qy, nx, ny, mx, my, width)
    return k
