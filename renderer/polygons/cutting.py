"""Kernels that cut fragments which lie on both sides of a plane (classification.py).

A fragment is a loop of corners in one long array of rows (x, y, z). A cut walks the loop once,
inserts the points where it crosses the plane, and links the chains of each side along the cut
line. So a concave polygon may fall into more than two pieces, and a triangle falls in the two ways
of LabBSP2010, figure 3. New points are computed from the edge's lower end (in x, then y, then z),
so that two neighbours cut their common edge at the very same point. What else corners carry is not
touched here: every row remembers the two rows it lies between, and `interpolate` follows up.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Real, Whole
from seethrough.renderer.polygons.classification import COUNT, PLANE, SOURCE, START, Pieces
from seethrough.renderer.polygons.predicates import (
    distance_row,
)


class Ring(NamedTuple):
    """A loop with its crossing points inserted, room for n: `corners` (n, 3), the rows each lies
    between `ends` (n, 2), at `between` (n,), its `side` (n,), and whether it is `fresh` (n,)."""

    corners: Floats
    ends: Whole
    between: Floats
    side: Whole
    fresh: Bools


@numba.njit(cache=True)
def cut(
    fragments: Whole,
    splitters: Whole,
    halves: bool,
    pieces: Pieces,
    planes: Floats,
    out: Whole,
) -> int:
    """Cut fragments by `planes` (m, 10); append to `pieces`, whose `used` is moved on.

    Corner signs must be those of `classify`. `out` (2, room) receives, for each piece, the position
    of its parent in `fragments` and its side (1 front, -1 back). With `halves`, pieces of four
    corners become two triangles. Returns the number of pieces.
    """
    shape, rows, edge, along, used = (
        pieces.shape, pieces.rows, pieces.edge, pieces.along, pieces.used
    )  # fmt: skip
    made = 0
    largest = 0
    for f in fragments:
        largest = max(largest, shape[f, COUNT])
    room = 2 * largest + 2
    ring = Ring(
        np.empty((room, 3)), np.empty((room, 2), np.int32), np.empty(room),
        np.empty(room, np.int8), np.empty(room, np.bool_),
    )  # fmt: skip
    ends, between, side = ring.ends, ring.between, ring.side
    first = np.empty(room, np.int64)
    last = np.empty(room, np.int64)
    follow = np.empty(room, np.int64)
    done = np.empty(room, np.bool_)
    loop = np.empty(2 * room, np.int64)
    for i in range(len(fragments)):
        f, s = fragments[i], splitters[i]
        size = _ring(f, pieces, planes[s], ring)
        for wanted in (1, -1):
            chains = _chains(size, side, wanted, first, last)
            _link(
                chains,
                first,
                last,
                ring.corners,
                planes[shape[f, SOURCE]],
                planes[s],
                wanted,
                follow,
            )
            done[:chains] = False
            for c in range(chains):
                if done[c]:
                    continue
                length = _loop(c, first, last, follow, done, size, loop)
                if length < 3:
                    continue
                parts, corners, turn = 1, length, 0
                if halves and length == 4:
                    parts, corners, turn = 2, 3, _shorter_diagonal(ring.corners, loop)
                for half in range(parts):
                    for k in range(corners):
                        at = loop[(turn + 2 * half + k) % length]
                        to = used[0] + k
                        for axis in range(3):
                            rows[to, axis] = ring.corners[at, axis]
                        edge[to, 0], edge[to, 1], along[to] = ends[at, 0], ends[at, 1], between[at]
                        pieces.fresh[to] = ring.fresh[at]
                    piece = used[1]
                    shape[piece, START], shape[piece, COUNT] = used[0], corners
                    shape[piece, SOURCE], shape[piece, PLANE] = shape[f, SOURCE], shape[f, PLANE]
                    pieces.parent[piece], pieces.cutter[piece] = f, s
                    used[0] += corners
                    used[1] += 1
                    out[0, made], out[1, made] = i, wanted
                    made += 1
    return made


@numba.njit()
def _ring(f: int, pieces: Pieces, plane: Floats, ring: Ring) -> int:
    """The loop of fragment f with its crossing points inserted; returns its length."""
    shape, rows, fresh, sign = pieces.shape, pieces.rows, pieces.fresh, pieces.sign
    size = 0
    begin, n = shape[f, START], shape[f, COUNT]
    for j in range(n):
        u = begin + j
        v = begin + (j + 1) % n
        for axis in range(3):
            ring.corners[size, axis] = rows[u, axis]
        ring.ends[size, 0], ring.ends[size, 1], ring.between[size] = u, u, 0.0
        ring.side[size] = sign[u]
        ring.fresh[size] = fresh[u]
        size += 1
        if sign[u] * sign[v] == -1:
            _crossing(rows, u, v, plane, ring, size)
            ring.side[size] = 0
            ring.fresh[size] = True
            size += 1
    return size


@numba.njit()
def _crossing(rows: Floats, u: int, v: int, plane: Floats, ring: Ring, at: int) -> None:
    """Where the edge from row u to row v meets the plane: the same point for v to u."""
    low, high = u, v
    for axis in range(3):
        if rows[u, axis] != rows[v, axis]:
            if rows[v, axis] < rows[u, axis]:
                low, high = v, u
            break
    a = abs(distance_row(plane, rows[low, 0], rows[low, 1], rows[low, 2]))
    b = abs(distance_row(plane, rows[high, 0], rows[high, 1], rows[high, 2]))
    t = a / (a + b) if a + b > 0.0 else 0.5
    for k in range(3):
        ring.corners[at, k] = rows[low, k] + t * (rows[high, k] - rows[low, k])
    ring.ends[at, 0], ring.ends[at, 1], ring.between[at] = low, high, t
    # On a plane across an axis the coordinate is known without rounding.
    for axis in range(3):
        if plane[3 + (axis + 1) % 3] == 0.0 and plane[3 + (axis + 2) % 3] == 0.0:
            ring.corners[at, axis] = plane[axis]


@numba.njit(cache=True)
def interpolate(column: Real, edge: Whole, along: Floats, inputs: int, values: Floats) -> None:
    """One attribute of all rows into `values`: the inputs' from `column`, then row by row."""
    for r in range(inputs):
        values[r] = column[r]
    for r in range(inputs, len(values)):
        low, high = values[edge[r, 0]], values[edge[r, 1]]
        values[r] = low + along[r] * (high - low)


