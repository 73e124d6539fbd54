"""Who is drawn before whom: which box lies before which, and where that is in doubt.

Two objects whose boxes (or spheres) a plane separates have an order that holds at every pixel:
the one on the eye's side is in front. The planes tried are those of the separating-axis test.
Where none separates them, a plane between their hulls may (separation.py); else the pair is said to
be uncertain, and of a target and something else the target counts as behind: what is drawn after it
is hidden by depth wherever it lies behind, while a target drawn after what is transparent there
would be lost. So does an impenetrable target beside another. Of other pairs the centres decide, in
a group its order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Ints, Signs
from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT, UNCERTAIN, compare

LITTLE = 0.1  # of a target: what may be lost without sorting pixels


class Placed(NamedTuple):
    """The n objects of a scene as the eye has them: `seen` (m,) are those to put in order, from far
    to near by their groups' centres; `extents` (n, 8) what each covers on the screen, its box and
    slants (Boxes), `reach` (n, 8) what its mask would; `centers` (n, 3) from the eye, `sides`
    (n, 3, 3) and `radius` (n,) of their boxes; `near` and `far` (n,) view depths; `targets` and
    `hard`, what is never penetrated, (n,). A tuple, because compiled code takes it."""

    seen: Ints
    extents: Floats
    reach: Floats
    centers: Floats
    sides: Floats
    radius: Floats
    near: Floats
    far: Floats
    targets: Bools
    hard: Bools


class Related(NamedTuple):
    """Who is drawn before whom: of objects `seen` (m,), with `extents` and `reach` (n, 8) as they
    are Placed, the `relation` (n, n) of each pair, and which of them are `blended` and `masked`
    (n,). See decide. A tuple, because compiled code takes it."""

    seen: Ints
    extents: Floats
    reach: Floats
    relation: Signs
    blended: Bools
    masked: Bools


@njit(cache=True)
def meet(a: Floats, i: int, b: Floats, j: int) -> bool:
    """Whether box i of `a` (n, 4) and box j of `b` overlap on the screen; their slants, in columns
    4 to 7 if there are any, as well."""
    for c in range(0, a.shape[1], 4):
        if a[i, c] > b[j, c + 2] or a[i, c + 2] < b[j, c]:
            return False
        if a[i, c + 1] > b[j, c + 3] or a[i, c + 3] < b[j, c + 1]:
            return False
    return True


@njit(cache=True)
def touching(boxes: Floats, size: tuple[int, int]) -> Bools:
    """(n,) which boxes (n, 4) reach into the picture."""
    found = np.empty(len(boxes), np.bool_)
    for i in range(len(boxes)):
        found[i] = boxes[i, 2] > 0 and boxes[i, 3] > 0
        found[i] = found[i] and boxes[i, 0] < size[0] and boxes[i, 1] < size[1]
    return found


@njit(cache=True)
def far_to_near(objects: Ints, group_of: Ints, depth: Floats) -> Ints:
    """Objects (m,), given in their order in the scene, the farthest group first by the depths (n,)
    of groups; of groups of one depth that of the lower number."""
    by_group = objects[np.argsort(group_of[objects], kind="mergesort")]
    return by_group[np.argsort(-depth[by_group], kind="mergesort")]


@njit(cache=True)
def near_each_other(placed: Placed) -> Ints:
    """(k, 2) places in the order, the nearer one first, of all whose boxes overlap on the screen:
    of targets what their masks can reach. Swept from left to right."""
    order, m = placed.seen, len(placed.seen)
    boxes = np.empty((m, placed.extents.shape[1]))
    for a in range(m):
        i = order[a]
        boxes[a] = placed.reach[i] if placed.targets[i] else placed.extents[i]
    rows = np.argsort(boxes[:, 0])
    found = np.empty((m * (m - 1) // 2, 2), np.int64)
    k = 0
    for p in range(m):
        a = rows[p]
        right = boxes[a, 2]
        for q in range(p + 1, m):
            b = rows[q]
            if boxes[b, 0] > right:
                break
            if meet(boxes, a, boxes, b):
                found[k, 0], found[k, 1] = max(a, b), min(a, b)
                k += 1
    return found[:k]


@njit(cache=True)
def decide(
    placed: Placed, pairs: Ints, blend: Bools, mask: Bools, known: Signs, by_center: bool
) -> tuple[Signs, Bools, Bools, Bools]:
    """relation (n, n) of each pair that matters, which of them are uncertain (n, n), and which
    objects blend and are masked (n,). `pairs` (k, 2) are near_each_other.

    Of those `seen` the order of groups' centres decides alone if `by_center`; those in `blend` (n,)
    blend in any case, those in `mask` (n,) are masked. relation[i, j] is 1 where i is drawn after
    j, −1 where before, 0 where it makes no difference; `known` (n, n) says so of pairs whose boxes
    no plane separates, and what it leaves UNCERTAIN is uncertain.
    """
    order, extents, reach = placed.seen, placed.extents, placed.reach
    targets, hard = placed.targets, placed.hard
    centers, sides, radius = placed.centers, placed.sides, placed.radius
    near, far = placed.near, placed.far
    n = len(extents)
    relation = np.zeros((n, n), np.int8)
    uncertain = np.zeros((n, n), np.bool_)
    blended, masked = blend.copy(), mask.copy()
    for both in range(2):  # first every object against the targets, then all that blend
        for a, b in pairs:
            i, j = order[a], order[b]  # j is farther by its centre
            if both:
                if not (blended[i] and blended[j]) or relation[i, j] != 0:
                    continue
            elif not (targets[i] or targets[j]):
                continue
            i_over_j = targets[j] and not hard[i] and meet(extents, i, reach, j)
            j_over_i = targets[i] and not hard[j] and meet(extents, j, reach, i)
            if not (meet(extents, i, extents, j) if both else i_over_j or j_over_i):
                continue
            found = IN_FRONT
            if not by_center:
                found = compare(centers, sides, radius, near, far, i, j)
                if found == UNCERTAIN:
                    found = known[i, j]
            doubt = found == UNCERTAIN
            if doubt:
                before = targets[i] and (not targets[j] or (hard[i] and not hard[j]))
                found = BEHIND if before else IN_FRONT
                uncertain[i, j] = uncertain[j, i] = True
            relation[i, j], relation[j, i] = found, -found
            if not both and i_over_j and (found == IN_FRONT or doubt):
                blended[i] = masked[j] = True
            if not both and j_over_i and (found == BEHIND or doubt):
                blended[j] = masked[i] = True
    return relation, uncertain, blended, masked


@njit(cache=True)
def overlapped(placed: Placed) -> Bools:
    """(n,) which targets' masks any penetrable object overlaps that is not wholly behind them.

    More than `decide` finds: beside its target a mask lies at the depth of the target's centre,
    and an object behind the target may come before that.
    """
    order, extents, reach = placed.seen, placed.extents, placed.reach
    near, far, targets, hard = placed.near, placed.far, placed.targets, placed.hard
    found = np.zeros(len(extents), np.bool_)
    for a in range(len(order)):
        for b in range(len(order)):
            i, s = order[a], order[b]
            if i != s and targets[s] and not hard[i] and near[i] < far[s]:
                found[s] |= meet(extents, i, reach, s)
    return found


def doubtful(
    related: Related, uncertain: Bools, broken: Bools, lost: Bools, size: Floats
) -> tuple[Floats, Bools]:
    """(k, 4) parts of the picture where the order of two objects is in doubt behind a mask, and of
    which of them (k,) a target may be lost: what is `lost` (n, n), and by what is `broken` (n, n),
    as levels.levels says it.

    Only where a mask reaches does the order show at all: elsewhere the depth buffer is exact.
    """
    found = np.flatnonzero(uncertain | broken | lost)  # in two dimensions it is slower
    return _doubtful(related, found, broken, lost, size)


@njit(cache=True)
def _doubtful(
    related: Related, places: Ints, broken: Bools, lost: Bools, size: Floats
) -> tuple[Floats, Bools]:
    """The same of the pairs at these places of a table (n, n), each counted once."""
    order, extents, reach = related.seen, related.extents, related.reach
    relation, blended, masked = related.relation, related.blended, related.masked
    n = len(extents)
    there = np.zeros(n, np.bool_)
    there[order] = True
    masks = order[masked[order]]
    pairs = np.empty(len(places), np.int64)
    for p in range(len(places)):
        a, b = places[p] // n, places[p] % n
        pairs[p] = max(a, b) * n + min(a, b)
    pairs.sort()
    found, must = np.empty((len(pairs), 4)), np.zeros(len(pairs), np.bool_)
    count = 0
    for p in range(len(pairs)):
        i, j = pairs[p] // n, pairs[p] % n
        if p > 0 and pairs[p] == pairs[p - 1]:
            continue
        if not (there[i] and there[j]) or not (blended[i] or blended[j]):
            continue
        low_x, high_x, low_y, high_y = np.inf, -np.inf, np.inf, -np.inf
        for s in masks:
            x0 = max(0.0, max(reach[s, 0], _low(extents, reach, i, j, s, 0)))
            y0 = max(0.0, max(reach[s, 1], _low(extents, reach, i, j, s, 1)))
            x1 = min(size[0], min(reach[s, 2], _high(extents, reach, i, j, s, 2)))
            y1 = min(size[1], min(reach[s, 3], _high(extents, reach, i, j, s, 3)))
            if x0 < x1 and y0 < y1:
                low_x, low_y = min(low_x, x0), min(low_y, y0)
                high_x, high_y = max(high_x, x1), max(high_y, y1)
        if low_x < high_x:
            found[count, 0], found[count, 1] = low_x, low_y
            found[count, 2], found[count, 3] = high_x, high_y
            must[count] = lost[i, j] or lost[j, i]
            behind = j if relation[i, j] == IN_FRONT else i
            if (broken[i, j] or broken[j, i]) and masked[behind]:
                must[count] |= _share(extents, i, j, behind) > LITTLE
            count += 1
    return found[:count], must[:count]


@njit(cache=True)
def _share(extents: Floats, i: int, j: int, k: int) -> float:
    """How much of object k's box lies where those of i and j overlap."""
    width = min(extents[i, 2], extents[j, 2]) - max(extents[i, 0], extents[j, 0])
    height = min(extents[i, 3], extents[j, 3]) - max(extents[i, 1], extents[j, 1])
    area = (extents[k, 2] - extents[k, 0]) * (extents[k, 3] - extents[k, 1])
    return max(width, 0.0) * max(height, 0.0) / max(area, 1e-9)


