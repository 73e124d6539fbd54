"""What `look` says is to be seen, where a frame is sorted by pixel in part or as a whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.benchmarks.drawing.breaking import crossings, small_crossings
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene.visibility import SEEN
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE = (120, 90)
TECHNIQUE = DynamicTransparency(width=5)


@pytest.mark.parametrize(
    ("make", "doubt", "whole"), [(crossings, 0.05, True), (small_crossings, 0.0, False)]
)
def test_what_is_sorted_by_pixel_is_seen(context, make, doubt, whole):
    """As many pixels of each target as the reference shows, also where the plan sorts parts."""
    scene, cameras = make(4 / 3, 2)
    technique = replace(TECHNIQUE, doubt=doubt)
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, cameras[0], technique)
    assert len(renderer.plan.exact) and (len(renderer.plan.levels) == 0) == whole
    seen = renderer.look(scene, cameras[0], technique, SIZE)
    truth = exact(scene, cameras[0], technique, SIZE)
    shown = (truth.weights >= SEEN).sum(axis=(1, 2))
    targets = scene.targets & (shown > 0)
    assert targets.sum() >= 5
    # Coverage and the threshold differ at single pixels of an edge.
    np.testing.assert_allclose(seen.pixels[targets], shown[targets], rtol=0.05, atol=4)
    weight = np.array([w[w >= SEEN].mean() for w in truth.weights[targets]])
    np.testing.assert_allclose(seen.weight[targets], weight, atol=0.03)
