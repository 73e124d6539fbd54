"""Levels of detail: what they are made of, and how far off the whole mesh they are."""

from __future__ import annotations

from dataclasses import replace

import igl
import numpy as np
import pytest

from seethrough.renderer.look.detail import LEAST, STEPS, levels
from seethrough.renderer.models import MODELS
from seethrough.renderer.models.forms.shapes import shade
from seethrough.renderer.models.forms.surfaces import ball
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.geometry import Mesh

NAMES = ("cat", "bike", "piano", "plant", "helicopter", "television")
POINTS = 6  # along a triangle's sides, for points all over it


def spread(mesh: Mesh, triangles: np.ndarray) -> np.ndarray:
    """Points all over triangles (m, 3), corners included."""
    steps = [(i, j) for i in range(POINTS) for j in range(POINTS - i)]
    share = np.array([(i, j, POINTS - 1 - i - j) for i, j in steps]) / (POINTS - 1)
    return np.einsum("pk,mkx->mpx", share, mesh.vertices[triangles]).reshape(-1, 3)


def distance(mesh: Mesh, points: np.ndarray, triangles: np.ndarray) -> float:
    """The farthest point's distance from triangles, by libigl."""
    squared = igl.point_mesh_squared_distance(points, mesh.vertices, triangles.astype(np.int64))[0]
    return float(np.sqrt(squared.max()))


@pytest.mark.parametrize("name", NAMES)
def test_a_level_is_off_by_no_more_than_it_says(name):
    """Both ways: nothing of the mesh is farther from the level, nothing of it from the mesh."""
    mesh = MODELS[name]()
    found = levels(mesh)
    for triangles, error in zip(found.triangles, found.errors, strict=True):
        assert distance(mesh, spread(mesh, mesh.triangles), triangles) <= error
        assert distance(mesh, spread(mesh, triangles), mesh.triangles) <= error


@pytest.mark.parametrize("name", NAMES)
def test_levels_grow_coarser_and_stay_closed(name):
    """A closed mesh's levels are closed; the coarsest has at most half of the triangles."""
    mesh = MODELS[name]()
    found = levels(mesh)
    counts = [len(mesh.triangles), *map(len, found.triangles)]
    assert counts == sorted(counts, reverse=True) and counts[-1] < 0.5 * counts[0]
    assert np.allclose(found.errors, STEPS * mesh.radius)
    for triangles in found.triangles:
        assert replace(mesh, triangles=triangles.astype(np.int32)).closed == mesh.closed


def plate(sides: int) -> Mesh:
    """A flat square in the plane y = 0 of so many squares along each side."""
    x, z = np.meshgrid(np.linspace(0, 1, sides + 1), np.linspace(0, 1, sides + 1))
    vertices = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
    row, column = np.divmod(np.arange(sides * sides), sides)
    a = row * (sides + 1) + column
    b, c, d = a + 1, a + sides + 1, a + sides + 2
    triangles = np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)])
    normals = np.tile([0.0, 1.0, 0.0], (len(vertices), 1))
    return Mesh(vertices, normals, np.ones_like(vertices), triangles.astype(np.int32))


def area(mesh: Mesh, triangles: np.ndarray) -> np.ndarray:
    """(m,) areas of triangles."""
    a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def test_a_plate_keeps_its_corners_and_little_else():
    """What is flat needs two triangles; the rim is a line to keep."""
    mesh = plate(20)
    found = levels(mesh).triangles[0]
    assert len(found) < 20
    assert area(mesh, found).sum() == pytest.approx(1.0, abs=1e-9)


def test_a_border_of_colours_stays_where_it_is():
    """Half a plate is red: a level's red half has the same area, and no vertex mixes them."""
    mesh = plate(20)
    red = mesh.vertices[mesh.triangles].mean(axis=1)[:, 0] < 0.35
    twice = np.concatenate([mesh.vertices, mesh.vertices])
    colors = np.repeat([[1.0, 0, 0], [0, 0, 1.0]], len(mesh.vertices), axis=0)
    triangles = np.where(red[:, None], mesh.triangles, mesh.triangles + len(mesh.vertices))
    normals = np.tile(mesh.normals, (2, 1))
    two = Mesh(twice, normals, colors, triangles.astype(np.int32))
    whole = area(two, two.triangles)[two.triangles[:, 0] < len(mesh.vertices)].sum()
    found = levels(two).triangles[-1]
    assert len(found) < 40
    of_red = found[:, 0] < len(mesh.vertices)
    assert ((found < len(mesh.vertices)).all(axis=1) == of_red).all()
    assert area(two, found)[of_red].sum() == pytest.approx(whole, abs=1e-9)


def test_a_ball_grows_coarse_evenly():
    """Nothing turns inside out: all triangles of every level look away from the middle."""
    mesh = shade(ball(1.0, (0.5, 0.5, 0.5), 40))
    for triangles in levels(mesh).triangles:
        a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c - 3 * mesh.center)
        assert (outward > 0).all()


def test_few_triangles_have_no_levels():
    """A box, or what has less than LEAST triangles."""
    assert levels(geometry.box()).triangles == ()
    assert len(geometry.box().triangles) < LEAST
