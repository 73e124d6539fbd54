"""Relations looked up when they are asked for, and the searches that ask (Chen1996).

The paper fills in whole rows of its one-way table. Most of a row is never needed: a plane that
cuts one polygon of a group is neither of absolute priority there nor separating, and stays so
until that polygon, its *witness*, leaves the group. So rows are looked at large polygons first
and only as far as the first cut, and go on from there when the witness is gone. What is found is
what whole rows would have shown.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Whole
from seethrough.renderer.polygons.classification import COUNT, START, corner_side


class Geometry(NamedTuple):
    """What relations are tested on: see `fragments.Fragments`.

    `row_of` (fragments,) is each one's plane; `tested` (1,) counts.
    """

    shape: Whole
    rows: Floats
    fresh: Bools
    planes: Floats
    corners: Floats
    slack: Floats
    row_of: Whole
    tested: Whole


COPLANAR, IN_FRONT, BEHIND, CUT = 0, 1, 2, 3
# A relation nobody asked for yet; one that only exact arithmetic can tell; a row without cuts.
UNKNOWN, OPEN, CLEAN = -1, -2, -1


@numba.njit(inline="always")
def _exact_side(corners: Floats, x: float, y: float, z: float) -> int:
    """Sides that need no arithmetic: the plane's own corners, and planes across an axis."""
    for k in range(3):
        if x == corners[k, 0] and y == corners[k, 1] and z == corners[k, 2]:
            return 0
    for axis in range(3):
        level = corners[0, axis]
        if level == corners[1, axis] and level == corners[2, axis]:
            value = x if axis == 0 else (y if axis == 1 else z)
            if value == level:
                return 0
    return 2


@numba.njit(cache=True)
def look(
    codes: Whole,
    r: int,
    f: int,
    geometry: Geometry,
) -> int:
    """Relation of fragment f to plane r: from the table, or tested and kept. May be OPEN."""
    code = codes[r, f]
    if code != UNKNOWN:
        return code
    code = 0
    if geometry.row_of[f] != r:
        rows, begin = geometry.rows, geometry.shape[f, START]
        for v in range(begin, begin + geometry.shape[f, COUNT]):
            side = corner_side(geometry.planes, geometry.slack, r, rows, geometry.fresh, v)
            if side == 2:
                side = _exact_side(geometry.corners[r], rows[v, 0], rows[v, 1], rows[v, 2])
            if side == 1:
                code |= 1
            elif side == -1:
                code |= 2
            elif side == 2:
                return OPEN
            if code == CUT:
                break
    geometry.tested[0] += 1
    codes[r, f] = code
    return code


@numba.njit(cache=True)
def first_usable(
    codes: Whole,
    group: Whole,
    by_size: Whole,
    witness: Whole,
    alive: Bools,
    geometry: Geometry,
) -> tuple[int, int]:
    """Position in `group` of the first polygon whose plane cuts none of the group, or -1.

    `witness` (rows,) is a polygon each plane is known to cut, or -1; `alive` (fragments,) says
    who is in the group; `by_size` is the group, large polygons first. Also returns a polygon
    whose relation to that plane is OPEN, or -1.
    """
    for i in range(len(group)):
        r = geometry.row_of[group[i]]
        if witness[r] >= 0 and alive[witness[r]]:
            continue
        cut = False
        for f in by_size:
            code = look(codes, r, f, geometry)
            if code == OPEN:
                return i, f
            if code == CUT:
                witness[r] = f
                cut = True
                break
        if not cut:
            return i, -1
    return -1, -1


@numba.njit(cache=True)
def clean_rows(
    codes: Whole,
    members: Whole,
    by_size: Whole,
    witness: Whole,
    alive: Bools,
    geometry: Geometry,
    open_: Whole,
) -> int:
    """Look at the planes `members` until each has cut something of the group or nothing at all.

    `open_` (2, members) receives the relations that are OPEN; returns how many. When none is,
    the planes without a living witness are clean.
    """
    waiting = 0
    for r in members:
        if witness[r] >= 0 and alive[witness[r]]:
            continue
        witness[r] = CLEAN
        for f in by_size:
            code = look(codes, r, f, geometry)
            if code == OPEN:
                open_[0, waiting], open_[1, waiting] = r, f
                waiting += 1
                break
            if code == CUT:
                witness[r] = f
                break
    return waiting


@numba.njit(cache=True)
def cheapest(
    codes: Whole,
    members: Whole,
    by_size: Whole,
    counts: Whole,
    place: Whole,
    weight: float,
    geometry: Geometry,
) -> tuple[int, int]:
    """Look at the planes `members` until the cheapest splitting plane is known.

    A plane costs its cuts less `weight` times the binary logarithm of the smaller side. The plane
    with the least that it can still cost is looked at further, to its next cut; when that is a
    plane looked at to the end, none is cheaper. `counts` (members, 3): in front, behind and cut
    so far; `place` (members,) how far it was looked at. Both are kept for a next call if a
    relation is OPEN: returns its plane and polygon, else -1 twice.
    """
    n = len(by_size)
    bound = np.empty(len(members))
    for i in range(len(members)):
        bound[i] = _least_cost(counts[i], n - place[i], weight)
    while True:
        best = 0
        for i in range(1, len(members)):
            if bound[i] < bound[best] or (
                bound[i] == bound[best] and place[best] == n and place[i] < n
            ):
                best = i
        if place[best] == n:
            return -1, -1
        r = members[best]
        while place[best] < n:
            f = by_size[place[best]]
            code = look(codes, r, f, geometry)
            if code == OPEN:
                return r, f
            place[best] += 1
            if code > 0:
                counts[best, code - 1] += 1
            if code == CUT:
                break
        bound[best] = _least_cost(counts[best], n - place[best], weight)


@numba.njit(inline="always")
def _least_cost(counts: Whole, left: int, weight: float) -> float:
    """What a plane costs at least, with so many polygons left to look at."""
    smaller = min(counts[0], counts[1]) + left
    smaller = min(smaller, (counts[0] + counts[1] + left) // 2)
    return counts[2] - weight * np.log2(1.0 + smaller)
