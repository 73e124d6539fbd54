"""Which objects a picture for people is made of: those whose spheres reach into the view."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.experiment.session.viewpoint import _in_view
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import sphere
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation

DEPTH, ASPECT, FOV = 10.0, 4 / 3, 1.2
CAMERA = Camera(np.zeros(3), np.eye(3), FOV, 1.0, 50.0)
BALL = sphere(1.0, 2)
RADIUS = float(Scene((Object(BALL, translation(0, 0, 0)),)).radii[0])


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(("off", "inside"), [(-0.01, True), (0.01, False)])
def test_a_sphere_is_in_view_up_to_where_it_touches_the_side(axis, off, inside):
    """A plane through the eye with slope s lies (x − s·depth) / √(1 + s²) away."""
    slope = np.tan(FOV / 2) * (ASPECT if axis == 0 else 1.0)
    place = np.array([0.0, 0.0, -DEPTH])
    place[axis] = slope * DEPTH + (RADIUS + off) * np.hypot(1, slope)
    scene = Scene((Object(BALL, translation(*place)),))
    assert _in_view(scene, CAMERA, ASPECT).tolist() == [inside]


@pytest.mark.parametrize(
    ("depth", "inside"),
    [(1.0 - RADIUS - 0.01, False), (1.0 - RADIUS + 0.01, True),
     (50.0 + RADIUS - 0.01, True), (50.0 + RADIUS + 0.01, False)],
)  # fmt: skip
def test_a_sphere_is_in_view_up_to_the_near_and_the_far_plane(depth, inside):
    scene = Scene((Object(BALL, translation(0, 0, -depth)),))
    assert _in_view(scene, CAMERA, ASPECT).tolist() == [inside]
