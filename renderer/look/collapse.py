"""Edges of a mesh collapsed one after the other, the cheapest first (Garland1997).

A collapse moves one corner onto the other end of an edge, so that what is left uses vertices that
were there, with their own normals and colours. Where vertices of one place differ (a sharp edge, a
border of colours), a corner moves along that line alone.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Ints

Vector = tuple[float, float, float]
TURN = 0.3  # least cosine between a triangle before and after a collapse: it may not turn over
MOST = 64  # triangles round a corner: one with more stays where it is


@njit(cache=True)
def _plane(quadric: Floats, normal: Vector, point: Floats) -> None:
    """Add the squared distance from a plane."""
    d = -(normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2])
    p = (normal[0], normal[1], normal[2], d)
    k = 0
    for i in range(4):
        for j in range(i, 4):
            quadric[k] += p[i] * p[j]
            k += 1


@njit(cache=True)
def _distance(a: Floats, b: Floats, x: Floats) -> float:
    """The sum of two quadrics at a point: no less than the farthest plane's distance, squared."""
    p = (x[0], x[1], x[2], 1.0)
    total, k = 0.0, 0
    for i in range(4):
        for j in range(i, 4):
            total += (a[k] + b[k]) * p[i] * p[j] * (1.0 if i == j else 2.0)
            k += 1
    return max(total, 0.0)


@njit(cache=True)
def _difference(a: Floats, b: Floats) -> Vector:
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])


@njit(cache=True)
def _upright(u: Vector, v: Vector) -> Vector:
    """Unit vector upright on two; zero where there is none."""
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    scale = 1.0 / length if length > 0 else 0.0
    return (n[0] * scale, n[1] * scale, n[2] * scale)


@njit(cache=True)
def _normal(a: Floats, b: Floats, c: Floats) -> Vector:
    """Unit normal of a triangle; zero where it has none."""
    return _upright(_difference(a, b), _difference(a, c))


