"""How far a pixel lies inside a hole's border: about a convex outline, with teeth if asked."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints, Real
from seethrough.renderer.masks.masks import convex_hull

UNSURE = 1e-3  # pixels at the end of a stretch that are looked at by themselves


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
    at its ends and where teeth can be; the stretch through the hull alone has none.
    """
    for h in range(len(depths)):
        hull = corners[starts[h] : starts[h + 1]]
        middle = _middle(hull)
        depth = np.float32(depths[h])
        low, high = hull[:, 1].min() - margin, hull[:, 1].max() + margin
        top, bottom = max(part[1], int(low) - 1), min(part[3], int(max(high, 0.0)) + 2)
        if top >= bottom:
            continue
        ends = _stretches(hull, margin, top, bottom)
        sure = _stretches(hull, 0.0, top, bottom) if jagged > 0 else ends
        for r in range(top, bottom):
            left, right = ends[r - top]
            if left > right:
                continue
            row = out[r]
            first, last = max(part[0], int(left) - 1), min(part[2], int(max(right, 0.0)) + 2)
            # From `begin` to `end` pixels need no look: several are filled at once.
            begin, end = _between(sure[r - top], first, last)
            for c in range(begin, end):
                row[c] = depth if depth > row[c] else row[c]
            for a, b in ((first, begin), (end, last)):
                for c in range(a, b):
                    x = c + 0.5
                    if depth > row[c] and left - UNSURE < x < right + UNSURE:
                        if _room(hull, middle, x, r + 0.5, margin, jagged, teeth) > 0:
                            row[c] = depth


@njit(cache=True)
def _between(stretch: Floats, first: int, last: int) -> tuple[int, int]:
    """From which pixel, and up to which, middles lie surely within a stretch, of those from
    `first` up to `last`."""
    left, right = stretch[0] + 0.5 + UNSURE, stretch[1] - 0.5 - UNSURE
    if not left <= right:
        return last, last
    begin = min(max(int(np.ceil(left - 1.0)), first), last)
    return begin, min(max(int(np.floor(right)) + 1, begin), last)


@njit(cache=True)
def _stretches(hull: Real, margin: float, top: int, bottom: int) -> Floats:
    """(bottom − top, 2) where the middle of each row meets the outline grown by a margin, from left
    to right; ∞, −∞: nowhere."""
    found = np.empty((bottom - top, 2))
    found[:, 0], found[:, 1] = np.inf, -np.inf
    n = len(hull)
    for k in range(n):
        x, y = hull[k, 0], hull[k, 1]
        for r in range(*_rows(y - margin, y + margin, top, bottom)):
            away = r + 0.5 - y
            half = np.sqrt(max(margin * margin - away * away, 0.0))
            found[r - top, 0] = min(found[r - top, 0], x - half)
            found[r - top, 1] = max(found[r - top, 1], x + half)
        ex, ey = hull[(k + 1) % n, 0] - x, hull[(k + 1) % n, 1] - y
        length = np.sqrt(ex * ex + ey * ey)
        if length == 0 or ey == 0:
            continue
        for side in (-1.0, 1.0):  # the one within changes nothing
            x0, y0 = x - side * margin * ey / length, y + side * margin * ex / length
            slope = ex / ey
            for r in range(*_rows(min(y0, y0 + ey), max(y0, y0 + ey), top, bottom)):
                at = x0 + (r + 0.5 - y0) * slope
                found[r - top, 0] = min(found[r - top, 0], at)
                found[r - top, 1] = max(found[r - top, 1], at)
    return found


@njit(cache=True)
def _rows(low: float, high: float, top: int, bottom: int) -> tuple[int, int]:
    """From which row, and up to which, middles lie from `low` to `high`, of those from `top` up to
    `bottom`."""
    first = int(min(max(np.ceil(low - 0.5), top), bottom))
    return first, int(max(min(np.floor(high - 0.5) + 1, bottom), first))
