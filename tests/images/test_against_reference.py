"""The GPU's pictures against the exact ones, at every pixel that is not on an edge."""

from __future__ import annotations

import numpy as np
import pytest
from sample_scenes import before_column, column

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (160, 120)
# Issue 2: half a step of rounding, and what 16-bit alpha and 32-bit shading add.
TOLERANCE = 2.0


def difference(renderer, scene, camera, technique):
    """Largest channel difference at each pixel in steps of 1/255, and where it must hold."""
    renderer.draw(scene, camera, technique)
    truth = exact(scene, camera, technique, renderer.size)
    apart = np.abs(renderer.read() - truth.picture * 255).max(axis=2)
    assert truth.near_edge.mean() < 0.01
    return apart[~truth.near_edge]


@pytest.mark.parametrize("seed", range(8))
def test_dynamic_transparency_is_the_exact_picture(context, seed):
    """Spheres, cones, boxes and tori as targets and occluders, half the time with impenetrables."""
    scene = column(seed, impenetrable=0.3 * (seed % 2))
    technique = DynamicTransparency(width=8)
    renderer = Renderer(context, SIZE)
    apart = difference(renderer, scene, before_column(seed), technique)
    assert apart.max() <= TOLERANCE
    shown = renderer.read()
    renderer.draw(scene, before_column(seed), Standard())
    changed = (shown != renderer.read()).any(axis=2).mean()
    assert changed > 0.02  # the technique had something to do


def test_standard_is_the_exact_picture(context):
    """Every pixel shows the nearest surface, lit."""
    renderer = Renderer(context, SIZE)
    assert difference(renderer, column(1), before_column(1), Standard()).max() <= TOLERANCE


@pytest.mark.parametrize(
    ("alpha_target", "alpha_edge", "width"), [(0, 1, 3), (1, 0, 20), (0.5, 0.2, 0)]
)
def test_parameters_reach_the_shaders(context, alpha_target, alpha_edge, width):
    """The extremes of every parameter, no gradient included."""
    technique = DynamicTransparency(alpha_target, alpha_edge, width)
    apart = difference(Renderer(context, SIZE), column(4), before_column(4), technique)
    assert apart.max() <= TOLERANCE


def test_look_finds_the_reference_shares(context):
    """Pixels and area of each object as the exact picture has them; edges may move a few."""
    scene, camera = column(7), before_column(7)
    technique = DynamicTransparency(width=8)
    seen = Renderer(context, SIZE).look(scene, camera, technique, SIZE)
    truth = exact(scene, camera, technique, SIZE)
    weights = np.where(truth.weights >= 1 / 64, truth.weights, 0)
    assert np.abs(seen.area * SIZE[0] * SIZE[1] - weights.sum(axis=(1, 2))).max() < 2
    # The width of a mask is 8 pixels of the window, which look() here shows at the same size.
    assert np.abs(seen.pixels - (weights > 0).sum(axis=(1, 2))).max() <= 4
    rows, columns = np.mgrid[0 : SIZE[1], 0 : SIZE[0]] + 0.5
    total = weights.sum(axis=(1, 2))
    there = total > 10
    x = (weights * columns).sum(axis=(1, 2))[there] / total[there] / SIZE[1]
    y = (weights * rows).sum(axis=(1, 2))[there] / total[there] / SIZE[1]
    np.testing.assert_allclose(seen.position[there], np.stack([x, y], axis=1), atol=0.005)


def test_look_sees_through_occluders_only_with_dynamic_transparency(context):
    """Targets that the standard picture hides appear, and not at full strength."""
    scene, camera = column(0), before_column(0)
    renderer = Renderer(context, (640, 480))
    plain = renderer.look(scene, camera, Standard())
    through = renderer.look(scene, camera, DynamicTransparency())
    targets = scene.targets
    assert (through.pixels[targets] >= plain.pixels[targets]).all()
    gained = targets & (through.pixels > plain.pixels + 20)
    assert gained.any()
    assert (through.weight[gained] < 1).all()
    assert (plain.weight[plain.visible] == 1).all()


def test_look_leaves_the_frame_alone(context):
    """A participant's frame is what draw() made, also after somebody looked."""
    renderer = Renderer(context, SIZE)
    renderer.draw(column(2), before_column(2), Standard())
    before = renderer.read()
    renderer.look(column(3), before_column(3), DynamicTransparency())
    np.testing.assert_array_equal(renderer.read(), before)
