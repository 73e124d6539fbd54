"""The gallery's scenes, and those that orderings are measured on, are what they were when their
figures were written down."""

import json

import numpy as np
import pytest
from alike import differences
from scene_figures import FIGURES, ORDERED, everything

from seethrough.renderer.models.translucent.scenes import SCENES

KNOWN = json.loads(FIGURES.read_text("utf-8"))


@pytest.fixture(scope="module")
def made():
    return everything()


def test_every_scene_has_its_figures(made):
    assert set(KNOWN) == set(made)


@pytest.mark.parametrize("name", sorted(KNOWN))
def test_a_scene_is_what_it_was(name, made):
    """python tests/support/scene_figures.py writes them, where a scene is changed on purpose."""
    assert differences(made[name], KNOWN[name]) == []


def test_a_difference_is_found():
    assert differences({"a": [1.0, 2.0]}, {"a": [1.0, 2.0]}) == []
    assert differences({"a": [1.0, 2.1]}, {"a": [1.0, 2.0]}) == [".a[1]: 2.1 for 2.0"]
    assert differences({"a": [1.0]}, {"a": [1.0, 2.0]}) != []
    assert differences({"a": "x"}, {"b": "x"}) != []


@pytest.mark.parametrize("name", ORDERED)
def test_polygons_have_corners_of_their_own_and_an_area(name):
    """No corner twice in a row, and none of them a line."""
    scene = SCENES[name]()
    for polygons in (scene.polygons, scene.opaque):
        for k in range(len(polygons) if polygons else 0):
            corners = polygons.corners(k)
            sides = np.roll(corners, -1, axis=0) - corners
            assert np.linalg.norm(sides, axis=1).min() > 1e-6
            area = np.linalg.norm(np.cross(corners - corners[0], sides).sum(axis=0)) / 2
            assert area > 1e-6 * np.square(np.ptp(corners, axis=0)).sum()
