"""Which blocks of pixels hold lists, against a look at every pixel."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.gpu.rules.list_blocks import beside, held_in

BLOCK = 8


@pytest.mark.parametrize("size", [(64, 40), (61, 35), (3, 5)])
@pytest.mark.parametrize("seed", range(4))
def test_blocks_are_those_of_the_pixels_within_the_scope(size, seed):
    """Rows of blocks come from the top, rows of pixels from the bottom."""
    rng = np.random.default_rng(seed)
    width, height = size
    heads = (rng.random((height, width)) < 0.02).astype(np.uint32) * 7
    left, bottom = int(rng.integers(width)), int(rng.integers(height))
    scope = (left, bottom, width - left - seed % 2, height - bottom)
    expected = np.zeros((-(-height // BLOCK), -(-width // BLOCK)), bool)
    for y, x in np.argwhere(heads):
        if left <= x < scope[0] + scope[2] and bottom <= y < scope[1] + scope[3]:
            expected[(height - 1 - y) // BLOCK, x // BLOCK] = True
    assert np.array_equal(held_in(heads, scope), expected)


def test_beside_are_the_four_about_a_block():
    held = np.zeros((5, 6), bool)
    held[[0, 3], [0, 4]] = True
    expected = {(0, 0), (1, 0), (0, 1), (3, 4), (2, 4), (4, 4), (3, 3), (3, 5)}
    assert {(int(y), int(x)) for y, x in np.argwhere(beside(held))} == expected
