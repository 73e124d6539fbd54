"""How far the picture on a triangle is from the straight run between its corners' colours."""

from __future__ import annotations

import numpy as np
from numba import njit

from seethrough.renderer.arrays import Floats, Floats32, Ints
from seethrough.renderer.models.files.part import to_shown
from seethrough.renderer.models.files.texture import CLAMP, MIRROR

_STEPS = 4096
SHOWN = to_shown(np.arange(_STEPS + 2) / _STEPS)
"""Colours as shown at even steps of light: straight between them to a thousandth."""
BINS = 1024  # quarters of a step of 255


@njit(cache=True)
def _texel(index: int, count: int, way: int) -> int:
    """The texel in [0, count) of one that may lie beyond."""
    if way == CLAMP:
        return min(max(index, 0), count - 1)
    if way == MIRROR:
        along = index % (2 * count)
        return min(along, 2 * count - 1 - along)
    return index % count


@njit(cache=True)
def _sample(
    picture: Floats32, u: float, v: float, wrap_u: int, wrap_v: int, nearest: bool, out: Floats
) -> None:
    """RGBA at u, v into `out`, as Texture.sample has it."""
    height, width = picture.shape[0], picture.shape[1]
    x, y = u * width, v * height
    if nearest:
        row = _texel(int(np.floor(y)), height, wrap_v)
        column = _texel(int(np.floor(x)), width, wrap_u)
        for c in range(4):
            out[c] = picture[row, column, c]
        return
    x, y = x - 0.5, y - 0.5
    left, top = int(np.floor(x)), int(np.floor(y))
    a, b = x - left, y - top
    x0, x1 = _texel(left, width, wrap_u), _texel(left + 1, width, wrap_u)
    y0, y1 = _texel(top, height, wrap_v), _texel(top + 1, height, wrap_v)
    for c in range(4):
        upper = picture[y0, x0, c] * (1 - a) + picture[y0, x1, c] * a
        lower = picture[y1, x0, c] * (1 - a) + picture[y1, x1, c] * a
        out[c] = upper * (1 - b) + lower * b


@njit(cache=True)
def compared(
    values: Floats,
    colors: Floats,
    sides: Ints,
    cutoff: Floats,
    areas: Floats,
    picture: Floats32,
    wrap: Ints,
    nearest: bool,
    table: Floats,
    bins: Floats,
) -> Floats:
    """(k, 3) for each triangle: its mean and its largest error, and the share of it that is seen.

    values (k, 3, 6): uv and linear RGBA of corners, which the picture's multiply; colors
    (k, 3, 3) as shown of corners; `sides` (k,): samples along a side. Areas (k,) are added to
    `bins` by quarters of a step of 255.
    """
    found = np.zeros((len(values), 3))
    at, rgba = np.empty(6), np.empty(4)
    for t in range(len(values)):
        n = sides[t]
        mean = worst = 0.0
        seen = 0
        for i in range(n):
            for j in range(2 * (n - i) - 1):
                part = (1 + j % 2) / 3.0
                a, b = (i + part) / n, (j // 2 + part) / n
                c = 1.0 - a - b
                for k in range(6):
                    at[k] = a * values[t, 0, k] + b * values[t, 1, k] + c * values[t, 2, k]
                _sample(picture, at[0], at[1], wrap[0], wrap[1], nearest, rgba)
                alpha = rgba[3] * at[5]
                if cutoff[t] >= 0 and not (alpha > 0 and alpha >= cutoff[t]):
                    continue
                seen += 1
                off = 0.0
                for k in range(3):
                    light = min(max(rgba[k] * at[2 + k], 0.0), 1.0) * _STEPS
                    step = int(light)
                    shown = table[step] + (light - step) * (table[step + 1] - table[step])
                    straight = a * colors[t, 0, k] + b * colors[t, 1, k] + c * colors[t, 2, k]
                    off = max(off, abs(shown - straight))
                mean += off
                worst = max(worst, off)
                bins[min(int(1020 * off), len(bins) - 1)] += areas[t] / (n * n)
        found[t, 0], found[t, 1], found[t, 2] = mean / (n * n), worst, seen / (n * n)
    return found


def sides_of(texels: Floats, most: int) -> Ints:
    """(k,) samples along the sides of triangles whose longest is so many texels."""
    return (2 ** np.ceil(np.log2(np.clip(texels, 2, most)))).astype(np.int64)
