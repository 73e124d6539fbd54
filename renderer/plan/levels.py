"""Levels: objects that are drawn together, in an order that keeps to who lies before whom."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Ints
from seethrough.renderer.plan.order import Related, meet


@njit(cache=True)
def levels(related: Related) -> tuple[Ints, Ints, Bools]:
    """The level of each blended object and of each mask (−2: none), and broken (n, n).

    An object comes after every mask and blended object behind it that it overlaps; a mask comes
    with its own target and after everything behind. Where they wait for one another in a circle,
    one goes before what it waits for: broken[i, j] of object i in front that goes before j or its
    mask, broken[j, i] of object j behind that goes after the mask of i.
    """
    order, n = related.seen, len(related.extents)
    starts, links = links_of(related)
    waits, done = np.zeros(2 * n, np.int64), np.zeros((2, n), np.bool_)
    for follower in links:
        waits[follower] += 1
    level, broken = np.full(2 * n, -2, np.int64), np.zeros((n, n), np.bool_)
    ready, count, left = np.empty(2 * n, np.int64), 0, 0
    for i in order:
        for kind, there in ((0, related.blended[i]), (1, related.masked[i])):
            if there:
                level[kind * n + i] = -kind
                left += 1
                if waits[kind * n + i] == 0:
                    ready[count] = kind * n + i
                    count += 1
    while left:
        if count == 0:
            kind, i = _stuck(related, done)
            _break(related, done, kind, i, broken)
            ready[0], count = kind * n + i, 1
        count -= 1
        node = ready[count]
        done[node // n, node % n] = True
        left -= 1
        for follower in links[starts[node] : starts[node + 1]]:
            if done[follower // n, follower % n]:
                continue
            level[follower] = max(level[follower], level[node] + (follower < n))
            waits[follower] -= 1
            if waits[follower] == 0:
                ready[count] = follower
                count += 1
    return level[:n], level[n:], broken


@njit(cache=True)
def links_of(related: Related) -> tuple[Ints, Ints]:
    """What follows on what: of node k, which is object k or from n on the mask of object k − n,
    the followers links[starts[k] : starts[k + 1]]."""
    order, extents, reach = related.seen, related.extents, related.reach
    relation, blended, masked = related.relation, related.blended, related.masked
    n = len(extents)
    found, k = np.empty((4 * len(order) + 4, 2), np.int64), 0
    starts = np.zeros(2 * n + 1, np.int64)
    for i in order:
        if not blended[i]:
            continue
        if masked[i]:
            found[k, 0], found[k, 1] = i, n + i
            k += 1
        for j in order:
            sign = relation[i, j]
            if sign == 0:
                continue
            if k + 3 > len(found):  # most scenes have few links: as many as there can be is n²
                found = np.concatenate((found, np.empty_like(found)))
            if sign == 1 and blended[j] and meet(extents, i, extents, j):
                found[k, 0], found[k, 1] = j, i
                k += 1
            if masked[j] and meet(extents, i, reach, j):
                if sign == 1:
                    found[k, 0], found[k, 1] = n + j, i
                else:
                    found[k, 0], found[k, 1] = i, n + j
                k += 1
    for f in range(k):
        starts[found[f, 0] + 1] += 1
    starts = np.cumsum(starts)
    links, free = np.empty(k, np.int64), starts[1:].copy()  # of each node from its end
    for f in range(k):
        free[found[f, 0]] -= 1
        links[free[found[f, 0]]] = found[f, 1]
    return starts, links


@njit(cache=True)
def _break(related: Related, done: Bools, kind: int, i: int, broken: Bools) -> None:
    """Say what object (0, i) or mask (1, i) goes before although it waits for it."""
    extents, reach, relation = related.extents, related.reach, related.relation
    blended, masked = related.blended, related.masked
    for j in related.seen:
        if kind == 0 and relation[i, j] == 1:
            broken[i, j] = (blended[j] and not done[0, j] and meet(extents, i, extents, j)) or (
                masked[j] and not done[1, j] and meet(extents, i, reach, j)
            )
        elif kind == 1 and relation[j, i] == -1 and blended[j] and not done[0, j]:
            broken[j, i] = meet(extents, j, reach, i)


@njit(cache=True)
def _stuck(related: Related, done: Bools) -> tuple[int, int]:
    """Which object (0, i) or mask (1, i) goes first where all wait for one another.

    One that no target loses by: a mask whose target is drawn turns what lies behind it clear beside
    that, an object hides what lies behind it. Else the farthest object.
    """
    order, extents, reach = related.seen, related.extents, related.reach
    relation, blended, masked = related.relation, related.blended, related.masked
    for kind in (1, 0):
        for a in range(len(order)):
            i = order[a]
            if done[kind, i] or not (masked[i] if kind else blended[i]):
                continue
            lost = kind == 1 and blended[i] and not done[0, i]
            for b in range(len(order)):
                j = order[b]
                if not masked[j] or done[1, j] or j == i:
                    continue
                if kind:
                    behind = relation[j, i] == -1 and blended[j] and not done[0, j]
                    lost = lost or (behind and meet(extents, j, reach, i))
                else:
                    lost = lost or (relation[i, j] == 1 and meet(extents, i, extents, j))
            if not lost:
                return kind, i
    for a in range(len(order)):
        if blended[order[a]] and not done[0, order[a]]:
            return 0, order[a]
    return 1, order[0]  # not reached: a mask waits for nothing but objects


@njit(cache=True)
def grouped(level: Ints, last: int) -> tuple[Ints, Ints]:
    """The objects of each level from −1 to `last`, in their order, and where each level's begin:
    objects[starts[k + 1] : starts[k + 2]] are those of level k. `level` (n,) is −2 for none."""
    starts = np.zeros(last + 3, np.int64)
    for i in range(len(level)):
        if level[i] > -2:
            starts[level[i] + 2] += 1
    starts = np.cumsum(starts)
    objects, free = np.empty(starts[-1], np.int64), starts.copy()
    for i in range(len(level)):
        if level[i] > -2:
            objects[free[level[i] + 1]] = i
            free[level[i] + 1] += 1
    return objects, starts


def one_by_one(order: Ints, of_object: Ints, of_mask: Ints) -> tuple[Ints, Ints]:
    """The same order with a level for each object, its mask included: the naive painter's."""
    n = len(of_object)
    place = np.zeros(n, np.int64)
    place[order] = np.arange(len(order))
    objects = np.nonzero(of_object >= 0)[0]
    rank = np.lexsort((place[objects], of_object[objects]))
    alone = np.full(n, -2, np.int64)
    alone[objects[rank]] = np.arange(len(objects))
    # A mask of level k comes after every object of level k.
    through = np.cumsum(np.bincount(of_object[objects], minlength=int(of_mask.max(initial=0)) + 1))
    moved = np.where(of_mask >= 0, through[np.maximum(of_mask, 0)] - 1, of_mask)
    return alone, moved
