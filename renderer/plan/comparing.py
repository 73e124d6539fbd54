"""Which of two boxes lies before the other, by a plane between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats

if TYPE_CHECKING:
    from seethrough.renderer.plan.order import Placed

# A box that only touches another, to the accuracy of its coordinates, is separated from it.
TOUCH = 1e-9

Way: TypeAlias = tuple[float, float, float]

BEHIND, NEITHER, IN_FRONT, UNCERTAIN = -1, 0, 1, 2


@njit(cache=True)
def _along(x: float, y: float, z: float, sides: Floats, radius: Floats, i: int) -> float:
    """How far object i reaches from its centre along the unit direction (x, y, z)."""
    total = 0.0
    for k in range(3):
        total += abs(x * sides[i, k, 0] + y * sides[i, k, 1] + z * sides[i, k, 2])
    return min(total, radius[i])


@njit(cache=True)
def _try(way: Way, centers: Floats, sides: Floats, radius: Floats, i: int, j: int) -> int:
    """IN_FRONT, BEHIND or NEITHER if a plane across `way` separates i from j, else UNCERTAIN.

    Centres are relative to the eye.
    """
    x, y, z = way
    length = np.sqrt(x * x + y * y + z * z)
    if length < 1e-12:
        return UNCERTAIN
    x, y, z = x / length, y / length, z / length
    ci = x * centers[i, 0] + y * centers[i, 1] + z * centers[i, 2]
    cj = x * centers[j, 0] + y * centers[j, 1] + z * centers[j, 2]
    if ci < cj:
        ci, cj = -ci, -cj
    # Now i lies on the positive side; the eye is at 0.
    low = ci - _along(x, y, z, sides, radius, i)
    high = cj + _along(x, y, z, sides, radius, j)
    slack = TOUCH * (abs(ci) + abs(cj))
    if low < high - slack:
        return UNCERTAIN
    if low <= slack:
        return IN_FRONT
    if high >= -slack:
        return BEHIND
    return NEITHER


@njit(cache=True)
def _across(
    centers: Floats, sides: Floats, radius: Floats, i: int, j: int
) -> tuple[int, float, float, float]:
    """What the first plane between i and j that separates them says of i, and across which way it
    lies; UNCERTAIN if none does."""
    x, y, z = (
        centers[i, 0] - centers[j, 0], centers[i, 1] - centers[j, 1], centers[i, 2] - centers[j, 2]
    )  # fmt: skip
    found = _try((x, y, z), centers, sides, radius, i, j)
    for k in range(6):
        if found != UNCERTAIN:
            return found, x, y, z
        o = i if k < 3 else j
        x, y, z = sides[o, k % 3, 0], sides[o, k % 3, 1], sides[o, k % 3, 2]
        found = _try((x, y, z), centers, sides, radius, i, j)
    # Sides are not at right angles under a shear: the faces' normals are the cross products.
    for k in range(15):
        if found != UNCERTAIN:
            return found, x, y, z
        o, p, u, v = i, j, k // 3, k % 3
        if k >= 9:
            o = p = i if k < 12 else j
            u, v = k % 3, (k + 1) % 3
        ax, ay, az = sides[o, u, 0], sides[o, u, 1], sides[o, u, 2]
        bx, by, bz = sides[p, v, 0], sides[p, v, 1], sides[p, v, 2]
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        found = _try((x, y, z), centers, sides, radius, i, j)
    return found, x, y, z


@njit(cache=True)
def compare(
    centers: Floats, sides: Floats, radius: Floats, near: Floats, far: Floats, i: int, j: int
) -> int:
    """Whether object i lies in front of object j wherever both show, as seen from the origin.

    Fields of a Placed one by one: as a record they would make `decide` a quarter slower.
    """
    if far[i] <= near[j]:
        return IN_FRONT
    if near[i] >= far[j]:
        return BEHIND
    return _across(centers, sides, radius, i, j)[0]


@njit(cache=True)
def turning(placed: Placed, known: float, i: int, j: int) -> tuple[float, float, bool]:
    """How far the eye is from where i, no target, begins or ceases to be in front of target j: from
    the plane between them, of which the first that separates their boxes counts, else one that is
    so far away as is `known`; in depth, from where one lies wholly behind the other; and whether no
    plane of their boxes separates them."""
    centers, near, far = placed.centers, placed.near, placed.far
    depth = min(abs(far[j] - near[i]), abs(far[i] - near[j]))
    found, x, y, z = _across(centers, placed.sides, placed.radius, i, j)
    if found == UNCERTAIN:
        return known, depth, True
    length = np.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    ci = x * centers[i, 0] + y * centers[i, 1] + z * centers[i, 2]
    cj = x * centers[j, 0] + y * centers[j, 1] + z * centers[j, 2]
    # Of i, which lies on the positive side: in front where the eye, at 0, lies beyond it.
    low = (-ci if ci < cj else ci) - _along(x, y, z, placed.sides, placed.radius, i)
    return abs(low), depth, False
