"""Blocks of pixels: every block is in one rectangle, with the bits of what touches it."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.gpu.masks.rectangles import tiled
from seethrough.renderer.plan.blocks import (
    BLOCK,
    NONE,
    covered,
    grouped,
    mark,
    most,
    runs,
    shape,
    shown,
)

SHAPE = (9, 13)


@pytest.mark.parametrize("seed", range(8))
def test_rectangles_make_up_all_blocks_that_hold_anything(seed):
    """Each such block once, with its own bits; the others not at all."""
    rng = np.random.default_rng(seed)
    objects = rng.integers(0, 3, SHAPE).astype(np.uint64) << np.uint64(62)
    masks = rng.integers(0, 2, SHAPE).astype(np.uint64)
    part = np.array([2 * BLOCK + 3, BLOCK, 11 * BLOCK - 2, 8 * BLOCK + 1])
    found, bits = runs(objects, masks, part)
    times = np.zeros(SHAPE, int)
    for (left, top, right, bottom), (a, b) in zip(found // BLOCK, bits, strict=True):
        times[top:bottom, left:right] += 1
        assert (objects[top:bottom, left:right] == a).all()
        assert (masks[top:bottom, left:right] == b).all()
    wanted = np.zeros(SHAPE, int)
    wanted[1:9, 2:11] = objects[1:9, 2:11] != 0
    np.testing.assert_array_equal(times, wanted)


def test_a_box_covers_the_blocks_of_all_its_pixels():
    """Against a picture of the box; one that lies beyond the picture covers what is in it."""
    boxes = np.array([[7.9, 3.0, 24.1, 8.0], [-50.0, 60.0, 4.0, 1e9], [500.0, 0.0, 600.0, 10.0]])
    bits = covered(boxes, np.array([0, 63, 5]), SHAPE)
    first = np.zeros(SHAPE, bool)
    first[0:2, 0:4] = True
    np.testing.assert_array_equal((bits & np.uint64(1)) != 0, first)
    last = np.zeros(SHAPE, bool)
    last[7:, 0] = True
    np.testing.assert_array_equal(bits >> np.uint64(63) != 0, last)
    assert not (bits & np.uint64(1 << 5)).any()


def test_a_mask_touches_the_blocks_within_its_width():
    """One pixel of the target, and a width of 3: blocks of pixels at most 3 away."""
    rows, columns = np.mgrid[0:40, 0:40]
    distance = np.hypot(rows - 17, columns - 14).astype(np.float32)
    bits = np.zeros(SHAPE, np.uint64)
    mark(distance, 8, 16, 3.0, 63, bits)
    touched = bits == np.uint64(1) << np.uint64(63)
    assert (touched == (bits != 0)).all()
    near = distance <= 3
    expected = {(int(r + 16) // BLOCK, int(c + 8) // BLOCK) for r, c in np.argwhere(near)}
    assert {tuple(b) for b in np.argwhere(touched).tolist()} == expected


def test_blocks_of_a_part_come_with_their_bits():
    """Those with an object, once each, row by row; a picture that ends within a block counts."""
    rng = np.random.default_rng(5)
    objects = rng.integers(0, 2, SHAPE).astype(np.uint64) << np.uint64(40)
    masks = rng.integers(0, 5, SHAPE).astype(np.uint64)
    part = np.array([BLOCK, 2 * BLOCK, 13 * BLOCK - 3, 9 * BLOCK])
    found, bits = shown(objects, masks, part)
    inside = np.zeros(SHAPE, bool)
    inside[2:9, 1:13] = True
    rows, columns = np.nonzero(inside & (objects != 0))
    np.testing.assert_array_equal(found, np.stack([columns, rows], axis=1) * BLOCK)
    np.testing.assert_array_equal(bits, np.stack([objects, masks], axis=2)[rows, columns])


@pytest.mark.parametrize("every", [False, True])
def test_blocks_are_grouped_by_how_much_they_hold(every):
    """Every block once, in the least group that has room, with its words in the order of its bits;
    those with too many, and without `every` those without a mask, in none."""
    rng = np.random.default_rng(7)
    slices, masks = np.array([1, 2, 4]), np.array([0, 1, 3])
    found = rng.integers(0, 100, (200, 2)) * BLOCK
    bits = [
        [rng.choice([0, 3, 40, 63], n, False) for n in row] for row in rng.integers(0, 5, (200, 2))
    ]
    bits = [(a if len(a) else np.array([5]), b) for a, b in bits]
    which = np.array([[sum(1 << int(k) for k in a) for a in row] for row in bits], np.uint64)
    corners = np.arange(100, 164).astype(np.uint32)
    words = np.arange(195).reshape(65, 3).astype(np.uint32) + 1000
    rows, starts, over = grouped(found, which, corners, words, slices, masks, every)
    none, missing = words[-1], NONE
    expected = {}
    for k, (a, b) in enumerate(bits):
        assert over[k] == (len(a) > 4 or len(b) > 3)
        if over[k] or not (every or len(b)):
            continue
        key = np.searchsorted(slices, len(a)) * 3 + np.searchsorted(masks, len(b))
        row = [corners[i] for i in sorted(a)] + [missing] * (4 - len(a))
        for c in range(3):
            row += [words[i, c] for i in sorted(b)] + [none[c]] * (3 - len(b))
        expected.setdefault(int(key), []).append((*found[k].tolist(), *map(int, row)))
    assert len(starts) == 10 and starts[-1] == len(rows)
    for key in range(9):
        mine = rows[starts[key] : starts[key + 1]]
        place = mine[:, :2].copy().view(np.float32).astype(int)
        got = [(*p, *r) for p, r in zip(place.tolist(), mine[:, 2:].tolist(), strict=True)]
        assert got == expected.get(key, [])


@pytest.mark.parametrize("every", [False, True])
def test_few_blocks_are_one_group_of_what_is_enough_for_all(every):
    """One has most slices, another most masks; one too many and one no mask."""
    which = np.array([[0b1111, 0b1], [0b1, 0b111], [0b1, 0b11111], [0b1, 0]], np.uint64)
    found = np.arange(8).reshape(4, 2) * BLOCK
    corners, words = np.arange(64, dtype=np.uint32), np.zeros((65, 3), np.uint32)
    counts = np.array([1, 2, 4, 8]), np.array([0, 1, 3])
    args = found, which, corners, words, *counts, every
    rows, starts, over = grouped(*args, len(found))
    apart = grouped(*args, len(found) - 1)
    assert over.tolist() == apart[2].tolist() == [False, False, True, False]
    drawn = 3 if every else 2
    assert np.nonzero(np.diff(starts))[0].tolist() == [2 * 3 + 2]
    assert len(rows) == starts[-1] == drawn
    assert (np.diff(apart[1]) > 0).sum() == drawn
    assert sorted(map(tuple, rows.tolist())) == sorted(map(tuple, apart[0].tolist()))


def test_the_most_bits_are_counted_where_there_are_both():
    slices = np.array([[0b111, 0b11111, 0b1]], np.uint64)
    masks = np.array([[0b1, 0, 0b1111]], np.uint64)
    assert most(slices, masks).tolist() == [3, 4]
    assert most(slices, np.zeros_like(masks)).tolist() == [0, 0]


def test_every_block_that_a_mask_may_touch_lies_in_its_tile():
    """Also where what a mask reaches ends with a block: beyond the tile lies another target's."""
    rng = np.random.default_rng(2)
    size = (100, 76)
    low = rng.integers(-20, 80, (40, 2)) / 2
    reach = np.concatenate([low, low + rng.integers(1, 80, (40, 2)) / 2], axis=1)
    reach[:10] = np.round(reach[:10] / BLOCK) * BLOCK + [0, 0, BLOCK, BLOCK]
    tile, shift, _, _ = tiled(reach, np.arange(40), size)
    for k in range(40):
        bits = covered(reach[k : k + 1], np.zeros(1, np.int64), shape(size))
        rows, columns = np.nonzero(np.kron(bits != 0, np.ones((BLOCK, BLOCK), bool)))
        inside = (rows < size[1]) & (columns < size[0])
        pixels = np.stack([columns, size[1] - 1 - rows], axis=1)[inside] + shift[k]  # y up
        assert (pixels >= tile[k, :2]).all() and (pixels < tile[k, 2:]).all()
