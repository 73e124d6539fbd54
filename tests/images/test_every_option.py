"""Every combination of the technique's options against the exact picture."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from sample_scenes import before_column, column

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.techniques.dynamic.dynamic_transparency import (
    GRANULARITIES,
    MASKS,
    MODES,
    DynamicTransparency,
)
from seethrough.renderer.techniques.standard.opaque import Standard

SIZE = (96, 72)
BASE = DynamicTransparency(width=7, pointer=(0.65, 0.5), radius=0.25, softness=0.2)
SCENE, CAMERA = column(1, count=10, impenetrable=0.2), before_column(1)
# Half a step of rounding, and what 16-bit colours in the slices add.
EXACT_TOLERANCE = 1.0


def apart(renderer, technique, scene=SCENE, camera=CAMERA):
    """Largest channel difference from the exact picture off the edges, in steps of 1/255."""
    renderer.draw(scene, camera, technique)
    truth = exact(scene, camera, technique, renderer.size)
    difference = np.abs(renderer.read() - truth.picture * 255).max(axis=2)
    assert truth.near_edge.mean() < 0.01
    return difference[~truth.near_edge].max()


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE)


@pytest.mark.parametrize("granularity", GRANULARITIES)
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("mask", MASKS)
def test_granularity_mode_mask_and_layer_limit(renderer, granularity, mode, mask):
    """With no layer limit and with two layers: 96 combinations in all."""
    for layers in (None, 2):
        technique = replace(BASE, granularity=granularity, mode=mode, mask=mask, layers=layers)
        tolerance = EXACT_TOLERANCE if technique.per_pixel_only else 2.0
        assert apart(renderer, technique) <= tolerance, layers


@pytest.mark.parametrize(
    ("model", "combine", "tau"),
    list(product(("multiplicative", "additive"), ("product", "min"), (0.0, 0.4))),
)
def test_models_of_transparency_and_the_guarantee(renderer, model, combine, tau):
    """How masks and layers add up, exactly."""
    technique = replace(BASE, model=model, combine=combine, min_transmittance=tau, exact=True)
    assert apart(renderer, technique) <= EXACT_TOLERANCE


@pytest.mark.parametrize("combine", ["product", "min"])
def test_least_mask_without_sorting_pixels(renderer, combine):
    """The fast path combines masks both ways."""
    assert apart(renderer, replace(BASE, combine=combine)) <= 2.0


@pytest.mark.parametrize("seed", range(20))
def test_exact_on_the_gpu_is_exact(renderer, seed):
    """Twenty scenes, objects that intersect and coincide in the picture's order included."""
    rng = np.random.default_rng(seed)
    loose = column(seed, count=12)
    moved = [
        replace(o, transform=np.vstack([o.transform[:3] + pull, o.transform[3:]]))
        for o in loose.objects
        for pull in [np.outer([0, 0, 1], [0, 0, 0, rng.uniform(-4, 4)])]
    ]
    scene = replace(loose, objects=tuple(moved))
    technique = replace(BASE, exact=True)
    assert apart(renderer, technique, scene, before_column(seed)) <= EXACT_TOLERANCE


def test_things_are_impenetrable_until_the_viewer_is_near(renderer):
    """Only what is near turns transparent, in the exact and in the fast picture."""
    for sorted_by_pixel in (False, True):
        technique = replace(BASE, penetrable_within=15.0, exact=sorted_by_pixel)
        assert apart(renderer, technique) <= 2.0
    pictures = []
    for distance in (1.0, 15.0, None):
        renderer.draw(SCENE, CAMERA, replace(BASE, penetrable_within=distance))
        pictures.append(renderer.read())
    renderer.draw(SCENE, CAMERA, Standard())
    np.testing.assert_array_equal(pictures[0], renderer.read())  # all of it is farther
    assert (pictures[0] != pictures[2]).any()


def test_without_a_pointer_active_mode_is_the_standard_picture(renderer):
    """No light, no transparency."""
    dark = replace(BASE, mode="active", pointer=None)
    assert apart(renderer, dark) <= 1.0
