"""The approximations where the answer is known: closed forms, and chance by its error."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.levels.approximations import (
    PeelingPainter,
    StochasticPainter,
    WeightedPainter,
)
from seethrough.renderer.gpu.levels.polygon_painter import Corners, ExactPainter, PolygonPainter
from seethrough.renderer.polygons.polygons import polygons_from
from seethrough.renderer.polygons.prepared import drawable
from seethrough.renderer.scene.camera import look_at

SIZE = (48, 36)
BACKGROUND = (0.2, 0.4, 0.6)
CAMERA = look_at(np.array([0.0, 0.0, 12.0]), np.zeros(3))
SHEET = np.array([[-30.0, -30, 0], [30, -30, 0], [30, 30, 0], [-30, 30, 0]])
RANGE = (2.0, 16.0)
HALF = 2**-10  # half floats hold eleven bits
# Their rounding in each of the five blends, and in the weighted sums and what they are divided by.
ROUNDING = 5 * HALF


@pytest.fixture(scope="module")
def painter():
    context = standalone(430)
    made = PolygonPainter(context, SIZE, BACKGROUND)
    yield made
    made.release()
    context.release()


def sheets(heights, colors):
    """Sheets across the whole view, in the order given: (n,) heights, (n, 4) colours."""
    columns = [np.hstack([np.tile(c, (4, 1)), np.zeros((4, 3))]) for c in colors]
    polygons = polygons_from([SHEET + np.array([0, 0, h]) for h in heights], columns)
    drawn = drawable(polygons, np.arange(len(polygons)))
    return Corners.of(drawn.polygons.vertices, drawn.polygons.attributes, drawn.triangles)


def over(heights, colors, layers=None, result=BACKGROUND):
    """The nearest `layers` sheets over one another and what lies behind, by hand."""
    result = np.array(result)
    for k in np.argsort(heights)[-(layers or len(heights)) :]:
        result = colors[k, 3] * colors[k, :3] + (1 - colors[k, 3]) * result
    return result


@pytest.fixture
def five():
    rng = np.random.default_rng(4)
    return rng.permutation(5).astype(float), rng.uniform(0.1, 0.9, (5, 4))


def middle(picture):
    """The picture's one colour."""
    assert np.ptp(picture[..., :3], axis=(0, 1)).max() <= ROUNDING
    return picture[SIZE[1] // 2, SIZE[0] // 2, :3]


@pytest.mark.parametrize("passes", [1, 2, 3, 4, 5, 8])
def test_peeling_shows_the_nearest_layers_and_all_with_passes_enough(painter, five, passes):
    heights, colors = five
    picture = PeelingPainter(painter).painted(sheets(heights, colors), CAMERA, passes)
    expected = over(heights, colors, min(passes, 5))
    assert middle(picture) == pytest.approx(expected, abs=ROUNDING)


def test_weighted_blending_is_exact_for_one_sheet_and_for_equal_colours(painter, five):
    heights, colors = five
    weighted = WeightedPainter(painter)
    one = weighted.painted(sheets(heights[:1], colors[:1]), CAMERA, RANGE)
    assert middle(one) == pytest.approx(over(heights[:1], colors[:1]), abs=ROUNDING)
    colors[:, :3] = colors[0, :3]
    equal = weighted.painted(sheets(heights, colors), CAMERA, RANGE)
    assert middle(equal) == pytest.approx(over(heights, colors), abs=ROUNDING)


def test_weighted_blending_gives_the_weighted_mean_of_its_equation(painter, five):
    heights, colors = five
    depth = (12.0 - heights - RANGE[0]) / (RANGE[1] - RANGE[0])
    weights = colors[:, 3] * np.clip(0.03 / (1e-5 + depth**4), 1e-2, 3e3)
    mean = (weights[:, None] * colors[:, :3]).sum(axis=0) / weights.sum()
    through = np.prod(1 - colors[:, 3])
    expected = (1 - through) * mean + through * np.array(BACKGROUND)
    picture = WeightedPainter(painter).painted(sheets(heights, colors), CAMERA, RANGE)
    assert middle(picture) == pytest.approx(expected, abs=ROUNDING)
    assert np.abs(expected - over(heights, colors)).max() > 10 * ROUNDING


def test_chance_is_unbiased_and_spreads_as_its_standard_error_says(painter, five):
    """The mean of all pixels lies on the exact colour; a pixel is off by √(variance / draws)."""
    heights, colors = five
    draws = 16
    picture = StochasticPainter(painter).painted(sheets(heights, colors), CAMERA, draws)
    nearest = np.argsort(heights)[::-1]
    shares = colors[nearest, 3] * np.cumprod([1, *(1 - colors[nearest, 3])])[:-1]
    shown = np.vstack([colors[nearest, :3], BACKGROUND])
    chances = np.append(shares, 1 - shares.sum())
    mean = chances @ shown
    deviation = np.sqrt(chances @ (shown - mean) ** 2)
    assert mean == pytest.approx(over(heights, colors), abs=1e-12)
    pixels = SIZE[0] * SIZE[1]
    values = picture[..., :3].reshape(-1, 3)
    # Five standard errors: one run in two million is outside, and this one is always the same.
    error = 5 * deviation / np.sqrt(pixels * draws) + HALF
    assert (np.abs(values.mean(axis=0) - mean) < error).all()
    spread = values.std(axis=0) / (deviation / np.sqrt(draws))
    assert np.abs(spread - 1).max() < 5 / np.sqrt(2 * pixels)


def test_more_draws_and_other_draws_are_other_pictures(painter, five):
    chance, stack = StochasticPainter(painter), sheets(*five)
    parts = [chance.painted(stack, CAMERA, 4, first) for first in (0, 4)]
    assert np.abs(parts[0] - parts[1]).max() > 0.05
    both = chance.painted(stack, CAMERA, 8)
    assert both == pytest.approx((parts[0] + parts[1]) / 2, abs=HALF)
    assert np.array_equal(both, chance.painted(stack, CAMERA, 8))


def test_what_is_opaque_hides_what_lies_behind_in_every_way(painter, five):
    heights, colors = five
    stack = sheets(heights, colors)
    painter.opaque = sheets([1.5], np.array([[0.9, 0.5, 0.1, 1.0]]))
    try:
        truth = ExactPainter(painter).painted(stack, CAMERA)
        seen = heights > 1.5
        expected = over(heights[seen], colors[seen], result=(0.9, 0.5, 0.1))
        assert middle(truth) == pytest.approx(expected, abs=ROUNDING)
        peeled = PeelingPainter(painter).painted(stack, CAMERA, 5)
        assert middle(peeled) == pytest.approx(expected, abs=ROUNDING)
        front = [sheets(heights[seen], colors[seen]), stack]
        one, other = (WeightedPainter(painter).painted(s, CAMERA, RANGE) for s in front)
        assert np.array_equal(one, other)
        drawn = StochasticPainter(painter).painted(stack, CAMERA, 64)
        # 64 draws of 1,728 pixels of a deviation of one half at most, five standard errors.
        assert drawn[..., :3].mean(axis=(0, 1)) == pytest.approx(expected, abs=0.0076 + HALF)
    finally:
        painter.opaque = None
