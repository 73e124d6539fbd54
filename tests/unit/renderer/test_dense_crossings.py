"""Polygons that all cross fall into very many pieces: bounded, and never without a word."""

import numpy as np
import pytest

from seethrough.benchmarks.orderings.ordering import crossing
from seethrough.renderer.plan import clusters
from seethrough.renderer.plan.explain import of_cluster
from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.fragments import TooManyPieces
from seethrough.renderer.scene.geometry import merged, quad, transformed
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import random_rotation


def test_what_crosses_densely_is_said_with_figures():
    stats = bsp.prepare(crossing(25)).stats
    said = f"DENSE CROSSINGS: 25 polygons cut into {stats.outputs}, "
    assert stats.outputs > 1000 and stats.dense.startswith(said)
    apart = crossing(1)
    assert bsp.prepare(apart).stats.dense == ""


@pytest.mark.parametrize("method", [bsp, feudal])
def test_cutting_stops_at_the_bound(method):
    with pytest.raises(TooManyPieces, match=r"100 polygons cross so densely .* more than 5000 pie"):
        method.prepare(crossing(100), most=5000)


def sheaf(count, rng):
    """Two objects of sheets that all cross, in one place."""
    sheets = [transformed(quad(), random_rotation(rng)) for _ in range(count)]
    return Scene(tuple(Object(merged(*some)) for some in (sheets[::2], sheets[1::2])))


def test_a_cluster_too_dense_to_cut_is_left_to_pixels():
    rng = np.random.default_rng(5)
    both = np.array([0, 1])
    few, many = sheaf(6, rng), sheaf(240, rng)
    assert not isinstance(clusters.tree_of(few, both), str)
    assert "polygons cut into" in of_cluster(few, both)
    said = of_cluster(many, both)
    assert "cross so densely" in said and f"{clusters.MOST_PIECES} pieces" in said
    pair = np.array([[False, True], [True, False]])
    nothing = np.zeros((2, 2), np.int8)
    yes = np.ones(2, bool)
    for scene, found in ((few, 1), (many, 0)):
        united = clusters.unite(
            np.array([[0.0, 0, 9, 9]] * 2), nothing, pair, yes, yes, scene.triangle_counts,
            lambda members, scene=scene: not isinstance(clusters.tree_of(scene, members), str),
        )  # fmt: skip
        assert len(united.members) == found
        assert united.uncertain.any() == (not found)
