"""Which places in doubt are sorted by pixel: none at first, then more and more, then all."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT
from seethrough.renderer.plan.doubt import RAMP, chosen, union
from seethrough.renderer.plan.order import Related, doubtful

SIZE, SHARE = (800, 600), 0.05


def apart(count: int, side: float = 40.0) -> np.ndarray:
    """Boxes of about that side, in a grid so that none overlap."""
    row, column = np.divmod(np.arange(count), 15)
    grown = side + 0.5 * np.arange(count) / count
    low = np.stack([50.0 * column + 1, 50.0 * row + 1], axis=1)
    return np.concatenate([low, low + grown[:, None]], axis=1)


def test_what_is_allowed_stays():
    assert not len(chosen(apart(14), SIZE, SHARE))  # 14 · 1600 < 24,000
    assert not len(chosen(np.zeros((0, 4)), SIZE, 0.0))
    assert len(chosen(apart(1), SIZE, 0.0)) == 1


def test_overlapping_places_count_once():
    same = np.repeat(apart(1), 30, axis=0)
    assert union(same) == pytest.approx(1600)
    assert not len(chosen(same, SIZE, SHARE))


def test_it_begins_with_the_largest_and_grows_without_a_leap():
    """What is left is never more than allowed; one place more in doubt sorts two more at most."""
    counts = []
    for n in range(10, 70):
        boxes = apart(n)
        found = chosen(boxes, SIZE, SHARE)
        counts.append(len(found))
        area = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
        kept = (found[:, 2:] - found[:, :2]).prod(axis=1)
        assert area.sum() - kept.sum() <= SHARE * SIZE[0] * SIZE[1]
        assert not len(found) or kept.min() >= np.sort(area)[n - len(found)] - 1e-9
    assert (np.diff(counts) >= 0).all() and np.diff(counts).max() <= 2
    assert counts[0] == 0 and counts[-1] == 69  # 69 · 1600 > 4 · 24,000


def test_far_beyond_the_ramp_nothing_is_left():
    boxes = apart(100)
    assert union(boxes) > RAMP * SHARE * SIZE[0] * SIZE[1]
    assert len(chosen(boxes, SIZE, SHARE)) == 100


def test_the_area_of_boxes_that_overlap_is_that_of_their_pixels():
    """Whole pixels, so that counting them is exact."""
    rng = np.random.default_rng(4)
    for count in (1, 2, 7, 30):
        low = rng.integers(0, 60, (count, 2))
        boxes = np.concatenate([low, low + rng.integers(1, 25, (count, 2))], axis=1).astype(float)
        pixels = np.zeros((90, 90), bool)
        for left, top, right, bottom in boxes.astype(int).tolist():
            pixels[top:bottom, left:right] = True
        assert union(boxes) == pixels.sum()
    assert union(np.zeros((0, 4))) == 0


def test_the_mask_counts_as_its_targets_extent():
    """A target whose mask is wide, and a thing that overlaps the mask alone: the part in doubt is
    where the thing and the mask meet, as drawn on paper."""
    extents = np.array([[100.0, 100, 140, 140], [150, 110, 190, 130]])
    reach = np.array([[80.0, 80, 160, 160], [150, 110, 190, 130]])
    related = Related(
        np.array([0, 1]), extents, reach, np.array([[0, BEHIND], [IN_FRONT, 0]], np.int8),
        np.array([False, True]), np.array([True, False]),
    )  # fmt: skip
    doubt, no = np.array([[False, True], [True, False]]), np.zeros((2, 2), bool)
    found, _ = doubtful(related, doubt, no, no, np.array(SIZE, float))
    assert found.tolist() == [[150, 110, 160, 130]]
