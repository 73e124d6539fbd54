"""The adaptive cut-away's hole, asked in blocks of pixels, against the one asked at each."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.techniques.adaptive_cutaway import cones

WIDTH, HEIGHT = 320, 240
LENS, TANGENT = 300.0, 0.36
WHOLE = (0, 0, WIDTH, HEIGHT)


def discs(seed):
    """(h, w) depths of some discs that face the viewer, 0 beside them."""
    rng, count = np.random.default_rng(seed), 14
    down, across = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    places = rng.uniform((0, 0, 3, 10), (WIDTH, HEIGHT, 14, 40), (count, 4))
    depth = np.zeros((HEIGHT, WIDTH), np.float32)
    for x, y, radius, far in places:
        within = np.hypot(across - x, down - y) < radius
        depth[within] = np.maximum(depth[within], far)
    return depth


def test_the_border_is_seldom_more_than_four_pixels_off():
    """What may be: 1 % of it. Without the points of the blocks beside it would be 2.7 %."""
    off = []
    for seed in range(8):
        depth = discs(seed)
        exact = cones.of_pixels(depth, LENS, TANGENT).astype(float)
        blocks = cones.of_blocks(depth, LENS, TANGENT, WHOLE)
        slope = np.hypot(*np.gradient(exact))
        known = (exact > 0) & (depth == 0) & (slope > 0)
        off.append(np.abs(blocks - exact)[known] / slope[known])
        assert (blocks <= exact * (1 + 1e-6)).all()  # of fewer points no hole is deeper
    assert (np.concatenate(off) > 4).mean() <= 0.01


def test_a_part_of_the_picture_is_what_the_whole_has_there():
    """In blocks that the part touches; beside them there is no hole."""
    part = (70, 37, 201, 160)
    left, top, right, bottom = 64, 32, 208, 160
    for seed in range(4):
        depth = discs(seed)
        whole = cones.of_blocks(depth, LENS, TANGENT, WHOLE)
        found = cones.of_blocks(depth, LENS, TANGENT, part)
        np.testing.assert_array_equal(found[top:bottom, left:right], whole[top:bottom, left:right])
        found[top:bottom, left:right] = 0
        assert not found.any()
