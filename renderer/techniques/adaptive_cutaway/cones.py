"""The hole that cones before all points of targets make, as a depth at each pixel.

The best point of a pixel is found by bounds: a block of points cannot beat what is known if its
nearest and deepest could not. Blocks of 8 × 8 and of 64 × 64 pixels are looked at in turn. Where
not every pixel is asked, the middles of blocks of 16 × 16 are.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints, Real

SMALL, LARGE = 8, 64
ASKED = 16
BESIDE = np.array([(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)])


@njit(cache=True)
def _deepest(depth: Real, block: int) -> Floats:
    """(rows, columns) the greatest depth in each block."""
    height, width = depth.shape
    found = np.zeros(((height + block - 1) // block, (width + block - 1) // block), np.float64)
    for i in range(len(found)):
        line = depth[i * block].copy()  # the greatest of each column: several at once
        for r in range(i * block + 1, min(i * block + block, height)):
            for c in range(width):
                line[c] = depth[r, c] if depth[r, c] > line[c] else line[c]
        for c in range(width):
            found[i, c // block] = max(found[i, c // block], line[c])
    return found


@njit(cache=True)
def _gap(x: float, low: float, block: int) -> float:
    """Distance along one axis from x to the middles of the pixels of a block."""
    return max(low + 0.5 - x, x - (low + block - 0.5), 0.0)


@njit(cache=True)
def _filled(large: Floats) -> Ints:
    """(k, 2) the blocks that have a point."""
    found = np.empty((large.size, 2), np.int64)
    count = 0
    for a in range(large.shape[0]):
        for b in range(large.shape[1]):
            if large[a, b] > 0:
                found[count, 0], found[count, 1] = a, b
                count += 1
    return found[:count]


@njit(cache=True)
def _too_far(deepest: float, dy: float, dx: float, wide: float, best: float) -> bool:
    """Whether the cone of a point as deep as that, so far away, is no deeper than the best."""
    if best <= 0:
        return False
    reach = deepest * wide / best - wide
    return reach <= 0 or dx * dx + dy * dy >= reach * reach


@njit(cache=True)
def _best(
    depth: Real,
    small: Floats,
    large: Floats,
    filled: Ints,
    x: float,
    y: float,
    wide: float,
    best: float,
) -> tuple[int, int, float]:
    """The deepest cone at a point of the picture, and its pixel; −1 if none is deeper than best."""
    row, column = -1, -1
    per = LARGE // SMALL
    for k in range(len(filled)):
        a, b = filled[k]
        if _too_far(large[a, b], _gap(y, a * LARGE, LARGE), _gap(x, b * LARGE, LARGE), wide, best):
            continue
        for i in range(a * per, min(a * per + per, small.shape[0])):
            dy = _gap(y, i * SMALL, SMALL)
            for j in range(b * per, min(b * per + per, small.shape[1])):
                deepest = small[i, j]
                if deepest <= 0:
                    continue
                if _too_far(deepest, dy, _gap(x, j * SMALL, SMALL), wide, best):
                    continue
                for r in range(i * SMALL, min(i * SMALL + SMALL, depth.shape[0])):
                    for c in range(j * SMALL, min(j * SMALL + SMALL, depth.shape[1])):
                        v, u = r + 0.5 - y, c + 0.5 - x
                        if depth[r, c] <= 0 or _too_far(depth[r, c], v, u, wide, best):
                            continue
                        best = depth[r, c] * wide / (np.sqrt(v * v + u * u) + wide)
                        row, column = r, c
    return row, column, best


@njit(cache=True)
def of_pixels(depth: Real, lens: float, tangent: float) -> Floats32:
    """(h, w) the exact hole of points of a (h, w) depth (0: no point)."""
    height, width = depth.shape
    small, large = _deepest(depth, SMALL), _deepest(depth, LARGE)
    filled, wide = _filled(large), lens * tangent
    out = np.zeros((height, width), np.float32)
    row, column = -1, -1
    for r in range(height):
        for k in range(width):
            c = k if r % 2 == 0 else width - 1 - k
            best = 0.0
            if row >= 0:  # the neighbour's best point is seldom far from this pixel's
                away = np.hypot(float(r - row), float(c - column))
                best = depth[row, column] * wide / (away + wide)
            better = _best(depth, small, large, filled, c + 0.5, r + 0.5, wide, best)
            if better[0] >= 0:
                row, column, best = better
            out[r, c] = best
    return out


@njit(cache=True)
def of_blocks(
    depth: Real, lens: float, tangent: float, part: tuple[int, int, int, int]
) -> Floats32:
    """(h, w) the hole of the points that are best in the middle of a pixel's block or one beside
    it, 0 beside the blocks that a part (left, top, right, bottom) of the picture touches."""
    height, width = depth.shape
    first, last = (part[1] // ASKED, part[0] // ASKED), (-(-part[3] // ASKED), -(-part[2] // ASKED))
    seeds, wide = _seeds(depth, lens * tangent, first, last), np.float32(lens * tangent)
    out = np.zeros((height, width), np.float32)
    for i in range(first[0], last[0]):
        for j in range(first[1], last[1]):
            tried = _tried(seeds, i, j)
            left, right = j * ASKED, min(j * ASKED + ASKED, width)
            for r in range(i * ASKED, min(i * ASKED + ASKED, height)):
                line = out[r, left:right]
                line[:] = depth[r, left:right]
                for k in range(len(tried)):
                    y, x = np.float32(r - tried[k, 0]), np.float32(left - tried[k, 1])
                    top = np.float32(depth[tried[k, 0], tried[k, 1]]) * wide
                    for c in range(len(line)):
                        across = x + np.float32(c)
                        cone = top / (np.sqrt(across * across + y * y) + wide)
                        line[c] = cone if cone > line[c] else line[c]
    return out


@njit(cache=True)
def _seeds(depth: Real, wide: float, first: tuple[int, int], last: tuple[int, int]) -> Ints:
    """(rows, columns, 2) the row and column of the best point for the middle of each block from
    the `first` to before the `last`, and one about them; −1 where there is none."""
    small, large = _deepest(depth, SMALL), _deepest(depth, LARGE)
    filled = _filled(large)
    rows, columns = (depth.shape[0] + ASKED - 1) // ASKED, (depth.shape[1] + ASKED - 1) // ASKED
    seeds = np.full((rows, columns, 2), -1, np.int64)
    for i in range(max(first[0] - 1, 0), min(last[0] + 1, rows)):
        for j in range(max(first[1] - 1, 0), min(last[1] + 1, columns)):
            x, y = j * ASKED + ASKED / 2, i * ASKED + ASKED / 2
            best = 0.0
            for a, b in ((i, j - 1), (i - 1, j)):  # seldom far from that of a block beside
                if a < 0 or b < 0 or seeds[a, b, 0] < 0:
                    continue
                r, c = seeds[a, b]
                cone = depth[r, c] * wide / (np.hypot(r + 0.5 - y, c + 0.5 - x) + wide)
                if cone > best:
                    best = cone
                    seeds[i, j] = seeds[a, b]
            row, column, _ = _best(depth, small, large, filled, x, y, wide, best)
            if row >= 0:
                seeds[i, j, 0], seeds[i, j, 1] = row, column
    return seeds


@njit(cache=True)
def _tried(seeds: Ints, i: int, j: int) -> Ints:
    """(k, 2) the different points of a block and of those beside it."""
    found = np.empty((len(BESIDE), 2), np.int64)
    count = 0
    for n in range(len(BESIDE)):
        a, b = i + BESIDE[n, 0], j + BESIDE[n, 1]
        if a < 0 or b < 0 or a >= seeds.shape[0] or b >= seeds.shape[1] or seeds[a, b, 0] < 0:
            continue
        known = False
        for k in range(count):
            known |= found[k, 0] == seeds[a, b, 0] and found[k, 1] == seeds[a, b, 1]
        if not known:
            found[count] = seeds[a, b]
            count += 1
    return found[:count]
