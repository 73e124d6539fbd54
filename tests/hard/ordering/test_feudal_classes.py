"""Members of a class may be drawn in any order: shuffled, against the rational oracle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.polygons import polygons_from


@dataclass
class Shuffled:
    """A feudal priority list with the members of each class, or all of it, in random order."""

    prepared: feudal.PreparedFeudal
    rng: np.random.Generator
    within: bool = True

    @property
    def drawable(self):
        return self.prepared.drawable

    def order(self, eye):
        classes = self.prepared.classes(eye=eye)
        if not self.within:
            classes = [np.concatenate(classes)]
        shuffled = [self.rng.permutation(members) for members in classes]
        return self.drawable.triangle_order(np.concatenate(shuffled))


def soup(count, seed):
    rng = np.random.default_rng(seed)
    return list(rng.random((count, 1, 3)) + rng.normal(size=(count, 3, 3)) * 0.3)


def steps():
    """Boxes side by side and on one another, with coplanar faces that do not overlap."""
    loops = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    faces = []
    for low in ((0, 0, 0), (2, 0, 0), (0, 2, 0), (2, 0, 2), (4, 0, 2)):
        corners = np.array([[k >> i & 1 for i in range(3)] for k in range(8)]) * 1.5 + low
        faces += [corners[list(loop)] for loop in loops]
    return faces


def two_sided():
    """Sheets over each other, each of a half that faces up and one that faces down."""
    half = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0]])
    faces = []
    for z in range(3):
        up = half + np.array([0.1 * z, 0.0, z])
        faces += [up, up[::-1] + np.array([1.0, 0.0, 0.0])]
    return faces


CASES = {"soup": lambda: soup(24, 3), "steps": steps, "two_sided": two_sided}


@pytest.mark.parametrize("version", feudal.VERSIONS)
@pytest.mark.parametrize("case", CASES)
def test_the_members_of_a_class_hide_nothing_of_each_other(case, version, oracle):
    polygons = polygons_from(CASES[case]())
    prepared = feudal.prepare(polygons, version)
    shuffled = Shuffled(prepared, np.random.default_rng(6))
    sizes = [len(c) for c in prepared.classes(eye=np.array([9.0, 8.0, 7.0]))]
    assert version == "dynamic" or max(sizes) > 1
    assert oracle.wrong_pairs(polygons, shuffled, np.random.default_rng(7), eyes=6, rays=10) == []


def test_shuffling_all_classes_together_is_caught(oracle):
    polygons = polygons_from(soup(24, 3))
    mixed = Shuffled(feudal.prepare(polygons), np.random.default_rng(6), within=False)
    assert oracle.wrong_pairs(polygons, mixed, np.random.default_rng(7), eyes=6, rays=10) != []
