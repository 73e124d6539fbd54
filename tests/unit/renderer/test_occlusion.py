"""Hollows of models: what is convex has none, what stands in a pit loses what its walls hide."""

from dataclasses import replace

import numpy as np
import pytest

from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.look.occlusion import FAR, NEAR, hidden, occluded
from seethrough.renderer.models import MODELS
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene


def grid(size, steps):
    """A square of so many steps a side in the plane y = 0, facing up."""
    line = np.linspace(-size / 2, size / 2, steps + 1)
    x, z = np.meshgrid(line, line, indexing="ij")
    points = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
    i, j = np.meshgrid(np.arange(steps), np.arange(steps), indexing="ij")
    a = (i * (steps + 1) + j).ravel()
    b, c, d = a + 1, a + steps + 2, a + steps + 1
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    normals = np.tile([0.0, 1.0, 0.0], (len(points), 1))
    return geometry.Mesh(points, normals, np.ones_like(points), triangles.astype(np.int32))


def placed(mesh, matrix):
    return geometry.transformed(mesh, matrix)


def test_what_is_convex_has_no_hollows():
    """As a mesh that does not know that it is convex."""
    for mesh in (geometry.sphere(1.0, 3), geometry.cylinder(segments=120), grid(2.0, 20)):
        assert hidden(replace(mesh, convex=False)).max() < 0.05  # voxels are coarse
    ball = geometry.sphere(1.0, 3)
    assert occluded(ball, 0.8) is ball


def test_the_middle_below_a_roof_loses_what_the_roof_hides():
    """Of the light by the cosine a disc of radius r at height h hides r² / (r² + h²); a roof of
    that area, half as wide as the model, so that nothing else is near."""
    roof = placed(grid(1.4, 24), transforms.translation(0, 0.35, 0) @ transforms.rotation_x(np.pi))
    floor = grid(4.0, 40)
    mesh = geometry.merged(floor, roof)
    found = hidden(mesh)[: len(floor.vertices)]
    middle = np.linalg.norm(floor.vertices, axis=1).argmin()
    voxel = 4.0 / 40
    far = 0.35 / voxel - NEAR  # what is so far away takes a little less
    want = 1.4**2 / np.pi / (1.4**2 / np.pi + 0.35**2)
    assert 0.6 * want < found[middle] < want + 0.05
    assert found[middle] > (1 - far * 2 / (FAR - NEAR)) * want * 0.8
    assert found[0] < 0.02  # a corner of the floor


def test_inner_corners_are_darker_than_outer_ones():
    """Two walls that meet: near where they do, and away from it."""
    side = placed(
        grid(2.0, 30), transforms.translation(0, 1, 0) @ transforms.rotation_z(-np.pi / 2)
    )
    floor = placed(grid(2.0, 30), transforms.translation(1.0, 0, 0))
    found = hidden(geometry.merged(side, floor))
    points = geometry.merged(side, floor).vertices
    on_floor = np.arange(len(points)) >= len(side.vertices)
    near = on_floor & (points[:, 0] < 0.15)
    away = on_floor & (points[:, 0] > 1.5)
    assert found[near].mean() > 0.25 and found[away].mean() < 0.05


@pytest.mark.parametrize("name", ["chair", "horse"])
def test_models_get_darker_and_nothing_else(name):
    mesh = MODELS[name]()
    dark = occluded(mesh, 0.8)
    assert dark is occluded(mesh, 0.8)
    assert (dark.colors <= mesh.colors).all() and (dark.colors >= 0.19 * mesh.colors).all()
    assert 0.03 < 1 - (dark.colors.sum() / mesh.colors.sum()) < 0.4
    assert dark.vertices is mesh.vertices and dark.triangles is mesh.triangles
    half = occluded(mesh, 0.4)
    assert np.allclose(mesh.colors - half.colors, (mesh.colors - dark.colors) / 2)
    scene = Scene((Object(mesh, target=True, kind=name), Object(geometry.box())))
    one, two = dressed(scene, Look(occlusion=0.8)).objects
    assert one.mesh is dark and one.target and two.mesh is scene.objects[1].mesh
