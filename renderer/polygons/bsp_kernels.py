"""The two inner loops of a BSP's construction: choose a splitter, deal fragments to the sides."""

from __future__ import annotations

import numba
import numpy as np

from seethrough.renderer.arrays import Floats, Whole
from seethrough.renderer.polygons.classification import COUNT, PLANE, SOURCE, START, Pieces, Planes
from seethrough.renderer.polygons.predicates import loop_heights, loop_limit


@numba.njit(cache=True)
def choose(
    active: Whole,
    bounds: Whole,
    draws: Floats,
    sample: int,
    balance: float,
    pieces: Pieces,
    planes: Planes,
) -> tuple[Whole, int]:
    """The best of some random candidates in each group of fragments.

    Group g is active[bounds[g] : bounds[g + 1]]; `draws` (groups, k) are uniform numbers, one for
    each candidate, drawn without replacement. A candidate costs its cuts plus `balance` times the
    difference between its sides, counted on `sample` fragments of the group, the same for all
    candidates (0: on all). Returns the positions in `active` and the number of relations tested.
    """
    shape, rows = pieces.shape, pieces.rows
    groups = len(bounds) - 1
    k = draws.shape[1]
    best = np.empty(groups, np.int64)
    chosen = np.empty(k, np.int64)
    tested = 0
    for g in range(groups):
        low = bounds[g]
        n = bounds[g + 1] - low
        best[g] = low
        tries = min(k, n)
        if n == 1:
            continue
        least = np.inf
        tests = n if sample == 0 else min(n, sample)
        for j in range(tries):
            # Floyd's way to draw without replacement.
            top = n - tries + j
            pick = min(int(draws[g, j] * (top + 1)), top)
            for earlier in range(j):
                if chosen[earlier] == pick:
                    pick = top
            chosen[j] = pick
            splitter = shape[active[low + pick], SOURCE]
            cuts, lean = 0, 0
            for i in range(tests):
                f = active[low + i * n // tests]
                side = _rough_side(f, splitter, shape, rows, planes)
                cuts += int(side == 3)
                lean += int(side == 1) - int(side == 2)
            tested += min(tests, n - 1)
            cost = cuts + balance * abs(lean)
            if cost < least:
                least = cost
                best[g] = low + pick
    return best, tested


@numba.njit(inline="always")
def _rough_side(f: int, s: int, shape: Whole, rows: Floats, planes: Planes) -> int:
    """0 on, 1 front, 2 back, 3 both; corners too near to tell count as on the plane."""
    if shape[f, PLANE] == planes.plane_of[s]:
        return 0
    first = shape[f, START]
    low, high, far = loop_heights(planes.rows[s], rows, first, first + shape[f, COUNT])
    limit = loop_limit(planes.rows[s], far, planes.slack[s])
    return int(high > limit) | (int(low < -limit) << 1)


@numba.njit(cache=True)
def deal(
    active: Whole, bounds: Whole, code: Whole, pieces: Whole, piece_of: Whole, piece_side: Whole
) -> tuple[Whole, Whole, Whole, Whole, Whole]:
    """Fragments of each group to its plane, its front and its back.

    Returns what lies in the planes with its bounds (groups + 1), the next level's fragments with
    its bounds, and children (groups, 2): index of the new group in front and behind, or -1.
    """
    groups = len(bounds) - 1
    sizes = np.zeros((groups, 3), np.int64)
    group_of = np.empty(len(active), np.int32)
    for g in range(groups):
        for i in range(bounds[g], bounds[g + 1]):
            group_of[i] = g
            if code[i] < 3:
                sizes[g, code[i]] += 1
    for p in range(len(pieces)):
        sizes[group_of[piece_of[p]], 1 if piece_side[p] > 0 else 2] += 1
    at = np.empty((groups, 3), np.int64)
    children = np.full((groups, 2), -1, np.int64)
    own_bounds = np.zeros(groups + 1, np.int64)
    next_bounds = np.zeros(2 * groups + 1, np.int64)
    made = 0
    for g in range(groups):
        at[g, 0] = own_bounds[g]
        own_bounds[g + 1] = own_bounds[g] + sizes[g, 0]
        for side in (1, 2):
            at[g, side] = next_bounds[made]
            if sizes[g, side] > 0:
                children[g, side - 1] = made
                next_bounds[made + 1] = next_bounds[made] + sizes[g, side]
                made += 1
    own = np.empty(own_bounds[groups], np.int32)
    following = np.empty(next_bounds[made], np.int32)
    for i in range(len(active)):
        g, c = group_of[i], code[i]
        if c == 0:
            own[at[g, 0]] = active[i]
        elif c < 3:
            following[at[g, c]] = active[i]
        if c < 3:
            at[g, c] += 1
    for p in range(len(pieces)):
        g, c = group_of[piece_of[p]], (1 if piece_side[p] > 0 else 2)
        following[at[g, c]] = pieces[p]
        at[g, c] += 1
    return own, own_bounds, following, next_bounds[: made + 1], children
