"""Which triangles a hole leaves anything of: of a large mesh that it cuts, often half.

The hole is one depth at each pixel, from the eye on. A triangle is left out where it lies nearer
than that all over, and where it turns its back in pixels that the hole does not reach.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Ints, Ints32
from seethrough.renderer.plan.coverage import SLACK, cut_by_near_plane
from seethrough.renderer.techniques.maps import BLOCK
from seethrough.renderer.techniques.removal import SURE

EDGE_ON = 1.0  # square pixels of twice its area, below which float32 may turn a triangle round


@njit(cache=True, nogil=True)
def remaining(
    points: Floats,
    corners: Ints,
    spans: Ints,
    turns: Floats,
    moves: Floats,
    mirrored: Bools,
    lens: Floats,
    low: Floats,
    high: Floats,
    out: Ints32,
) -> Ints:
    """Write the corners of what is left of k objects into `out` (m, 3), as rows of their mesh, and
    return where each object's begin (k + 1,). Of one that the near plane cuts all are left.

    `points`, `corners` and `spans` (k, 2, 2) are as in coverage.Triangles; `turns` (k, 3, 3) and
    `moves` (k, 3): camera ← mesh; `mirrored` (k,), whether that turns triangles round; `lens` as in
    coverage.lens; `low` and `high` are the least and the greatest depth of the hole in each block
    of pixels (maps.block_bounds).
    """
    starts = np.zeros(len(spans) + 1, np.int64)
    seen = np.empty((len(points), 3))  # column, row, depth
    rows, columns = low.shape
    count = 0
    for k in range(len(spans)):
        first = spans[k, 0, 0]
        cut = cut_by_near_plane(points, spans[k, 0], turns[k], moves[k], lens, seen)
        for t in range(spans[k, 1, 0], spans[k, 1, 1]):
            i, j, n = corners[t]
            if not cut:
                a, b, c = seen[i], seen[j], seen[n]
                left = min(a[0], b[0], c[0]) - SLACK
                right = max(a[0], b[0], c[0]) + SLACK
                top = min(a[1], b[1], c[1]) - SLACK
                bottom = max(a[1], b[1], c[1]) + SLACK
                if right < 0 or bottom < 0 or left >= columns * BLOCK or top >= rows * BLOCK:
                    continue
                begin_row, begin_column = int(max(top, 0.0)) // BLOCK, int(max(left, 0.0)) // BLOCK
                end_row = min(int(min(bottom, 1e6)) // BLOCK + 1, rows)
                end_column = min(int(min(right, 1e6)) // BLOCK + 1, columns)
                least, most = np.inf, 0.0
                for row in range(begin_row, end_row):
                    for column in range(begin_column, end_column):
                        least = min(least, low[row, column])
                        most = max(most, high[row, column])
                if max(a[2], b[2], c[2]) * (1 + SURE) < least:
                    continue
                # Seen from the front, corners go round against the clock, and rows go down.
                turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
                if most == 0.0 and (-turn if mirrored[k] else turn) > EDGE_ON:
                    continue
            out[count, 0], out[count, 1], out[count, 2] = i - first, j - first, n - first
            if mirrored[k]:
                out[count, 0], out[count, 2] = out[count, 2], out[count, 0]
            count += 1
        starts[k + 1] = count
    return starts
