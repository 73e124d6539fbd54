"""Planes between hulls: found where one can be, and on the right side of the eye."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from seethrough.renderer.plan.comparing import BEHIND, IN_FRONT, NEITHER, UNCERTAIN, compare
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.plan.separation import separate
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency


def widest(a, b):
    """The largest gap along a normal in the cube of side 2: a linear program knows no iteration."""
    cost = np.zeros(5)
    cost[3:] = -1, 1
    rows = np.block(
        [[-a, np.ones((len(a), 1)), np.zeros((len(a), 1))],
         [b, np.zeros((len(b), 1)), -np.ones((len(b), 1))]]
    )  # fmt: skip
    limits = [(-1, 1)] * 3 + [(None, None)] * 2
    return -linprog(cost, rows, np.zeros(len(rows)), bounds=limits).fun


@pytest.mark.parametrize("seed", range(40))
def test_a_plane_is_found_where_a_linear_program_finds_one(seed):
    """Clouds from deep inside each other to well apart; no plane unless all points respect it."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(30, 3)) * rng.uniform(0.2, 2, 3)
    b = rng.normal(size=(20, 3)) + rng.normal(size=3) * rng.uniform(0, 4)
    plane = separate(a, b, 1e-9)
    gap = widest(a, b)
    if plane[:3].any():
        assert (a @ plane[:3]).min() == pytest.approx(plane[3])
        assert (b @ plane[:3]).max() == pytest.approx(plane[4])
        assert plane[3] > plane[4]
        assert gap > 0
    else:
        # A hundred steps end within a hundredth of the clouds' size.
        assert gap < 0.05


def test_who_is_in_front_depends_on_the_side_of_the_eye():
    """Two cones, tip beside tip, whose boxes meet; seen from both ends and from between."""
    cone = geometry.cone(1.0, 2.0, 24)
    up = Object(cone, transforms.translation(0, 0, 0))
    down = Object(cone, transforms.placed(np.array([1.1, 0, 0]), transforms.rotation_x(np.pi)))
    scene = Scene((up, down))
    pair = np.array([[0, 1]])
    assert scene.separations.relation(np.zeros(3))[0, 1] == UNCERTAIN
    assert scene.separations.learn(pair, scene)
    for x, found in ((-9.0, IN_FRONT), (9.0, BEHIND)):
        known = scene.separations.relation(np.array([x, 0, 0]))
        assert known[0, 1] == found
        assert known[1, 0] == -found
    normal, low, high = np.split(scene.separations.planes[0], [3, 4])
    between = normal * (low + high) / 2
    assert scene.separations.relation(between)[0, 1] == NEITHER


def test_a_plan_is_certain_of_hulls_that_do_not_meet():
    """The boxes of the cones meet, and nothing is sorted by pixel all the same."""
    cone = geometry.cone(1.0, 2.0, 24)
    turned = transforms.placed(np.array([1.1, 0, 0.3]), transforms.rotation_x(np.pi))
    target = Object(geometry.box(6, 6, 0.2), transforms.translation(0, 0, -4), target=True)
    camera = look_at(np.array([0.4, 0.5, 12.0]), np.zeros(3), fov_y=0.8, near=1, far=50)
    technique = DynamicTransparency(doubt=0.0)
    apart = Scene((Object(cone), Object(cone, turned), target))
    assert not len(plan(apart, camera, technique, (400, 300)).exact)
    nearer = replace(apart.objects[1], transform=transforms.translation(0.4, 0, 0.3))
    crossing = replace(apart, objects=(apart.objects[0], nearer, target))
    assert len(plan(crossing, camera, technique, (400, 300)).exact)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_boxes_that_touch_are_separated_but_for_rounding(scale):
    """Sides of a third meet where no float lies: apart, face to face and by less than rounding, but
    not by a millionth of their size."""
    half = np.array([1 / 3, 1 / 3, 1 / 3]) * scale
    sides = np.tile(np.diag(half), (2, 1, 1))
    far, near = np.full(2, 100.0 * scale), np.full(2, -1.0)  # depths say nothing
    radii = np.full(2, 10.0 * scale)
    for turn in (np.eye(3), transforms.rotation_y(0.3)[:3, :3], transforms.rotation_x(1.1)[:3, :3]):
        for gap, separated in ((0.01, True), (0.0, True), (-1e-12, True), (-1e-6, False)):
            centers = scale * np.array([[0.1, 0.2, -5.0], [0.1, 0.2, -5.0 - (2 / 3 + gap)]])
            found = compare(centers @ turn.T, sides @ turn.T, radii, near, far, 0, 1)
            assert (found != UNCERTAIN) == separated, gap
            if separated:
                assert found == IN_FRONT