@njit(cache=True)
def _low(extents: Floats, reach: Floats, i: int, j: int, s: int, k: int) -> float:
    """Lower end of where i and j overlap; the mask itself counts as its target's extent."""
    a = reach[i, k] if i == s else extents[i, k]
    b = reach[j, k] if j == s else extents[j, k]
    return max(a, b)


@njit(cache=True)
def _high(extents: Floats, reach: Floats, i: int, j: int, s: int, k: int) -> float:
    a = reach[i, k] if i == s else extents[i, k]
    b = reach[j, k] if j == s else extents[j, k]
    return min(a, b)


@njit(cache=True)
def merge(boxes: Floats) -> Floats:
    """(k, 4) boxes that do not overlap, each about some of the given ones."""
    rows = boxes.copy()
    n = len(rows)
    moved = True
    while moved:
        moved = False
        i = 0
        while i < n:
            j = i + 1
            while j < n:
                a, b = rows[i], rows[j]
                if a[0] < b[2] and a[2] > b[0] and a[1] < b[3] and a[3] > b[1]:
                    rows[i, 0], rows[i, 1] = min(a[0], b[0]), min(a[1], b[1])
                    rows[i, 2], rows[i, 3] = max(a[2], b[2]), max(a[3], b[3])
                    n -= 1
                    rows[j] = rows[n]
                    moved = True
                else:
                    j += 1
            i += 1
    return rows[:n]


