"""Edges of meshes and which of them are outlines, of shapes small enough to say by hand."""

import numpy as np
import pytest

from seethrough.renderer.masks.silhouettes import silhouette, topology
from seethrough.renderer.scene.geometry import Mesh

SQUARE = [(0, 1, 2), (0, 2, 3)]  # counter-clockwise seen from +z
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def mesh(points, faces):
    at = np.array(points, float)
    return Mesh(at, np.zeros_like(at), np.ones_like(at), np.array(faces))


def edges_of(shape):
    """{edge's two points: the faces at it}, one entry each."""
    found = {}
    for edge, sides in zip(shape.edges, shape.sides, strict=True):
        points = frozenset(tuple(shape.points[k]) for k in edge)
        found.setdefault(points, []).append(frozenset(sides.tolist()))
    return found


def line(a, b):
    return frozenset((tuple(map(float, a)), tuple(map(float, b))))


def test_an_open_square_has_four_lone_edges_and_one_that_both_faces_share():
    shape = topology(mesh(CORNERS, SQUARE))
    a, b, c, d = CORNERS
    assert not shape.closed
    assert edges_of(shape) == {
        line(a, b): [frozenset({0, -1})],
        line(b, c): [frozenset({0, -1})],
        line(a, c): [frozenset({0, 1})],
        line(c, d): [frozenset({1, -1})],
        line(a, d): [frozenset({1, -1})],
    }


def test_an_edge_of_three_faces_has_a_row_for_each_pair_that_follow_each_other():
    points = [*CORNERS, (1, 1, 1)]
    shape = topology(mesh(points, [*SQUARE, (0, 2, 4)]))
    rows = edges_of(shape)[line(points[0], points[2])]
    assert rows == [frozenset({0, 1}), frozenset({1, 2})]


def test_vertices_that_coincide_are_one_and_faces_without_area_are_none():
    apart = [CORNERS[k] for face in SQUARE for k in face]
    shape = topology(mesh([*apart, (5, 5, 5)], [(0, 1, 2), (3, 4, 5), (0, 1, 1), (6, 6, 6)]))
    assert edges_of(shape) == edges_of(topology(mesh(CORNERS, SQUARE)))
    assert len(shape.planes) == 2


@pytest.mark.parametrize(("eye", "count"), [((0.3, 0.2, 4), 4), ((0.3, 0.2, -4), 0)])
def test_a_square_s_border_is_its_outline_from_before_it_alone(eye, count):
    """Its diagonal lies between two faces that both face the eye."""
    shape = topology(mesh(CORNERS, SQUARE))
    found = silhouette(shape, np.array(eye, float))
    border = [line(CORNERS[k], CORNERS[(k + 1) % 4]) for k in range(4)]
    points = [line(*(shape.points[k] for k in edge)) for edge in found]
    assert sorted(map(sorted, points)) == sorted(map(sorted, border[:count]))
