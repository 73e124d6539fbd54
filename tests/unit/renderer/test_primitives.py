"""Primitives against closed forms: volume, area, Euler's number, normals, outward winding."""

from math import pi, sin

import numpy as np
import pytest
from numpy.testing import assert_allclose

from seethrough.renderer.scene import geometry as g
from seethrough.renderer.scene import transforms as t


def volume(mesh):
    """By the divergence theorem: negative for a mesh turned inside out."""
    return np.linalg.det(mesh.vertices[mesh.triangles]).sum() / 6


def euler(mesh):
    """V − E + F with coincident vertices joined; every edge must be used once each way."""
    _, joined = np.unique(np.round(mesh.vertices, 9), axis=0, return_inverse=True)
    faces = joined.reshape(-1)[mesh.triangles]
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    directed = {tuple(e) for e in edges.tolist()}
    assert len(directed) == len(edges)
    assert all((b, a) in directed for a, b in directed)
    return len(np.unique(faces)) - len(edges) // 2 + len(faces)


def polygon(n):
    """Area of the regular polygon in the unit circle."""
    return n / 2 * sin(2 * pi / n)


# (5/12)(3 + √5) a³ with edge a, and for circumradius 1 a = 4 / √(10 + 2√5).
ICOSAHEDRON = 5 / 12 * (3 + 5**0.5) * (4 / (10 + 2 * 5**0.5) ** 0.5) ** 3

CLOSED = {
    "box": (g.box(1, 2, 3), 6.0, 2),
    "cylinder": (g.cylinder(0.5, 2, 12), polygon(12) * 0.25 * 2, 2),
    "frustum": (g.cylinder(1, 3, 8, top=0.5), polygon(8) * (1 + 0.5 + 0.25), 2),
    "cone": (g.cone(2, 3, 16), polygon(16) * 4, 2),
    "icosahedron": (g.sphere(1, 0), ICOSAHEDRON, 2),
    # Pappus on polygons: the tube's polygon, carried round by a polygon instead of a circle.
    "torus": (g.torus(3, 1, 12, 6), 3 * polygon(6) * 12 * sin(2 * pi / 12), 0),
}


@pytest.mark.parametrize("name", CLOSED)
def test_volume_and_topology(name):
    mesh, expected, number = CLOSED[name]
    assert_allclose(volume(mesh), expected, rtol=1e-12)
    assert euler(mesh) == number


@pytest.mark.parametrize("name", CLOSED)
def test_normals_are_unit_and_point_outward(name):
    mesh = CLOSED[name][0]
    assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, rtol=1e-12)
    corners = mesh.vertices[mesh.triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("mj,mkj->mk", face, mesh.normals[mesh.triangles]) > 0).all()


def test_sphere_lies_on_its_radius_and_converges():
    for depth, triangles in ((0, 20), (1, 80), (3, 1280)):
        mesh = g.sphere(2.5, depth)
        assert len(mesh.triangles) == triangles
        assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 2.5, rtol=1e-12)
        assert euler(mesh) == 2
    assert 0.98 < volume(g.sphere(1, 3)) / (4 / 3 * pi) < 1


def test_cone_normals_are_square_to_the_side():
    mesh = g.cone(1, 2, 8)
    tip, rim = mesh.vertices[8], mesh.vertices[0]
    assert_allclose(tip, [0, 1, 0], atol=1e-15)
    assert_allclose(mesh.normals[0] @ (tip - rim), 0, atol=1e-14)


def test_primitives_stand_about_the_origin():
    for mesh in (g.box(1, 2, 3), g.cone(2, 3), g.sphere(), g.torus(), g.quad(2, 3)):
        assert_allclose(mesh.center, 0, atol=1e-15)
    assert_allclose(g.box(1, 2, 3).bounds, [[-0.5, -1, -1.5], [0.5, 1, 1.5]])
    assert_allclose(g.quad(2, 3).normals, np.tile([0, 1, 0], (4, 1)))


