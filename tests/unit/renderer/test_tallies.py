"""Compiled loops over a look's pixels, against the same sums array by array."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.scene.tallies import around, changed, measured
from seethrough.renderer.scene.visibility import SEEN, shares

HALVES = np.arange(1 << 16, dtype=np.uint16).view(np.float16).astype(float)


@pytest.fixture
def rng():
    return np.random.default_rng(20)


def test_a_level_is_what_changed_and_is_not_background(rng):
    """Pixels of the whole picture with the ids now there, and their opacity from the alpha's bits;
    the picture before becomes the picture now."""
    before = rng.integers(0, 4, (7, 5)).astype(np.float32)
    now = rng.integers(0, 4, (7, 5)).astype(np.float32)
    colors = rng.random((7, 5, 4)).astype(np.float16)
    last = before.copy()
    pixel, ids, opacity = changed(now, colors.view(np.uint16), last, (3, 2, 20), HALVES)
    row, column = np.nonzero((now != before) & (now > 0))
    assert len(row) and ((now != before) & (now == 0)).any()  # both kinds are there
    np.testing.assert_array_equal(pixel, (row + 2) * 20 + column + 3)
    np.testing.assert_array_equal(ids, now[row, column])
    np.testing.assert_array_equal(opacity, colors[row, column, 3].astype(float))
    np.testing.assert_array_equal(last, now)


def test_without_colours_a_level_is_opaque():
    ids, none = np.ones((2, 2), np.float32), np.zeros((0, 0, 4), np.uint16)
    _, _, opacity = changed(ids, none, np.zeros((2, 2), np.float32), (0, 0, 2), HALVES)
    assert opacity.tolist() == [1.0] * 4


@pytest.mark.parametrize("seed", range(5))
def test_a_part_holds_its_objects_and_a_pixel_about_them(seed):
    """Within the picture: also of extents that lie outside of it or hold no end."""
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-20, 120, (6, 2)), rng.uniform(0, 30, (6, 2))
    extents = np.hstack([middle - half, middle + half])
    extents[0, 0], extents[1, 3] = -np.inf, np.inf
    size = np.array([90, 70])
    for objects in (np.array([2]), np.array([0, 3]), np.arange(6)):
        low, high = extents[objects, :2].min(axis=0), extents[objects, 2:].max(axis=0)
        part = np.array(around(extents, objects, *size.tolist()))
        if (low < size).all() and (high > 0).all():
            np.testing.assert_array_equal(part[:2], np.clip(np.floor(low) - 1, 0, size))
            np.testing.assert_array_equal(part[2:], np.clip(np.ceil(high) + 1, 0, size))
        else:  # beside the picture: empty, or its border
            assert ((part[2:] - part[:2]) <= 1).any()
        assert (part >= 0).all() and (part <= np.tile(size, 2)).all()


def test_sums_of_a_look_are_those_of_arrays(rng):
    """Count, weight, place and area of objects in layers of noise, added up with `bincount`."""
    height, width, objects = 9, 13, 6
    picture = rng.integers(0, 256, (height, width, 3)).astype(np.uint8)
    layers = []
    for _ in range(4):
        where = np.sort(rng.choice(height * width, 80, replace=False))
        layers.append((where, rng.integers(1, objects + 3, 80), rng.random(80)))
    which, pixel, share = shares(layers, height * width, objects)
    left, expected = np.ones(height * width), {}
    for where, ids, alpha in reversed(layers):
        for p, i, a in zip(where, ids, alpha, strict=True):
            if i <= objects:  # what a technique adds is nobody's, and hides nothing of anybody
                expected[i - 1, p] = expected.get((i - 1, p), 0.0) + left[p] * a
                left[p] *= 1 - a
    found = {}
    for i, p, s in zip(which.tolist(), pixel.tolist(), share.tolist(), strict=True):
        assert s >= SEEN
        found[i, p] = found.get((i, p), 0.0) + s
    for key, value in expected.items():  # parts under a 64th are left out, one by one
        assert abs(found.get(key, 0.0) - value) <= 4 * SEEN
    count, weight, position, _, area = measured(which, pixel, share, picture, objects)
    total = np.bincount(which, share, objects)
    np.testing.assert_array_equal(count, np.bincount(which, minlength=objects))
    np.testing.assert_allclose(weight, total / count, rtol=1e-12)  # sums of some hundred numbers
    across, down = pixel % width + 0.5, pixel // width + 0.5
    middle = [np.bincount(which, share * at, objects) / total / height for at in (across, down)]
    np.testing.assert_allclose(position, np.column_stack(middle), rtol=1e-12)
    np.testing.assert_allclose(area, total / (height * width), rtol=1e-12)
