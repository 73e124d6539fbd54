"""What `look` says is to be seen, where a frame is sorted by pixel in part or as a whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough import registry
from seethrough.benchmarks.drawing.breaking import crossings, small_crossings
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.scene.visibility import SEEN
from seethrough.renderer.techniques import named
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


@pytest.mark.parametrize("name", registry.known("technique"))
def test_what_is_seen_does_not_depend_on_what_was_looked_at_before(context, name):
    """A crowd that fills the view, then three things in its middle."""
    rng = np.random.default_rng(4)
    crowd = Scene(tuple(
        Object(box(1, 1, 1), translation(*rng.uniform(-3, 3, 3)), target=k % 7 == 0)
        for k in range(90)
    ))  # fmt: skip
    few = Scene(tuple(
        Object(box(0.6, 0.6, 0.6), translation(0, 0, -z), target=z == 2) for z in range(3)
    ))  # fmt: skip
    camera = look_at(np.array([0.3, 0.2, 8.0]), np.zeros(3), fov_y=0.7, near=1, far=20)
    p = named(name)
    renderer = Renderer(context, (160, 120))
    renderer.look(crowd, camera, p, (80, 60))
    seen = renderer.look(few, camera, p, (80, 60))
    fresh = Renderer(context, (160, 120)).look(few, camera, p, (80, 60))
    for column in ("pixels", "weight", "position", "contrast", "area"):
        np.testing.assert_array_equal(getattr(seen, column), getattr(fresh, column))


HIDING = Object(box(6, 6, 0.1), translation(0, 0, 2), impenetrable=True)
THINGS = tuple(Object(box(1, 1, 1), translation(x, 0, 0), target=x == 0) for x in (-1.5, 0, 1.5))
NOTHING = {
    "all of it lies behind what stays opaque": ((HIDING, *THINGS), 8.0),
    "nothing is in view": (THINGS, -8.0),
    "nothing is asked for": (tuple(replace(o, target=False) for o in THINGS), -8.0),
    "no thing at all": ((), 8.0),
}


@pytest.mark.parametrize("name", registry.known("technique"))
@pytest.mark.parametrize("why", NOTHING)
def test_where_a_rule_has_nothing_to_draw_nothing_is_seen(context, name, why):
    things, far = NOTHING[why]
    scene = Scene(things)
    towards = np.array([0, 0, far * 2 if far < 0 else 0.0])  # away from all of them
    camera = look_at(np.array([0, 0, far]), towards, fov_y=0.4, near=1, far=20)
    seen = Renderer(context, (160, 120)).look(scene, camera, named(name), (80, 60))
    opaque = sum(o.impenetrable for o in things)
    assert (seen.pixels[opaque:] == 0).all() and (seen.pixels[:opaque] > 0).all()
