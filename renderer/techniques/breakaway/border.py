"""How far a pixel lies inside a hole's border: about a convex outline, with teeth if asked."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints, Real
from seethrough.renderer.masks.masks import convex_hull


@njit(cache=True)
def hulls(points: Floats, starts: Ints, lens: Floats) -> tuple[Floats, Ints, Floats]:
    """Corners in pixels (m, 2) of the hulls of sets of points (p, 3) in camera coordinates, of
    which each begins at one of `starts` (n + 1,), where each hull's begin (k + 1,), and the
    farthest depth of each (k,). Points nearer than the near plane are left out, and so are sets
    that have no other. `lens`: pixels for a slope of 1, the middle of the picture x, y, and the
    near plane's depth."""
    n = len(starts) - 1
    corners, first, depths = np.empty((2 * len(points), 2)), np.zeros(n + 1, np.int64), np.empty(n)
    pixels = np.empty((len(points), 2))
    sets, total = 0, 0
    for t in range(n):
        count, deepest = 0, 0.0
        for p in range(starts[t], starts[t + 1]):
            depth = -points[p, 2]
            if depth > lens[3]:
                pixels[count, 0] = lens[1] + lens[0] * points[p, 0] / depth
                pixels[count, 1] = lens[2] - lens[0] * points[p, 1] / depth
                deepest = max(deepest, depth)
                count += 1
        if count > 0:
            hull = convex_hull(pixels[:count])
            corners[total : total + len(hull)] = hull
            total += len(hull)
            depths[sets] = deepest
            sets += 1
            first[sets] = total
    return corners[:total], first[: sets + 1], depths[:sets]


@njit(cache=True)
def _distance(corners: Real, x: float, y: float) -> float:
    """Pixels from a point to a convex outline, 0 within."""
    n = len(corners)
    best, positive, negative = np.inf, False, False
    for k in range(n):
        j = (k + 1) % n
        ex, ey = corners[j, 0] - corners[k, 0], corners[j, 1] - corners[k, 1]
        fx, fy = x - corners[k, 0], y - corners[k, 1]
        side = ex * fy - ey * fx
        positive |= side > 0
        negative |= side < 0
        t = min(max((fx * ex + fy * ey) / max(ex * ex + ey * ey, 1e-300), 0.0), 1.0)
        best = min(best, (fx - t * ex) ** 2 + (fy - t * ey) ** 2)
    if n > 2 and not (positive and negative):
        return 0.0
    return np.sqrt(best)


@njit(cache=True)
def _room(
    corners: Real, middle: Floats, x: float, y: float, margin: float, jagged: float, teeth: int
) -> float:
    """Pixels from a point to the border, above 0 within the hole."""
    distance = _distance(corners, x, y)
    reach = margin
    if jagged > 0:
        turn = np.arctan2(y - middle[1], x - middle[0]) / (2 * np.pi) * teeth
        tooth = abs(2 * (turn - np.floor(turn)) - 1)
        reach = margin * (1 - jagged * tooth)
    return reach - distance if distance > 0 else max(reach, 1e-2)


@njit(cache=True)
def _middle(corners: Real) -> Floats:
    low, high = corners[0].copy(), corners[0].copy()
    for k in range(len(corners)):
        for c in range(2):
            low[c], high[c] = min(low[c], corners[k, c]), max(high[c], corners[k, c])
    return (low + high) / 2


@njit(cache=True)
def room(corners: Real, points: Real, margin: float, jagged: float, teeth: int) -> Floats:
    """(p,) pixels from points (p, 2) to the border of a hole with these corners (k, 2), above 0
    within. Teeth go round the middle of the corners' box."""
    middle = _middle(corners)
    found = np.empty(len(points))
    for k in range(len(points)):
        x, y = points[k, 0], points[k, 1]
        found[k] = _room(corners, middle, x, y, margin, jagged, teeth)
    return found


@njit(cache=True)
def fill(
    corners: Real,
    starts: Ints,
    depths: Floats,
    part: tuple[int, int, int, int],
    margin: float,
    jagged: float,
    teeth: int,
    out: Floats32,
) -> None:
    """Put the farthest depth of all holes at each pixel of a part (left, top, right, bottom) of a
    picture (h, w) of zeros into it.

    A row of pixels meets a convex hole without its teeth in one stretch, which is looked at only
    where teeth can be; the stretch through the hull alone has none.
    """
    for h in range(len(depths)):
        hull = corners[starts[h] : starts[h + 1]]
        middle = _middle(hull)
        depth = np.float32(depths[h])
        low, high = hull[:, 1].min() - margin, hull[:, 1].max() + margin
        for r in range(max(part[1], int(low) - 1), min(part[3], int(max(high, 0.0)) + 2)):
            y = r + 0.5
            left, right = _stretch(hull, y, margin)
            if left > right:
                continue
            first, last = max(part[0], int(left) - 1), min(part[2], int(max(right, 0.0)) + 2)
            inner, outer = left + 1.0, right - 1.0
            if jagged > 0:
                inner, outer = _stretch(hull, y, 0.0)
            for c in range(first, last):
                x = c + 0.5
                if depth <= out[r, c]:
                    continue
                if (inner + 1e-3 < x < outer - 1e-3) or (
                    _room(hull, middle, x, y, margin, jagged, teeth) > 0
                ):
                    out[r, c] = depth


@njit(cache=True)
def _stretch(hull: Real, y: float, margin: float) -> tuple[float, float]:
    """Where a row meets the outline grown by a margin, from left to right; inf, -inf: nowhere."""
    left, right = np.inf, -np.inf
    n = len(hull)
    for k in range(n):
        away = abs(y - hull[k, 1])
        if away <= margin:
            half = np.sqrt(margin * margin - away * away)
            left, right = min(left, hull[k, 0] - half), max(right, hull[k, 0] + half)
        j = (k + 1) % n
        ex, ey = hull[j, 0] - hull[k, 0], hull[j, 1] - hull[k, 1]
        length = np.sqrt(ex * ex + ey * ey)
        if length == 0:
            continue
        for side in (-1.0, 1.0):
            ox, oy = -side * margin * ey / length, side * margin * ex / length
            y0, y1 = hull[k, 1] + oy, hull[j, 1] + oy
            if min(y0, y1) <= y <= max(y0, y1) and y0 != y1:
                x = hull[k, 0] + ox + (y - y0) / (y1 - y0) * ex
                left, right = min(left, x), max(right, x)
    return left, right
