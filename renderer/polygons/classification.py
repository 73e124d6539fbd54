"""On which side of a plane fragments lie; and the arrays that this and cutting.py share."""

from __future__ import annotations

from typing import NamedTuple

import numba

from seethrough.renderer.arrays import Bools, Floats, Whole
from seethrough.renderer.polygons.predicates import (
    ROUNDING,
    filtered_side,
    loop_heights,
    loop_limit,
)

# Columns of a fragment's shape.
START, COUNT, SOURCE, PLANE = 0, 1, 2, 3


class Pieces(NamedTuple):
    """Arrays of fragments (f) and of their corners (r), with room for more: see
    fragments.Fragments. A tuple, because compiled code takes it.

    Of fragments `shape` (f, 4), `parent` and `cutter` (f,). Of corners `rows` (r, 3); `edge` (r, 2)
    and `along` (r,), where cut points lie: on the way from one row to another, at `along`; `fresh`
    (r,), which those are; `sign` (r,), the side of each corner as `classify` left it. `used` (2,):
    how many rows and fragments there are.
    """

    shape: Whole
    rows: Floats
    fresh: Bools
    edge: Whole
    along: Floats
    sign: Whole
    parent: Whole
    cutter: Whole
    used: Whole


class Planes(NamedTuple):
    """Of each input polygon (m): the `rows` (m, 10) of its plane, its name `plane_of` (m,), which
    polygons of one plane share, and the `slack` (m,) within which a corner is on it."""

    rows: Floats
    plane_of: Whole
    slack: Floats


@numba.njit(cache=True)
def classify(
    fragments: Whole,
    splitters: Whole,
    pieces: Pieces,
    planes: Planes,
    code: Whole,
    open_: Whole,
) -> int:
    """Side of every corner, and of every fragment: 0 in the plane, 1 front, 2 back, 3 both.

    `open_` (2, room) receives row and position of what the filter leaves undecided; returns how
    many there are, of which only those that fit were written. Corner signs are kept for fragments
    on both sides, or with undecided corners. Polygons of one plane lie on each other by name: a
    fragment's rounded corners aren't asked again. Cut points are known to rounding only: nearer
    than that they are on a plane, lest neighbours that were cut together cut each other once more.
    """
    shape, rows, fresh, sign = pieces.shape, pieces.rows, pieces.fresh, pieces.sign
    slack, plane_of = planes.slack, planes.plane_of
    waiting = 0
    for i in range(len(fragments)):
        f, s = fragments[i], splitters[i]
        code[i] = 0
        if shape[f, PLANE] == plane_of[s]:
            continue
        first = shape[f, START]
        end = first + shape[f, COUNT]
        low, high, far = loop_heights(planes.rows[s], rows, first, end)
        limit = loop_limit(planes.rows[s], far, slack[s])
        if low > limit:
            code[i] = 1
            continue
        if high < -limit:
            code[i] = 2
            continue
        seen = 0
        for v in range(first, end):
            side = corner_side(planes.rows, slack, s, rows, fresh, v)
            seen |= 1 if side == 1 else (2 if side == -1 else (4 if side == 2 else 0))
        code[i] = seen & 3
        if seen < 3:
            continue
        for v in range(first, end):
            side = corner_side(planes.rows, slack, s, rows, fresh, v)
            sign[v] = side
            if side == 2:
                if waiting < open_.shape[1]:
                    open_[0, waiting] = v
                    open_[1, waiting] = i
                waiting += 1
    return waiting


@numba.njit(inline="always")
def corner_side(planes: Floats, slack: Floats, s: int, rows: Floats, fresh: Bools, v: int) -> int:
    """What the filter makes of a corner against a plane: see `predicates.filtered_side`."""
    x, y, z = rows[v, 0], rows[v, 1], rows[v, 2]
    reach = slack[s]
    if fresh[v]:
        reach = max(reach, point_slack(x, y, z))
    return filtered_side(planes[s], x, y, z, reach)


@numba.njit(inline="always")
def point_slack(x: float, y: float, z: float) -> float:
    """What rounding a cut point costs: a distance."""
    return ROUNDING * max(abs(x), abs(y), abs(z))
