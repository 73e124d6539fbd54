"""Levels: objects that are drawn together, in an order that keeps to who lies before whom."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Ints
from seethrough.renderer.plan.order import Related, meet


class Queue(NamedTuple):
    """For how many others objects and masks wait (2, n), which have their level (2, n), and the
    levels found so far (n,). A tuple, because compiled code takes it."""

    waits: Ints
    done: Bools
    of_object: Ints
    of_mask: Ints


@njit(cache=True)
def levels(related: Related) -> tuple[Ints, Ints, Bools]:
    """The level of each blended object and of each mask (−2: none), and broken (n, n).

    An object comes after every mask and blended object behind it that it overlaps; a mask comes
    with its own target and after everything behind. Where they wait for one another in a circle,
    one goes before what it waits for: broken[i, j] of object i in front that goes before j or its
    mask, broken[j, i] of object j behind that goes after the mask of i.
    """
    order, extents, reach = related.seen, related.extents, related.reach
    relation, blended, masked = related.relation, related.blended, related.masked
    n, m = len(extents), len(order)
    of_object, of_mask = np.full(n, -2, np.int64), np.full(n, -2, np.int64)
    waits, done = np.zeros((2, n), np.int64), np.zeros((2, n), np.bool_)
    queue = Queue(waits, done, of_object, of_mask)
    broken = np.zeros((n, n), np.bool_)
    for a in range(m):
        i = order[a]
        if masked[i] and blended[i]:
            waits[1, i] += 1
        for b in range(m):
            j = order[b]
            if not blended[i] or i == j:
                continue
            if blended[j] and relation[i, j] == 1 and meet(extents, i, extents, j):
                waits[0, i] += 1
            if masked[j] and meet(extents, i, reach, j):
                if relation[i, j] == 1:
                    waits[0, i] += 1
                elif relation[i, j] == -1:
                    waits[1, j] += 1
    left = 0
    for a in range(m):
        i = order[a]
        left += blended[i]
        left += masked[i]
        of_object[i] = 0 if blended[i] else -2
        of_mask[i] = -1 if masked[i] else -2
    while left:
        moved = False
        for kind in range(2):
            for a in range(m):
                i = order[a]
                there = blended[i] if kind == 0 else masked[i]
                if not there or done[kind, i] or waits[kind, i] > 0:
                    continue
                done[kind, i] = moved = True
                left -= 1
                _release(kind, i, related, queue)
        if not moved:
            kind, i = _stuck(related, done)
            waits[kind, i] = 0
            for b in range(m):
                j = order[b]
                if kind == 0 and relation[i, j] == 1:
                    broken[i, j] = (
                        blended[j] and not done[0, j] and meet(extents, i, extents, j)
                    ) or (masked[j] and not done[1, j] and meet(extents, i, reach, j))
                elif kind == 1 and relation[j, i] == -1 and blended[j] and not done[0, j]:
                    broken[j, i] = meet(extents, j, reach, i)
    return of_object, of_mask, broken


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
def _release(kind: int, i: int, related: Related, queue: Queue) -> None:
    """Object or mask i has its level: those that wait for it come after it."""
    order, extents, reach = related.seen, related.extents, related.reach
    relation, blended, masked = related.relation, related.blended, related.masked
    waits, done, of_object, of_mask = queue.waits, queue.done, queue.of_object, queue.of_mask
    for b in range(len(order)):
        j = order[b]
        if kind == 0:
            if i == j:
                if masked[i]:
                    waits[1, i] -= 1
                    of_mask[i] = max(of_mask[i], of_object[i])
                continue
            if (
                blended[j]
                and not done[0, j]
                and relation[j, i] == 1
                and meet(extents, i, extents, j)
            ):
                waits[0, j] -= 1
                of_object[j] = max(of_object[j], of_object[i] + 1)
            if masked[j] and not done[1, j] and relation[i, j] == -1 and meet(extents, i, reach, j):
                waits[1, j] -= 1
                of_mask[j] = max(of_mask[j], of_object[i])
        elif (
            i != j
            and blended[j]
            and not done[0, j]
            and relation[j, i] == 1
            and meet(extents, j, reach, i)
        ):
            waits[0, j] -= 1
            of_object[j] = max(of_object[j], of_mask[i] + 1)


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
