"""Levels put together: what can wait is drawn with more of its mesh, in fewer draws.

Each level has whatever may come then (levels.py). Much of that may as well come later, for what
waits for it does not come next: so it waits until something of its mesh cannot.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Ints
from seethrough.renderer.plan.levels import links_of
from seethrough.renderer.plan.order import Related


@njit(cache=True)
def gathered(
    related: Related, meshes: Ints, solid: Bools, of_object: Ints, of_mask: Ints
) -> tuple[Ints, Ints]:
    """The level of each object and of each mask (n,), as `of_object` and `of_mask` but for what
    waits: as many levels, and whoever overlaps another comes before or after it as there.

    Objects go with others of their `meshes` (n,), masks with others of what is `solid` (n,), as
    one draw takes them; where no order was broken.
    """
    order, n = related.seen, len(related.extents)
    starts, links = links_of(related)
    level = np.concatenate((of_object, of_mask))
    kinds = np.concatenate((2 + meshes, solid.astype(np.int64)))
    last = level.max()
    latest = _latest(order, starts, links, level, last)
    waits, earliest = np.zeros(2 * n, np.int64), np.zeros(2 * n, np.int64)
    earliest[n:] = -1
    for follower in links:
        waits[follower] += 1
    placed = np.full(2 * n, -2, np.int64)
    for here in range(-1, last + 1):
        for kind in range(2):  # objects, then masks
            now = np.zeros(kinds.max() + 1, np.bool_)
            for turn in range(2):  # what can wait no longer, then all that goes with it
                for i in order:
                    node = kind * n + i
                    if level[node] == -2 or placed[node] > -2:
                        continue
                    if waits[node] or earliest[node] > here:
                        continue
                    if turn == 0:
                        now[kinds[node]] |= latest[node] == here
                    elif now[kinds[node]]:
                        placed[node] = here
                        for follower in links[starts[node] : starts[node + 1]]:
                            waits[follower] -= 1
                            after = here + (follower < n)
                            earliest[follower] = max(earliest[follower], after)
    return placed[:n], placed[n:]


@njit(cache=True)
def _latest(order: Ints, starts: Ints, links: Ints, level: Ints, last: int) -> Ints:
    """Up to which level each node (2 n,) may wait: what follows on it lies in a later level, a
    mask at least in the same."""
    n = len(level) // 2
    latest = np.full(2 * n, last, np.int64)
    for here in range(last, -2, -1):
        for kind in range(1, -1, -1):
            for i in order:
                node = kind * n + i
                if level[node] == here:
                    for follower in links[starts[node] : starts[node + 1]]:
                        latest[node] = min(latest[node], latest[follower] - (follower < n))
    return latest