@njit(cache=True)
def hold(parts: Floats, boxes: Floats, triangles: Ints, worth: float) -> Floats:
    """(k, 4) parts, each widened to hold the (n, 4) boxes that reach into it whole, as long as
    that adds fewer than `worth` pixels for each of their `triangles` (n,)."""
    rows = parts.copy()
    for p in range(len(rows)):
        moved = True
        while moved:
            moved = False
            for i in range(len(boxes)):
                a, b = rows[p], boxes[i]
                if a[0] >= b[2] or a[2] <= b[0] or a[1] >= b[3] or a[3] <= b[1]:
                    continue
                left, top = min(a[0], b[0]), min(a[1], b[1])
                right, bottom = max(a[2], b[2]), max(a[3], b[3])
                added = (right - left) * (bottom - top) - (a[2] - a[0]) * (a[3] - a[1])
                if 0 < added < worth * triangles[i]:
                    rows[p, 0], rows[p, 1], rows[p, 2], rows[p, 3] = left, top, right, bottom
                    moved = True
    return rows


@njit(cache=True)
def apart(extents: Floats) -> Ints:
    """(n,) a set for each of the (n, 4) boxes so that those of one set nowhere overlap."""
    n = len(extents)
    which = np.full(n, -1, np.int64)
    for i in range(n):
        taken = np.zeros(n + 1, np.bool_)
        for j in range(i):
            if (
                extents[i, 0] <= extents[j, 2]
                and extents[i, 2] >= extents[j, 0]
                and extents[i, 1] <= extents[j, 3]
                and extents[i, 3] >= extents[j, 1]
            ):
                taken[which[j]] = True
        k = 0
        while taken[k]:
            k += 1
        which[i] = k
    return which