@numba.njit()
def _chains(size: int, side: Whole, wanted: int, first: Whole, last: Whole) -> int:
    """Runs of corners on the wanted side; `first` and `last` are the corners on the line."""
    origin = 0
    while side[origin] == wanted:
        origin += 1
    chains = 0
    previous = origin
    inside = False
    for step in range(1, size + 1):
        here = (origin + step) % size
        if side[here] == wanted and not inside:
            first[chains] = previous
            inside = True
        elif side[here] != wanted and inside:
            last[chains] = here
            chains += 1
            inside = False
        previous = here
    return chains


@numba.njit()
def _link(
    chains: int,
    first: Whole,
    last: Whole,
    ring: Floats,
    own: Floats,
    plane: Floats,
    wanted: int,
    follow: Whole,
) -> None:
    """Which chain goes on where a chain meets the cut line.

    Along the line, with the wanted side on the left, chain ends and chain starts alternate; so
    sorted by position the i-th end belongs to the i-th start.
    """
    if chains == 1:
        follow[0] = 0
        return
    dx = wanted * (plane[4] * own[5] - plane[5] * own[4])
    dy = wanted * (plane[5] * own[3] - plane[3] * own[5])
    dz = wanted * (plane[3] * own[4] - plane[4] * own[3])
    ends = np.empty(chains)
    starts = np.empty(chains)
    for c in range(chains):
        e, s = last[c], first[c]
        ends[c] = (
            dx * (ring[e, 0] - own[0]) + dy * (ring[e, 1] - own[1]) + dz * (ring[e, 2] - own[2])
        )
        starts[c] = (
            dx * (ring[s, 0] - own[0]) + dy * (ring[s, 1] - own[1]) + dz * (ring[s, 2] - own[2])
        )
    for _ in range(chains):
        end, begin = 0, 0
        for c in range(1, chains):
            end = c if ends[c] < ends[end] else end
            begin = c if starts[c] < starts[begin] else begin
        follow[end] = begin
        ends[end], starts[begin] = np.inf, np.inf


@numba.njit()
def _loop(
    c: int, first: Whole, last: Whole, follow: Whole, done: Bools, size: int, loop: Whole
) -> int:
    """Corners of the piece that chain c belongs to; returns how many."""
    length = 0
    chain = c
    while not done[chain]:
        done[chain] = True
        at = first[chain]
        if length > 0 and loop[length - 1] == at:
            length -= 1
        while at != last[chain]:
            loop[length] = at
            length += 1
            at = (at + 1) % size
        loop[length] = at
        length += 1
        chain = follow[chain]
    if length > 1 and loop[0] == loop[length - 1]:
        length -= 1
    return length


@numba.njit()
def _shorter_diagonal(ring: Floats, loop: Whole) -> int:
    """Corner from which the shorter diagonal of four corners starts: 0 or 1."""
    squares = np.zeros(2)
    for d in range(2):
        for axis in range(3):
            squares[d] += (ring[loop[d], axis] - ring[loop[d + 2], axis]) ** 2
    return 0 if squares[0] <= squares[1] else 1
