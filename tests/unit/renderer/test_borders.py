"""Holes in the shape of targets, filled by rows, against the border asked at each pixel."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.masks.masks import convex_hull
from seethrough.renderer.techniques.breakaway.border import fill, room
from seethrough.renderer.techniques.maps import bounds

WIDTH, HEIGHT = 90, 70


def outlines(rng, count):
    """Hulls of points about some place, two of them of a single point and of a line."""
    found = [rng.uniform(-9, 9, (k, 2)) + rng.uniform(0, (WIDTH, HEIGHT)) for k in (1, 2)]
    for _ in range(count):
        found.append(rng.normal(0, 8, (12, 2)) + rng.uniform(-9, (WIDTH + 9, HEIGHT + 9)))
    found.append(np.array([[20.0, 10.5], [40, 10.5], [40, 30.5], [20, 30.5]]))  # level edges
    return [convex_hull(points) for points in found]


@pytest.mark.parametrize("jagged", [0.0, 0.6])
@pytest.mark.parametrize("margin", [0.0, 0.3, 7.0])
@pytest.mark.parametrize("seed", range(4))
def test_rows_hold_what_each_pixel_says(seed, margin, jagged):
    """But where the border runs within a thousandth of a pixel of a middle."""
    rng = np.random.default_rng(seed)
    hulls = outlines(rng, 6)
    depths = rng.uniform(3, 9, len(hulls))
    starts = np.cumsum([0, *map(len, hulls)])
    part = (5, 4, WIDTH - 3, HEIGHT - 6)
    filled = np.zeros((HEIGHT, WIDTH), np.float32)
    fill(np.concatenate(hulls), starts, depths, part, margin, jagged, 5, filled)
    places = np.stack(np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)), axis=-1) + 0.5
    expected, unsure = np.zeros((HEIGHT, WIDTH)), np.zeros((HEIGHT, WIDTH), bool)
    for hull, depth in zip(hulls, depths, strict=True):
        left = room(hull, places.reshape(-1, 2), margin, jagged, 5).reshape(HEIGHT, WIDTH)
        expected = np.maximum(expected, np.where(left > 0, depth, 0))
        unsure |= np.abs(left) < 2e-3
    inside = np.zeros((HEIGHT, WIDTH), bool)
    inside[part[1] : part[3], part[0] : part[2]] = True
    assert not filled[~inside].any()
    told = inside & ~(unsure & (margin > 0))
    if margin == 0:  # then every pixel within is less than a hundredth from the border
        told = inside
    assert np.array_equal(filled[told], expected[told].astype(np.float32))


@pytest.mark.parametrize("seed", range(6))
def test_bounds_hold_what_lies_in_a_part(seed):
    """Asked together or alone, also if they reach out of the picture; of those outside nothing is
    known."""
    rng = np.random.default_rng(seed)
    picture = rng.uniform(1, 9, (HEIGHT, WIDTH)).astype(np.float32)
    low = rng.uniform(-60, (WIDTH + 40, HEIGHT + 40), (5, 2))
    parts = np.concatenate([low, low + rng.uniform(0, 30, (5, 2))], axis=1)
    alone = np.concatenate([bounds(picture, part[None]) for part in parts])
    for (least, most), (left, top, right, bottom) in zip(
        [*bounds(picture, parts), *alone], [*parts, *parts], strict=True
    ):
        rows = slice(max(int(top), 0), max(int(bottom) + 1, 0))
        seen = picture[rows, max(int(left), 0) : max(int(right) + 1, 0)]
        if seen.size:
            assert least <= seen.min() and most >= seen.max()
        else:
            assert least <= 1 and most >= 1
