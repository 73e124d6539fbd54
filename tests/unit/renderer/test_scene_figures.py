"""The gallery's scenes, and those that orderings are measured on, are what they were when their
figures were written down."""

import json

import numpy as np
import pytest
from scene_figures import FIGURES, ORDERED, everything

from seethrough.renderer.models.translucent.scenes import SCENES

KNOWN = json.loads(FIGURES.read_text("utf-8"))


@pytest.fixture(scope="module")
def made():
    return everything()


def differences(found, known, where=""):
    """Paths at which two trees of numbers, texts and lists are not alike."""
    if isinstance(known, dict) and isinstance(found, dict):
        keys = set(known) ^ set(found)
        parts = [differences(found[k], known[k], f"{where}.{k}") for k in set(known) & set(found)]
    elif isinstance(known, list) and isinstance(found, list) and len(known) == len(found):
        keys = ()
        parts = [differences(a, b, f"{where}[{n}]")
                 for n, (a, b) in enumerate(zip(found, known, strict=True))]  # fmt: skip
    elif isinstance(known, float) and isinstance(found, int | float):
        # Nine digits are written down; libraries of mathematics differ in the last, and what
        # cancels in a sum of thousands leaves their rounding.
        same = found == pytest.approx(known, rel=1e-6, abs=1e-6)
        return [] if same else [f"{where}: {found} for {known}"]
    else:
        return [] if found == known else [f"{where}: {found} for {known}"]
    return [f"{where}.{k}" for k in keys] + [line for part in parts for line in part]


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