@njit(cache=True)
def _quadrics(places: Floats, place_of: Ints, triangles: Ints, across: Ints) -> Floats:
    """(p, 10) of each place: planes of its triangles, and upright ones along edges that are seams:
    whose other side (`across` (m, 3), a corner 3 t + k, −1 for none) has other vertices."""
    quadrics = np.zeros((len(places), 10))
    for t in range(len(triangles)):
        at = (place_of[triangles[t, 0]], place_of[triangles[t, 1]], place_of[triangles[t, 2]])
        normal = _normal(places[at[0]], places[at[1]], places[at[2]])
        for k in range(3):
            _plane(quadrics[at[k]], normal, places[at[k]])
            a, b = at[k], at[(k + 1) % 3]
            there = across[t, k]
            if there >= 0:
                other, j = triangles[there // 3], there % 3
                if other[j] == triangles[t, (k + 1) % 3] and other[(j + 1) % 3] == triangles[t, k]:
                    continue
            upright = _upright(_difference(places[a], places[b]), normal)
            _plane(quadrics[a], upright, places[a])
            _plane(quadrics[b], upright, places[a])
    return quadrics


@njit(cache=True)
def _round(head: Ints, following: Ints, alive: Bools, place: int, found: Ints) -> int:
    """Put the corners of living triangles at a place into `found`; how many, −1 for too many."""
    count, c = 0, head[place]
    while c >= 0:
        if alive[c // 3]:
            if count == len(found):
                return -1
            found[count] = c
            count += 1
        c = following[c]
    return count


@njit(cache=True)
def _may(
    corners: Ints, others: Ints, u: int, v: int, places: Floats, place_of: Ints,
    triangles: Ints, turned: Ints,
) -> bool:  # fmt: skip
    """Whether place u may move onto v. `corners` are those at u, `others` at v; `turned` (k,) is
    filled with the vertex at v that each corner's becomes, −1 where its triangle goes."""
    going = 0
    for i in range(len(corners)):
        t = corners[i] // 3
        turned[i] = -2
        for k in range(3):
            if place_of[triangles[t, k]] == v:
                turned[i] = -1
                going += 1
    for i in range(len(corners)):
        if turned[i] == -1:
            continue
        t, k = corners[i] // 3, corners[i] % 3
        mine = triangles[t, k]
        for j in range(len(corners)):  # which vertex at v goes with mine
            s, e = corners[j] // 3, corners[j] % 3
            if turned[j] == -1 and triangles[s, e] == mine:
                for n in range(3):
                    if place_of[triangles[s, n]] == v:
                        if turned[i] >= 0 and turned[i] != triangles[s, n]:
                            return False
                        turned[i] = triangles[s, n]
        if turned[i] < 0:
            return False
        b, c = (
            places[place_of[triangles[t, (k + 1) % 3]]],
            places[place_of[triangles[t, (k + 2) % 3]]],
        )
        before, after = _normal(places[u], b, c), _normal(places[v], b, c)
        if before[0] * after[0] + before[1] * after[1] + before[2] * after[2] < TURN:
            return False
    shared = 0  # neighbours of both: as many as there are triangles to go, else sheets would meet
    for i in range(len(corners)):
        t, k = corners[i] // 3, corners[i] % 3
        one = place_of[triangles[t, (k + 1) % 3]]
        for j in range(len(others)):
            s, e = others[j] // 3, others[j] % 3
            if (
                one == place_of[triangles[s, (e + 1) % 3]]
                or one == place_of[triangles[s, (e + 2) % 3]]
            ):
                shared += 1
                break
    return 0 < going <= 2 and shared <= going


@njit(cache=True)
def collapsed(
    places: Floats, place_of: Ints, triangles: Ints, across: Ints, errors: Floats
) -> tuple[Ints, Ints]:
    """Triangles of all levels, one after the other, and where each level's begin (levels + 1,).

    places (p, 3); place_of (v,) of vertices; triangles (m, 3) of vertices; across (m, 3) the corner
    whose edge is the other side of each edge; errors (levels,) rising: how far planes of triangles
    may be from the corners that stand for theirs.
    """
    m = len(triangles)
    triangles = triangles.copy()
    quadrics = _quadrics(places, place_of, triangles, across)
    alive = np.ones(m, np.bool_)
    head, tail = np.full(len(places), -1), np.full(len(places), -1)
    following = np.full(3 * m, -1)
    for c in range(3 * m):
        p = place_of[triangles[c // 3, c % 3]]
        if head[p] < 0:
            head[p] = c
        else:
            following[tail[p]] = c
        tail[p] = c
    heap = [(0.0, 0, 0, 0)]
    heap.pop()
    most = errors[-1] ** 2
    for t in range(m):
        for k in range(3):
            if across[t, k] > 3 * t + k:
                continue  # the edge's other side has its turn
            a, b = place_of[triangles[t, k]], place_of[triangles[t, (k + 1) % 3]]
            for u, v in ((a, b), (b, a)):
                cost = _distance(quadrics[u], quadrics[v], places[v])
                if cost <= most:
                    heap.append((cost, u, v, 0))
    heapify(heap)
    stamp = np.zeros(len(places), np.int64)
    mine, others, turned = (
        np.empty(MOST, np.int64),
        np.empty(MOST, np.int64),
        np.empty(MOST, np.int64),
    )
    starts = np.zeros(len(errors) + 1, np.int64)
    found = np.empty((len(errors) * m, 3), np.int64)
    for level in range(len(errors)):
        while len(heap) and heap[0][0] <= errors[level] ** 2:
            cost, u, v, when = heappop(heap)
            if when != stamp[u] + stamp[v] or head[u] < 0 or head[v] < 0:
                continue
            n, o = (
                _round(head, following, alive, u, mine),
                _round(head, following, alive, v, others),
            )
            if n <= 0 or o <= 0:
                continue
            if not _may(mine[:n], others[:o], u, v, places, place_of, triangles, turned):
                continue
            for i in range(n):
                t, k = mine[i] // 3, mine[i] % 3
                if turned[i] == -1:
                    alive[t] = False
                else:
                    triangles[t, k] = turned[i]
            following[tail[v]] = head[u]
            tail[v] = tail[u]
            head[u] = -1
            quadrics[v] += quadrics[u]
            stamp[v] += 1
            n = _round(head, following, alive, v, mine)
            for i in range(max(n, 0)):
                t, k = mine[i] // 3, mine[i] % 3
                for step in (1, 2):
                    w = place_of[triangles[t, (k + step) % 3]]
                    for a, b in ((v, w), (w, v)):
                        cost = _distance(quadrics[a], quadrics[b], places[b])
                        if cost <= most:
                            heappush(heap, (cost, a, b, stamp[v] + stamp[w]))
        left = triangles[alive]
        starts[level + 1] = starts[level] + len(left)
        found[starts[level] : starts[level + 1]] = left
    return found[: starts[-1]].copy(), starts
