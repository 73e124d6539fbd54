"""Which objects make a cluster, and what the plan then knows of it."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.plan import clusters
from seethrough.renderer.plan.clusters import fitting, polygons_of, unite
from seethrough.renderer.polygons.polygons import newell
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.scene import Object, Scene


def known(n, pairs=(), fronts=()):
    """Relations of n objects: `pairs` without a plane, and (front, behind) besides."""
    relation, uncertain = np.zeros((n, n), np.int8), np.zeros((n, n), bool)
    for i, j in pairs:
        uncertain[i, j] = uncertain[j, i] = True
        relation[i, j], relation[j, i] = 1, -1
    for i, j in fronts:
        relation[i, j], relation[j, i] = 1, -1
    return relation, uncertain


def united(n, pairs, fronts=(), fit=None, triangles=12):
    extents = np.array([[10.0 * i, 0, 10.0 * i + 15, 5] for i in range(n)])
    relation, uncertain = known(n, pairs, fronts)
    able = np.ones(n, bool) if fit is None else np.array(fit)
    each = np.full(n, triangles)
    return unite(extents, relation, uncertain, np.ones(n, bool), able, each)


def test_pairs_that_hang_together_are_one_cluster_led_by_its_first():
    found = united(5, [(1, 3), (3, 4)], [(0, 3), (1, 2)])
    assert [m.tolist() for m in found.members] == [[1, 3, 4]]
    assert found.blended.tolist() == [True, True, True, False, False]
    assert found.clustered.tolist() == [False, True, False, True, True]
    assert found.extents[1].tolist() == [10, 0, 55, 5]
    assert found.extents[0].tolist() == [0, 0, 15, 5]
    # Object 0 lies before member 3, so before the cluster; 2 behind member 1, so behind it.
    assert found.relation[1].tolist()[:3] == [-1, 0, 1]
    assert found.relation[:, 1].tolist()[:3] == [1, 0, -1]
    assert not found.uncertain.any()


def test_something_between_the_members_leaves_them_to_be_sorted_by_pixel():
    found = united(3, [(0, 2)], [(1, 0), (2, 1)])
    assert not found.members and found.blended.all() and found.uncertain[0, 2]


def test_a_doubt_with_an_object_that_does_not_fit_leaves_them_too():
    assert not united(3, [(0, 1), (1, 2)], fit=[True, True, False]).members
    assert len(united(3, [(0, 1)], fit=[True, True, False]).members) == 1


def test_clusters_have_so_many_triangles_and_no_more():
    half = clusters.MOST // 2
    assert len(united(2, [(0, 1)], triangles=half).members) == 1
    assert not united(2, [(0, 1)], triangles=half + 1).members


def test_convex_objects_on_their_own_that_are_no_targets_fit():
    box, ring = geometry.box(1, 1, 1), geometry.torus(1, 0.3, 8, 6)
    objects = [
        Object(box), Object(ring), Object(box, target=True), Object(box, group=1),
        Object(box, group=1), Object(box, group=2),
    ]  # fmt: skip
    assert fitting(Scene(tuple(objects))).tolist() == [True, False, False, False, False, True]


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_polygons_face_outwards_in_the_world_also_when_mirrored(mirror):
    place = transforms.translation(3, 1, -2) @ np.diag([mirror, 2.0, 0.5, 1.0])
    scene = Scene(
        (Object(geometry.box(1, 1, 1)), Object(geometry.sphere(1, 1), place, (1, 0.5, 0)))
    )
    polygons = polygons_of(scene, np.array([1]))
    assert set(polygons.objects) == {1}
    first = polygons.vertices[polygons.starts[:-1]]
    areas = newell(polygons)
    outwards = ((first - np.array([3, 1, -2])) * areas).sum(axis=1)
    assert (outwards > 0).all()
    normals = polygons.attributes[polygons.starts[:-1], :3]
    assert ((normals * areas).sum(axis=1) > 0).all()
    assert np.array_equal(np.unique(polygons.attributes[:, 3:], axis=0), [[1, 0.5, 0]])
