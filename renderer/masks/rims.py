"""How far pixels beside an outline lie from it.

Each stretch of it gives its distances to the pixels on its outer side, each corner to those round
it, and the least counts.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Bools, Floats, Floats32, Ints


@njit(cache=True, nogil=True)
def _straight(
    pixels: Floats, points: Ints, base: int, size: int, i: int, j: int, slack: float
) -> bool:
    """Whether the points between i and j of a walk lie along the way, and hardly beside it."""
    ax, ay = pixels[points[base + i], 0], pixels[points[base + i], 1]
    b = points[base + j % size]
    dx, dy = pixels[b, 0] - ax, pixels[b, 1] - ay
    length = np.sqrt(dx * dx + dy * dy)
    if length == 0:
        return False
    dx, dy = dx / length, dy / length
    last = 0.0
    for v in range(i + 1, j):
        x, y = pixels[points[base + v], 0] - ax, pixels[points[base + v], 1] - ay
        along = x * dx + y * dy
        if along < last - slack or along > length + slack or abs(x * dy - y * dx) > slack:
            return False
        last = max(last, along)
    return True


@njit(cache=True, nogil=True)
def _stretches(
    pixels: Floats, points: Ints, base: int, size: int, meets: Bools, slack: float, ends: Ints
) -> int:
    """Where the nearly straight stretches of a walk end, into `ends`; returns how many."""
    n = i = 0
    while i < size:
        j = i + 1
        while j < size and j - i < 48 and not meets[points[base + j]]:
            if not _straight(pixels, points, base, size, i, j + 1, slack):
                break
            j += 1
        ends[n] = j
        n += 1
        i = j
    return n


@njit(cache=True, nogil=True)
def _hidden(px: float, py: float, qx: float, qy: float, out: Floats32) -> bool:
    """Whether the target covers every pixel about a stretch: then a pixel beside the target has
    a nearer piece of the outline."""
    height, width = out.shape
    steps = 1 + int(min(np.sqrt((qx - px) ** 2 + (qy - py) ** 2), 1e6))
    for t in range(steps + 1):
        x, y = px + (qx - px) * t / steps, py + (qy - py) * t / steps
        if not (1 <= x < width - 1 and 1 <= y < height - 1):
            return False
        column, row = int(x), int(y)
        for r in range(row - 1, row + 2):
            for c in range(column - 1, column + 2):
                if out[r, c] >= 0:
                    return False
    return True


@njit(cache=True, nogil=True)
def _window(low: float, high: float, size: int) -> tuple[int, int]:
    """The pixels, of `size`, whose centres lie between two coordinates."""
    first = int(min(max(np.ceil(low - 0.5), 0.0), float(size)))
    return first, int(max(min(np.floor(high - 0.5) + 1.0, float(size)), 0.0))


@njit(cache=True, nogil=True)
def _between(
    first: int, last: int, value: float, step: float, low: float, high: float
) -> tuple[int, int]:
    """Those of the columns from `first` to `last` (excluded) in which a value, `value` in column 0
    and `step` more in each, lies from low to high, as far as a ten-millionth of a column tells."""
    if abs(step) < 1e-12:
        return first, last if low <= value <= high else first
    a, b = (low - value) / step, (high - value) / step
    if a > b:
        a, b = b, a
    a, b = max(a - 1e-7, float(first)), min(b + 1e-7, float(last - 1))
    return (int(np.ceil(a)), int(np.floor(b)) + 1) if a <= b else (first, first)


@njit(cache=True, nogil=True)
def _beside(
    px: float, py: float, qx: float, qy: float, nx: float, ny: float, reach: float, out: Floats32
) -> None:
    """Squared distances of the pixels on the outer side (nx, ny) of a stretch from p to q."""
    height, width = out.shape
    ox, oy, length = nx * reach, ny * reach, np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
    left, right = _window(min(px, qx, px + ox, qx + ox), max(px, qx, px + ox, qx + ox), width)
    top, bottom = _window(min(py, qy, py + oy, qy + oy), max(py, qy, py + oy, qy + oy), height)
    for row in range(top, bottom):
        x, y = 0.5 - px, row + 0.5 - py
        off = x * nx + y * ny
        first, last = _between(left, right, off, nx, 0.0, reach)
        # The stretch runs along (ny, −nx).
        first, last = _between(first, last, x * ny - y * nx, ny, 0.0, length)
        for column in range(first, last):
            d = off + column * nx
            out[row, column] = min(out[row, column], np.float32(d * d))


@njit(cache=True, nogil=True)
def _about(
    px: float, py: float, ax: float, ay: float, bx: float, by: float, reach: float, out: Floats32
) -> None:
    """Squared distances of the pixels round a corner p from normal a to b, if it turns outwards;
    of all pixels round it where both are 0."""
    height, width = out.shape
    if ax == 0 and ay == 0:
        _all_about(px, py, reach, out)
        return
    cosine = ax * bx + ay * by
    if ax * by - ay * bx >= 0 and cosine > -0.999999:
        return
    low_x, high_x, low_y, high_y = px - reach, px + reach, py - reach, py + reach
    if cosine > 0:  # a turn of less than a right angle lies in the tangents' hull
        mx, my = reach * (ax + bx) / (1 + cosine), reach * (ay + by) / (1 + cosine)
        low_x = px + min(0.0, ax * reach, bx * reach, mx)
        high_x = px + max(0.0, ax * reach, bx * reach, mx)
        low_y = py + min(0.0, ay * reach, by * reach, my)
        high_y = py + max(0.0, ay * reach, by * reach, my)
    first, last = _window(low_x, high_x, width)
    top, bottom = _window(low_y, high_y, height)
    for row in range(top, bottom):
        for column in range(first, last):
            x, y = column + 0.5 - px, row + 0.5 - py
            square = x * x + y * y
            # Beyond the stretch before, which runs along (ay, −ax), and before the one after.
            if square < out[row, column] and square <= reach * reach:
                if x * ay - y * ax >= -1e-9 and x * by - y * bx <= 1e-9:
                    out[row, column] = square


@njit(cache=True, nogil=True)
def _all_about(px: float, py: float, reach: float, out: Floats32) -> None:
    """Squared distances of all pixels round a point."""
    height, width = out.shape
    top, bottom = _window(py - reach, py + reach, height)
    for row in range(top, bottom):
        x, y = 0.5 - px, row + 0.5 - py
        wide = np.sqrt(max(reach * reach - y * y, 0.0))
        first, last = _window(px - wide, px + wide, width)
        for column in range(first, last):
            square = (x + column) * (x + column) + y * y
            out[row, column] = min(out[row, column], np.float32(square))


@njit(cache=True, nogil=True)
def surround(
    pixels: Floats,
    points: Ints,
    starts: Ints,
    meets: Bools,
    reach: float,
    slack: float,
    out: Floats32,
) -> None:
    """Put the square of the least distance into `out` for the pixels outside the walks.

    Beside each stretch and round each corner that turns outwards; all round where walks meet;
    nothing where the target covers both sides.
    """
    ends = np.empty(len(points) + 1, np.int64)
    normals = np.zeros((len(points) + 1, 2))
    shown = np.empty(len(points) + 1, np.bool_)
    for w in range(len(starts) - 1):
        base, size = starts[w], starts[w + 1] - starts[w]
        n = _stretches(pixels, points, base, size, meets, slack, ends)
        begin = 0
        for e in range(n):
            p, q = points[base + begin], points[base + ends[e] % size]
            begin = ends[e]
            px, py, qx, qy = pixels[p, 0], pixels[p, 1], pixels[q, 0], pixels[q, 1]
            length = np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
            nx = ny = 0.0
            if length > 0:
                nx, ny = -(qy - py) / length, (qx - px) / length
            normals[e, 0], normals[e, 1] = nx, ny
            shown[e] = not _hidden(px, py, qx, qy, out)
            if shown[e] and length > 0:
                _beside(px, py, qx, qy, nx, ny, reach, out)
        for e in range(n):
            after = (e + 1) % n
            if not (shown[e] or shown[after]):
                continue
            q = points[base + ends[e] % size]
            ax, ay, bx, by = normals[e, 0], normals[e, 1], normals[after, 0], normals[after, 1]
            if meets[q] or (ax == 0 and ay == 0) or (bx == 0 and by == 0):
                ax = ay = bx = by = 0.0
            _about(pixels[q, 0], pixels[q, 1], ax, ay, bx, by, reach, out)
