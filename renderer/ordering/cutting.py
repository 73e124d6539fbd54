"""Kernels that sort fragments by a plane and cut those that lie on both sides.

A fragment is a loop of corners in one long array of rows (x, y, z, then the attributes). A cut
walks the loop once, inserts the points where it crosses the plane, and links the chains of each
side along the cut line. So a concave polygon may fall into more than two pieces, and a triangle
falls in the two ways of paper 001, figure 3. New points are computed from the edge's lower end
(in x, then y, then z), so that two neighbours cut their common edge at the very same point.
"""

from __future__ import annotations

import numba
import numpy as np

from renderer.ordering.predicates import ROUNDING, distance_row, filtered_side


@numba.njit(cache=True)
def classify(
    fragments,
    splitters,
    start,
    count,
    source,
    rows,
    fresh,
    planes,
    plane_of,
    slack,
    sign,
    code,
    open_,
):
    """Side of every corner, and of every fragment: 0 in the plane, 1 front, 2 back, 3 both.

    `open_` (2, total corners) receives row and position of what the filter leaves undecided;
    returns how many. Polygons of one plane lie on each other by name: a fragment's rounded
    corners aren't asked again. `slack` (m,) is each plane's, and `fresh` marks cut points, which
    are known to rounding only: nearer than that they are on a plane, lest neighbours that were
    cut together cut each other once more.
    """
    waiting = 0
    for i in range(len(fragments)):
        f, s = fragments[i], splitters[i]
        code[i] = 0
        if plane_of[source[f]] == plane_of[s]:
            continue
        plane = planes[s]
        for v in range(start[f], start[f] + count[f]):
            reach = slack[s]
            if fresh[v]:
                reach = max(reach, point_slack(rows[v, 0], rows[v, 1], rows[v, 2]))
            side = filtered_side(plane, rows[v, 0], rows[v, 1], rows[v, 2], reach)
            sign[v] = side
            if side == 1:
                code[i] |= 1
            elif side == -1:
                code[i] |= 2
            elif side == 2:
                open_[0, waiting] = v
                open_[1, waiting] = i
                waiting += 1
    return waiting


@numba.njit(inline="always")
def point_slack(x, y, z):
    """What rounding a cut point costs: a distance."""
    return ROUNDING * max(abs(x), abs(y), abs(z))


@numba.njit(cache=True)
def cut(
    fragments, splitters, halves, start, count, source, rows, fresh, planes, sign, used, parent,
    cutter, out,
):  # fmt: skip
    """Cut fragments by planes; append the pieces. Corner signs must be those of `classify`.

    `used` (2,) counts rows and fragments and is moved on. `out` (2, room) receives, for each
    piece, the position of its parent in `fragments` and its side (1 front, -1 back). With
    `halves`, pieces of four corners become two triangles. Returns the number of pieces.
    """
    made = 0
    width = rows.shape[1]
    largest = 0
    for f in fragments:
        largest = max(largest, count[f])
    room = 2 * largest + 2
    ring = np.empty((room, width))
    side = np.empty(room, np.int8)
    young = np.empty(room, np.bool_)
    first = np.empty(room, np.int64)
    last = np.empty(room, np.int64)
    follow = np.empty(room, np.int64)
    done = np.empty(room, np.bool_)
    loop = np.empty(2 * room, np.int64)
    for i in range(len(fragments)):
        f, s = fragments[i], splitters[i]
        size = _ring(f, s, start, count, rows, fresh, planes, sign, ring, side, young)
        for wanted in (1, -1):
            chains = _chains(size, side, wanted, first, last)
            _link(chains, first, last, ring, planes[source[f]], planes[s], wanted, follow)
            done[:chains] = False
            for c in range(chains):
                if done[c]:
                    continue
                length = _loop(c, first, last, follow, done, size, loop)
                if length < 3:
                    continue
                if halves and length == 4:
                    turn = _shorter_diagonal(ring, loop)
                    for half in range(2):
                        for k in range(3):
                            corner = loop[(turn + (2 * half + k) % 4) % 4]
                            _copy(rows, used[0] + k, ring, corner)
                            fresh[used[0] + k] = young[corner]
                        made = _append(
                            3,
                            f,
                            s,
                            i,
                            wanted,
                            start,
                            count,
                            source,
                            used,
                            parent,
                            cutter,
                            out,
                            made,
                        )
                else:
                    for k in range(length):
                        _copy(rows, used[0] + k, ring, loop[k])
                        fresh[used[0] + k] = young[loop[k]]
                    made = _append(
                        length,
                        f,
                        s,
                        i,
                        wanted,
                        start,
                        count,
                        source,
                        used,
                        parent,
                        cutter,
                        out,
                        made,
                    )
    return made


@numba.njit(inline="always")
def _append(length, f, s, i, wanted, start, count, source, used, parent, cutter, out, made):
    piece = used[1]
    start[piece] = used[0]
    count[piece] = length
    source[piece] = source[f]
    parent[piece] = f
    cutter[piece] = s
    used[0] += length
    used[1] += 1
    out[0, made] = i
    out[1, made] = wanted
    return made + 1


@numba.njit
def _ring(f, s, start, count, rows, fresh, planes, sign, ring, side, young):
    """The loop with its crossing points inserted; returns its length."""
    size = 0
    begin, n = start[f], count[f]
    for j in range(n):
        u = begin + j
        v = begin + (j + 1) % n
        _copy(ring, size, rows, u)
        side[size] = sign[u]
        young[size] = fresh[u]
        size += 1
        if sign[u] * sign[v] == -1:
            _crossing(rows, u, v, planes[s], ring, size)
            side[size] = 0
            young[size] = True
            size += 1
    return size


@numba.njit(inline="always")
def _copy(into, at, rows, row):
    # Element by element: numba takes seconds to compile the assignment of a row.
    for k in range(rows.shape[1]):
        into[at, k] = rows[row, k]


@numba.njit
def _crossing(rows, u, v, plane, ring, at):
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
    for k in range(rows.shape[1]):
        ring[at, k] = rows[low, k] + t * (rows[high, k] - rows[low, k])
    # On a plane across an axis the coordinate is known without rounding.
    for axis in range(3):
        if plane[3 + (axis + 1) % 3] == 0.0 and plane[3 + (axis + 2) % 3] == 0.0:
            ring[at, axis] = plane[axis]


@numba.njit
def _chains(size, side, wanted, first, last):
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


@numba.njit
def _link(chains, first, last, ring, own, plane, wanted, follow):
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


@numba.njit
def _loop(c, first, last, follow, done, size, loop):
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


@numba.njit
def _shorter_diagonal(ring, loop):
    """Corner from which the shorter diagonal of four corners starts: 0 or 1."""
    squares = np.zeros(2)
    for d in range(2):
        for axis in range(3):
            squares[d] += (ring[loop[d], axis] - ring[loop[d + 2], axis]) ** 2
    return 0 if squares[0] <= squares[1] else 1
