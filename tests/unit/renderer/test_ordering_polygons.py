"""What is refused, by index and value; and the simple orders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.renderer.polygons import axis_tree, bsp, distance
from seethrough.renderer.polygons.feudal import feudal
from seethrough.renderer.polygons.methods import METHODS, prepare
from seethrough.renderer.polygons.polygons import Polygons, polygons_from, triangles_from
from seethrough.renderer.polygons.triangulation import clip_ears

TRIANGLE = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]


def stack(count):
    return polygons_from([np.array(TRIANGLE) + np.array([0, 0, i]) for i in range(count)])


@pytest.mark.parametrize(
    ("face", "message"),
    [
        (
            [[0, 0, 0], [1, 0, np.nan], [0, 1, 0]],
            r"polygon 1: vertex 1 = \(1, 0, nan\), expected finite",
        ),
        (
            [[0, 0, 0], [1, 0, 0], [0, np.inf, 0]],
            r"polygon 1: vertex 2 = \(0, inf, 0\), expected finite",
        ),
        ([[0, 0, 0], [1, 0, 0]], "polygon 1: 2 vertices, expected three or more"),
        (
            [[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]],
            r"polygon 1: vertex \d lies 0\.\d+ off its plane",
        ),
    ],
)
def test_what_cannot_be_ordered_is_refused_by_index(face, message):
    with pytest.raises(ValueError, match=message):
        polygons_from([TRIANGLE, face])


def test_every_method_refuses_what_was_not_checked_before():
    broken = stack(2)
    vertices = broken.vertices.copy()
    vertices[4, 1] = np.nan
    wrong = Polygons(vertices, broken.starts, broken.attributes, broken.objects)
    for name in METHODS:
        with pytest.raises(ValueError, match=r"polygon 1: vertex 1 = \(1, nan, 1\)"):
            prepare(name, wrong)


def test_attributes_must_be_finite():
    with pytest.raises(ValueError, match=r"polygon 0: vertex 0 = \(inf\), expected finite values"):
        triangles_from(np.array(TRIANGLE), [[0, 1, 2]], np.array([[np.inf], [0], [0]]))


@pytest.mark.parametrize("name", METHODS)
def test_a_stack_is_drawn_from_the_far_end(name):
    eye = np.array([0.2, 0.3, 50.0])
    prepared = prepare(name, stack(7))
    order = prepared.order(eye=eye, view=np.array([0, 0, -1.0]))
    assert list(prepared.drawable.source[prepared.drawable.owner[order]]) == list(range(7))


def test_a_name_there_is_not_is_refused():
    with pytest.raises(ValueError, match="order = 'alphabet', expected one of distance, depth"):
        prepare("alphabet", stack(1))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"splitter": "best"}, "splitter = 'best', expected one of first, fewest, sampled"),
        ({"candidates": 0}, "candidates = 0, expected 1 or more"),
        ({"tolerance": np.nan}, "tolerance = nan, expected a finite distance"),
    ],
)
def test_bsp_refuses_unknown_options(options, message):
    with pytest.raises(ValueError, match=message):
        bsp.prepare(stack(2), **options)


def test_feudal_refuses_an_unknown_version():
    with pytest.raises(ValueError, match="version = 'lazy', expected one of static, dynamic"):
        feudal.prepare(stack(2), "lazy")


@pytest.mark.parametrize(
    ("camera", "message"),
    [
        ({}, "order needs an eye"),
        ({"eye": np.array([0, np.nan, 0])}, "eye = .*nan.*, expected 3 finite numbers"),
        ({"view": np.zeros(3)}, "view = .*, expected a direction"),
    ],
)
def test_a_camera_that_is_none_is_refused(camera, message):
    with pytest.raises(ValueError, match=message):
        bsp.prepare(stack(2)).order(**camera)


def test_distance_sorts_again_only_when_the_camera_moved():
    prepared = distance.prepare(stack(3))
    for z in (9.0, 9.0, 9.0, -9.0):
        prepared.order(eye=np.array([0.0, 0.0, z]))
    assert prepared.sorts == 2


def test_distance_takes_polygons_in_and_moves_them_without_a_rebuild():
    prepared = distance.prepare(stack(3))
    eye = np.array([0.2, 0.3, 50.0])
    added = prepared.add(polygons_from([np.array(TRIANGLE) - [0, 0, 5]]))
    assert list(added) == [3]
    assert list(prepared.order(eye=eye)) == [3, 0, 1, 2]
    prepared.move(np.array([3]), np.array(TRIANGLE) + np.array([0, 0, 9]))
    assert list(prepared.order(eye=eye)) == [0, 1, 2, 3]
    with pytest.raises(ValueError, match="vertices: 2 corners, expected 3"):
        prepared.move(np.array([0]), np.zeros((2, 3)))


def test_the_axis_tree_ends_where_all_coordinates_are_equal():
    same = polygons_from([TRIANGLE] * 5)
    prepared = axis_tree.prepare(same)
    assert sorted(prepared.order(eye=np.ones(3))) == list(range(5))
    assert prepared.stats.nodes["leaf"] == 1


def test_the_axis_tree_is_a_heuristic():
    """A long polygon beside its centre: the tree, which knows centres only, gets it wrong."""
    long = [[-10.0, 0, 0], [10, 0, -6], [10, 1, -6]]
    small = [[-6.0, -1, -1.6], [-5, -1, -1.6], [-5.5, 2, -1.6]]
    prepared = axis_tree.prepare(polygons_from([long, small]))
    drawn = prepared.drawable.source[prepared.order(eye=np.array([6.0, 0.1, -30.0]))]
    right = bsp.prepare(polygons_from([long, small]))
    exact = right.drawable.source[
        right.drawable.owner[right.order(eye=np.array([6.0, 0.1, -30.0]))]
    ]
    assert exact[-1] == 1
    assert list(drawn) == [1, 0]


def test_attributes_are_interpolated_where_an_edge_is_cut():
    knife = [[0.5, -9.0, -9], [0.5, 9, -9], [0.5, 0, 9]]
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    values = [np.zeros((3, 1)), np.array([[0.0], [2.0], [4.0]])]
    made = bsp.prepare(polygons_from([knife, corners], values), "first")
    cut = np.isclose(made.drawable.polygons.vertices[:, 0], 0.5) & (
        made.drawable.polygons.vertices[:, 2] == 0
    )
    places, found = made.drawable.polygons.vertices[cut], made.drawable.polygons.attributes[cut, 0]
    assert np.allclose(found, 2 * places[:, 0] + 4 * places[:, 1])
    assert set(np.round(found, 12)) == {1.0, 3.0}


@pytest.mark.parametrize("method", [bsp, feudal])
def test_vertex_normals_stay_as_long_as_one_where_an_edge_is_cut(method):
    """Halfway between two unit normals lies their mean, made as long as one again."""
    knife = [[0.5, -9.0, -9], [0.5, 9, -9], [0.5, 0, 9]]
    normals = np.array([[0.0, 0, 1], [0.6, 0, 0.8], [0.0, 0.6, 0.8]])
    values = [np.zeros((3, 4)), np.column_stack([[1.0, 2.0, 3.0], normals])]
    values[0][:, 3] = 1.0
    loose = polygons_from([knife, TRIANGLE], values)
    polygons = replace(loose, normals=1)
    drawn = method.prepare(polygons).drawable.polygons
    assert drawn.normals == 1
    points, found = drawn.vertices, drawn.attributes
    of_triangle = points[:, 2] == 0
    cut = of_triangle & (points[:, 0] == 0.5)
    assert cut.sum() >= 4
    expected = np.column_stack([1 - points.sum(axis=1), points[:, :2]]) @ normals
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    assert np.allclose(found[of_triangle, 1:], expected[of_triangle], atol=1e-15)
    assert not np.allclose(np.linalg.norm(method.prepare(loose).drawable.polygons.attributes
                                          [cut, 1:], axis=1), 1.0, atol=1e-3)  # fmt: skip
    # What is no normal is interpolated, and left alone.
    assert np.allclose(found[cut, 0], 1 + points[cut, 0] + 2 * points[cut, 1])


def test_normals_that_cancel_where_an_edge_is_cut_are_the_plane_s():
    knife = [[0.5, -9.0, -9], [0.5, 9, -9], [0.5, 0, 9]]
    facing = np.array([[1.0, 0, 0], [-1.0, 0, 0], [-1.0, 0, 0]])
    triangle = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0]]
    made = replace(polygons_from([knife, triangle], [facing, facing]), normals=0)
    drawn = bsp.prepare(made, "first").drawable.polygons
    cut = (drawn.vertices[:, 0] == 0.5) & (drawn.vertices[:, 2] == 0)
    assert cut.any()
    assert np.array_equal(np.unique(drawn.attributes[cut], axis=0), [[0.0, 0.0, 1.0]])


def test_a_triangle_falls_in_the_two_ways_of_paper_001():
    """Two edges cut: a triangle and a quadrilateral, so three triangles. One edge cut: two."""
    triangle = [[0.0, 0, 0], [2, 0, 0], [0, 2, 0]]
    two = bsp.prepare(
        polygons_from([[[0.5, -9.0, -9], [0.5, 9, -9], [0.5, 0, 9]], triangle]), "first"
    )
    one = bsp.prepare(polygons_from([[[0.0, 0, -9], [1.0, 1, -9], [0.0, 0, 9]], triangle]), "first")
    assert (two.drawable.source == 1).sum() == 3
    assert (one.drawable.source == 1).sum() == 2


def test_ears_of_a_comb_and_of_a_bridged_hole_cover_it_once():
    comb = np.array([[0, 0], [9, 0], [9, 3], [7, 3], [7, 1], [5, 1], [5, 3], [0, 3.0]])
    ring = np.array(
        [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1.0]]
    )
    for loop, area in ((comb, 9 * 3 - 4), (ring, 16 - 4)):
        ears = loop[clip_ears(loop)]
        u, v = ears[:, 1] - ears[:, 0], ears[:, 2] - ears[:, 0]
        signed = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
        assert (signed >= 0).all()
        assert signed.sum() == area
