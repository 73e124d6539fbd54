"""Meshes with the defects of Thingi10K, made by hypothesis, against the rational oracle.

Zhou and Jacobson ("Thingi10K", 2016) count 45 % self-intersecting meshes, 31 % with coplanar
self-intersections, 22 % non-manifold, 16 % with degenerate faces and 11 % open ones. A coarse grid
of shared corners gives all of these at once; a shake smaller than the grid, or of a few units in
the last place, takes some of the coincidences away.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from seethrough.renderer.polygons import bsp
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.polygons import triangles_from
from seethrough.renderer.polygons.predicates import plane_corners

corner = st.tuples(*[st.integers(-2, 2)] * 3)


@st.composite
def meshes(draw):
    corners = np.array(draw(st.lists(corner, min_size=4, max_size=9)), float)
    index = st.integers(0, len(corners) - 1)
    faces = draw(st.lists(st.tuples(index, index, index), min_size=2, max_size=10))
    shake = draw(st.sampled_from([0.0, 1e-15, 1e-12, 1e-3]))
    seed = draw(st.integers(0, 2**16))
    corners += np.random.default_rng(seed).uniform(-shake, shake, corners.shape)
    offset = draw(st.sampled_from([0.0, 1e6]))
    return triangles_from(corners + offset, np.array(faces))


@pytest.mark.parametrize(
    "prepare",
    [
        lambda p: bsp.prepare(p, "fewest"),
        lambda p: feudal.prepare(p, "static"),
        lambda p: feudal.prepare(p, "dynamic"),
    ],
    ids=["bsp", "static", "dynamic"],
)
@settings(
    max_examples=25,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(polygons=meshes())
def test_defective_meshes(prepare, polygons, oracle):
    prepared = prepare(polygons)
    order = prepared.order(eye=np.array([5.0, 4.0, 3.0]))
    assert sorted(order) == list(range(len(prepared.drawable.triangles)))
    assert oracle.area_errors(polygons, prepared).max() <= 1.0
    uneven, _ = oracle.uneven_cuts(prepared.cuts, plane_corners(polygons))
    assert uneven == []
    rng = np.random.default_rng(1)
    assert oracle.wrong_pairs(polygons, prepared, rng, eyes=2, rays=5) == []
