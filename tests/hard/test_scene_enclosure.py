"""Enclosure against independent oracles: Qhull's volumes and libigl's winding numbers."""

import igl
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from seethrough.renderer.scene.geometry import torus
from seethrough.renderer.scene.scene import Object
from seethrough.renderer.scene.transforms import moved, placed, random_rotation
from seethrough.tasks.kit.enclosure import encloses, enclosing_pairs
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene, unit_mesh


def thing(shape, place=(0, 0, 0), scale=1.0, turn=None):
    return Object(unit_mesh(shape), placed(place, turn, scale), kind=shape)


def world(o):
    return moved(o.mesh.vertices, o.transform)


def hull_says(outer, inner):
    """For convex solids: adding what is enclosed leaves the hull's volume as it is."""
    alone = ConvexHull(world(outer)).volume
    both = ConvexHull(np.concatenate([world(outer), world(inner)])).volume
    return both / alone - 1


def test_convex_pairs_agree_with_hull_volumes():
    rng = np.random.default_rng(3)
    seen = {True: 0, False: 0}
    for _ in range(400):
        outer = thing(str(rng.choice(["sphere", "cone", "box"])), turn=random_rotation(rng))
        inner = thing(
            str(rng.choice(["sphere", "cone", "box", "torus"])),
            rng.normal(size=3) * 0.15,
            rng.uniform(0.2, 0.9),
            random_rotation(rng),
        )
        growth = hull_says(outer, inner)
        # Qhull's own rounding lies far below this, and no random case falls between the two.
        expected = growth < 1e-9
        seen[expected] += 1
        assert encloses(outer, inner) == expected
    assert min(seen.values()) > 50


def test_a_torus_never_lets_an_enclosed_object_pass():
    """Conservative: whatever libigl finds inside of the ring's mesh is called enclosed."""
    rng = np.random.default_rng(4)
    outer = thing("torus")
    inside = 0
    for _ in range(200):
        angle = rng.uniform(0, 2 * np.pi)
        place = 0.72 * np.array([np.cos(angle), 0, np.sin(angle)]) + rng.normal(size=3) * 0.05
        inner = thing("sphere", place, rng.uniform(0.05, 0.35))
        winding = igl.winding_number(world(outer), outer.mesh.triangles, world(inner))
        if (np.abs(winding) > 0.5).all():
            inside += 1
            assert encloses(outer, inner)
    assert inside > 20


def test_a_ball_in_the_hole_of_a_torus_is_not_enclosed():
    ring = Object(torus(3.0, 0.5, 24, 12))
    assert not encloses(ring, thing("sphere", scale=2.0))
    assert encloses(ring, thing("sphere", (3.0, 0, 0), 0.2))


@pytest.mark.parametrize("shift, expected", [(0.0, True), (1e-12, True), (1e-6, False)])
def test_touching_from_inside_counts_as_enclosed(shift, expected):
    """A box in the corner of a box twice its size: exactly flush, a rounding out, plainly out."""
    half = 0.5 / 3**0.5
    corner = np.array([half, half, half]) + shift
    assert encloses(thing("box"), thing("box", corner, 0.5)) == expected


def test_identical_objects_enclose_each_other():
    assert enclosing_pairs([thing("cone"), thing("cone")]) == [(0, 1), (1, 0)]


def test_a_crowded_scene_is_redrawn_until_nothing_is_hidden_inside():
    """In a cube of 20 units most draws enclose something at first."""
    p = AbstractParameters(side=20.0, objects=60, radius=(0.3, 5.0))
    scene = abstract_scene(np.random.default_rng(1), p)
    convex = [o for o in scene.objects if o.mesh.convex]
    for outer in convex:
        for inner in scene.objects:
            if inner is not outer:
                assert hull_says(outer, inner) > 1e-12


def test_a_scene_that_never_comes_free_is_refused(monkeypatch):
    monkeypatch.setattr(
        "seethrough.tasks.worlds.abstract.abstract_scene.enclosing_pairs", lambda _: [(0, 1)]
    )
    with pytest.raises(NoScene, match=r"objects = 9, radius = \[2.5, 5.0\]: expected room in a"):
        abstract_scene(
            np.random.default_rng(1), AbstractParameters(objects=9, target_share=(0.0, 0.2))
        )
