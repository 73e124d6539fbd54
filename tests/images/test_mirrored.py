"""Every mask of targets of every sign of determinant, against the exact picture.

A mirrored object turns its triangles and its outline round: whatever goes by their sense must know.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from sample_scenes import SHAPES

from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import MASKS, DynamicTransparency

SIZE = (128, 96)
SIGNS = list(product((1, -1), repeat=3))
CONE, TORUS = 1, 3
# Half a step of rounding, and what 16-bit alpha and 32-bit shading add (test_against_reference.py).
TOLERANCE = 2.0
# A cell of the paper's rings whose centre lies on an edge is rounded either way, in 32 bits and 64;
# it is looked up by 3 × 3 pixels, and `near_edge` knows of pixels' centres alone. Two of 16,384.
CELLS = 2 * 9


def camera(near=0.5):
    return Camera(np.zeros(3), np.eye(3), 0.9, near, 60.0)


def target(shape, sign, place, rng):
    scale = np.array(sign) * rng.uniform(0.6, 1.1, 3)
    placed = transforms.placed(place, transforms.random_rotation(rng), scale)
    return Object(SHAPES[shape], placed, tuple(rng.uniform(0.2, 1, 3)), target=True)


def pane(z, side):
    return Object(geometry.box(side, side, 0.05), transforms.translation(0, 0, z), (0.2, 0.4, 0.9))


def off(context, scene, view, technique):
    """Channels off by more than the tolerance, and whether the technique had anything to do."""
    renderer = Renderer(context, SIZE)
    renderer.draw(scene, view, technique)
    truth = exact(scene, view, technique, SIZE)
    assert truth.near_edge.mean() < 0.02
    apart = np.abs(renderer.read() - truth.picture * 255).max(axis=2)
    return int((apart[~truth.near_edge] > TOLERANCE).sum()), renderer.plan.masked.size


@pytest.mark.parametrize("sorted_by_pixel", [False, True])
@pytest.mark.parametrize("shape", [CONE, TORUS])
@pytest.mark.parametrize("mask", MASKS)
def test_every_sign_in_every_mask(context, mask, shape, sorted_by_pixel):
    """The eight signs side by side behind a pane, each turned as chance has it."""
    rng = np.random.default_rng(MASKS.index(mask))
    places = [(3.2 * (k % 4 - 1.5), 3.6 * (k // 4 - 0.5), -11.0) for k in range(8)]
    things = [target(shape, sign, p, rng) for sign, p in zip(SIGNS, places, strict=True)]
    dets = [np.linalg.det(o.transform[:3, :3]) for o in things]
    assert sum(d < 0 for d in dets) == 4
    technique = DynamicTransparency(mask=mask, width=6, exact=sorted_by_pixel)
    wrong, masked = off(context, Scene((*things, pane(-7.0, 20.0))), camera(), technique)
    assert masked == 8
    assert wrong <= (CELLS if mask == "ring" else 0)


@pytest.mark.parametrize("sign", SIGNS)
@pytest.mark.parametrize("shape", [CONE, TORUS])
def test_every_sign_cut_by_the_near_plane(context, shape, sign):
    """Open towards the viewer, behind a pane that nearly touches the eye, in each kind of mask."""
    rng = np.random.default_rng(SIGNS.index(sign))
    thing = target(shape, sign, (0.1, -0.1, -0.9), rng)
    scene = Scene((thing, pane(-0.3, 4.0)))
    for mask in MASKS:
        technique = DynamicTransparency(mask=mask, width=6, exact=True)
        wrong = off(context, scene, camera(0.25), technique)[0]
        assert wrong <= (CELLS if mask == "ring" else 0), mask


def test_a_mirrored_target_has_the_mask_of_its_mirror_image(context):
    """A torus is its own mirror image: scaled by (−1, 1, 1) it is the same picture."""
    here = transforms.placed((0.4, 0.2, -6.0), transforms.rotation_y(0.7), 1.2)
    mirror = here @ np.diag([-1.0, 1, 1, 1])
    pictures = []
    for place in (here, mirror):
        scene = Scene((Object(SHAPES[TORUS], place, (1, 0, 0), True), pane(-3.0, 9.0)))
        renderer = Renderer(context, SIZE)
        renderer.draw(scene, camera(), DynamicTransparency(width=12))
        pictures.append(renderer.read().astype(int))
    # Other triangles show the same surface: shading differs, the pane's part of a pixel does not.
    assert (np.abs(pictures[0] - pictures[1]).max(axis=2) > 12).mean() < 0.001
