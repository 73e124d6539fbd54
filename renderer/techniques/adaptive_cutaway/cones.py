"""The hole that cones before all points of targets make, as a depth at each pixel.

The best point of a pixel is found by bounds: a block of points cannot beat what is known if its
nearest and deepest could not. Blocks of 8 × 8 and of 64 × 64 pixels are looked at in turn.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints, Real

SMALL, LARGE = 8, 64


@njit(cache=True)
def _deepest(depth: Real, block: int) -> Floats:
    """(rows, columns) the greatest depth in each block."""
    height, width = depth.shape
    found = np.zeros(((height + block - 1) // block, (width + block - 1) // block), np.float64)
    for r in range(height):
        for c in range(width):
            found[r // block, c // block] = max(found[r // block, c // block], depth[r, c])
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
def of_blocks(depth: Real, lens: float, tangent: float) -> Floats32:
    """(h, w) the hole of the points that are best in the middle of a pixel's block or one beside
    it."""
    height, width = depth.shape
    small, large = _deepest(depth, SMALL), _deepest(depth, LARGE)
    filled, wide = _filled(large), lens * tangent
    rows, columns = small.shape
    seeds = np.full((rows, columns, 2), -1, np.int64)
    for i in range(rows):
        for j in range(columns):
            x, y = j * SMALL + SMALL / 2, i * SMALL + SMALL / 2
            best = 0.0
            if j > 0 and seeds[i, j - 1, 0] >= 0:
                r, c = seeds[i, j - 1]
                best = depth[r, c] * wide / (np.hypot(r + 0.5 - y, c + 0.5 - x) + wide)
                seeds[i, j] = seeds[i, j - 1]
            row, column, _ = _best(depth, small, large, filled, x, y, wide, best)
            if row >= 0:
                seeds[i, j, 0], seeds[i, j, 1] = row, column
    out = np.zeros((height, width), np.float32)
    tried = np.zeros((5, 3))
    for i in range(rows):
        for j in range(columns):
            count = 0
            for di, dj in ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1)):
                a, b = i + di, j + dj
                if 0 <= a < rows and 0 <= b < columns and seeds[a, b, 0] >= 0:
                    r, c = seeds[a, b]
                    known = False  # neighbours often have the same point
                    for k in range(count):
                        known |= tried[k, 0] == r and tried[k, 1] == c
                    if known:
                        continue
                    tried[count, 0], tried[count, 1], tried[count, 2] = r, c, depth[r, c] * wide
                    count += 1
            for r in range(i * SMALL, min(i * SMALL + SMALL, height)):
                for c in range(j * SMALL, min(j * SMALL + SMALL, width)):
                    best = np.float64(depth[r, c])
                    for k in range(count):
                        y, x = r - tried[k, 0], c - tried[k, 1]
                        best = max(best, tried[k, 2] / (np.sqrt(x * x + y * y) + wide))
                    out[r, c] = best
    return out