@pytest.mark.parametrize("mirror", [1, -1])
def test_transformed_keeps_the_outside_out(mirror):
    matrix = t.placed((1, 2, 3), t.rotation((1, 2, 3), 0.7), (2, 0.5, 3 * mirror))
    before = g.cone(1, 2, 8)
    after = g.transformed(before, matrix)
    assert_allclose(volume(after), volume(before) * 3, rtol=1e-12)
    assert_allclose(np.linalg.norm(after.normals, axis=1), 1, rtol=1e-12)
    side = after.vertices[8] - after.vertices[0]  # tip − rim
    assert_allclose(after.normals[0] @ side, 0, atol=1e-12)
    assert after.convex


def test_merged_and_colored():
    red = g.colored(g.box(), (1, 0, 0))
    both = g.merged(red, g.transformed(g.cone(), t.translation(3, 0, 0)))
    assert_allclose(volume(both), volume(red) + volume(g.cone()), rtol=1e-12)
    assert both.triangles.dtype == np.int32
    assert not both.convex and g.merged(red).convex
    assert_allclose(both.colors[0], [1, 0, 0])
    assert_allclose(both.colors[-1], [1, 1, 1])


@pytest.mark.parametrize(
    "build, message",
    [
        (lambda: g.box(0), r"width = 0, expected a size > 0"),
        (lambda: g.sphere(float("nan")), r"radius = nan, expected a size > 0"),
        (lambda: g.cylinder(segments=2), r"segments = 2, expected at least 3"),
        (lambda: g.cylinder(top=-1.0), r"top = -1.0, expected a radius ≥ 0"),
        (lambda: g.sphere(subdivisions=-1), r"subdivisions = -1, expected at least 0"),
        (lambda: g.merged(), r"no meshes to merge"),
        (lambda: g.colored(g.box(), (2, 0, 0)), r"color = \(2, 0, 0\), expected three numbers"),
        (lambda: g.transformed(g.box(), t.scaling(1, 0, 1)), r"flattens the mesh"),
        (lambda: t.rotation((0, 0, 0), 1), r"axis = \(0, 0, 0\), expected a direction"),
    ],
)
def test_bad_input_says_what_was_expected(build, message):
    with pytest.raises(ValueError, match=message):
        build()


def test_rotations():
    assert_allclose(
        t.moved(np.array([[1.0, 0, 0]]), t.rotation_y(pi / 2)), [[0, 0, -1]], atol=1e-15
    )
    assert_allclose(t.moved(np.array([[0, 1.0, 0]]), t.rotation_x(pi / 2)), [[0, 0, 1]], atol=1e-15)
    assert_allclose(t.moved(np.array([[1.0, 0, 0]]), t.rotation_z(pi / 2)), [[0, 1, 0]], atol=1e-15)
    assert_allclose(
        t.placed((1, 2, 3), t.rotation_y(0.3), (1, 2, 3)),
        t.translation(1, 2, 3) @ t.rotation_y(0.3) @ t.scaling(1, 2, 3),
    )


def test_random_rotations_are_uniform():
    rng = np.random.default_rng(1)
    turns = np.array([t.random_rotation(rng)[:3, :3] for _ in range(4000)])
    assert_allclose(turns @ turns.transpose(0, 2, 1), np.tile(np.eye(3), (4000, 1, 1)), atol=1e-12)
    assert_allclose(np.linalg.det(turns), 1, rtol=1e-12)
    # Each entry has mean 0 and variance 1/3 under the uniform measure; six standard errors.
    assert np.abs(turns.mean(axis=0)).max() < 6 * (1 / 3 / 4000) ** 0.5
    # A coordinate of a uniform direction is uniform on [−1, 1], of variance 4/45 when squared.
    assert np.abs((turns**2).mean(axis=0) - 1 / 3).max() < 6 * (4 / 45 / 4000) ** 0.5
