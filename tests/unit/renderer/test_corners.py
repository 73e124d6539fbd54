"""Walls are darker where they meet, and the same surface as before."""

import numpy as np
import pytest

from seethrough.renderer.look import corners
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.tasks.worlds.building.walls import wall_with_doorway

REACH = corners.REACH * 4.0  # of a wall 4 high


def wall(x=0.0, z=0.0, turn=0.0, **what):
    matrix = transforms.placed((x, 2.0, z), transforms.rotation_y(turn))
    return Object(geometry.box(10.0, 4.0, 0.2), matrix, kind="wall", **what)


def colors(thing, axis, places):
    """The colour (k,) of a thing's vertices on its front, z = .1, where x or y is so much."""
    world = thing.mesh.vertices @ thing.transform[:3, :3].T + thing.transform[:3, 3]
    front = np.isclose(world[:, 2], 0.1) & (thing.mesh.normals[:, 2] > 0.5)
    found = [thing.mesh.colors[front & np.isclose(world[:, axis], place)] for place in places]
    assert all(len(rows) and np.ptp(rows) < 1e-12 for rows in found)
    return np.array([rows[0, 0] for rows in found])


def area(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def test_a_wall_is_dark_where_another_meets_it_and_nowhere_else():
    """The other stands across, its face at x = −.1 and .1, from z = .1 on to the front."""
    other = wall(z=5.1, turn=np.pi / 2)
    own, across = dressed(Scene((wall(), other)), Look(occlusion=1.0)).objects
    far = np.array([0.1, 0.1 + 0.2 * REACH, 0.1 + 0.45 * REACH, 0.1 + REACH, 5.0])
    left = colors(own, 0, far)
    want = 1 - corners.DEEP * np.clip(1 - (far - 0.1) / REACH, 0, 1) ** 2
    assert np.allclose(left, want)
    assert np.allclose(colors(own, 0, -far), want)  # and on its other side
    behind = (own.mesh.normals[:, 2] < -0.5) | (np.abs(own.mesh.normals[:, 0]) > 0.5)
    assert (own.mesh.colors[behind] == 1).all()
    assert across.mesh.colors.min() == pytest.approx(1 - corners.DEEP)
    half = dressed(Scene((wall(), other)), Look(occlusion=0.5)).objects[0]
    assert np.allclose(1 - half.mesh.colors, (1 - own.mesh.colors) / 2)


def test_what_lies_in_one_plane_takes_nothing_and_what_is_far_away_neither():
    alone = wall()
    beside = dressed(Scene((alone, wall(x=10.0))), Look(occlusion=1.0)).objects[0].mesh
    assert (beside.colors[np.abs(beside.normals[:, 0]) < 0.5] == 1).all()
    for other in (wall(z=REACH + 0.3), wall(z=5.1, turn=np.pi / 2, target=True)):
        assert dressed(Scene((alone, other)), Look(occlusion=1.0)).objects[0].mesh is alone.mesh


def test_a_floor_darkens_the_foot_of_a_wall_and_stays_as_it_is():
    floor = Object(geometry.box(30, 0.2, 30), transforms.translation(0, -0.1, 0), kind="floor")
    own, below = dressed(Scene((wall(), floor)), Look(occlusion=1.0)).objects
    assert below.mesh is floor.mesh
    left = colors(own, 1, [0.0, REACH, 4.0])
    assert np.allclose(left, [1 - corners.DEEP, 1, 1])


def test_only_slabs_are_cut():
    """A thin ring is none, nor is a cube, nor what has many vertices."""
    floor = Object(geometry.box(30, 0.2, 30), transforms.translation(0, -1.0, 0), kind="floor")
    for mesh in (geometry.torus(1.0, 0.1, 8, 6), geometry.box(1, 1, 1)):
        thing = Object(mesh, transforms.translation(0, -0.4, 0))
        assert corners.cornered((thing, floor), 1.0)[0] is thing


def test_a_cut_surface_is_the_same_surface():
    """Every face has its area and its plane, it is as closed, and no triangle crosses a cut."""
    whole = wall_with_doorway(8.0, 4.0, 0.2, (3.0, 5.0), 2.5)
    cuts = [(0, 1.0), (0, 1.7), (0, 4.1), (1, 0.3), (1, 2.9), (2, 0.02)]
    found = corners.cut(whole, cuts)
    assert found.closed == whole.closed
    assert np.allclose(area(found).sum(axis=0), area(whole).sum(axis=0))
    lengths = [np.linalg.norm(area(m), axis=1) for m in (found, whole)]
    assert lengths[0].sum() == pytest.approx(lengths[1].sum()) and lengths[0].min() > 0
    normal = area(found) / lengths[0][:, None]
    assert np.allclose(normal, found.normals[found.triangles[:, 0]])
    for axis, place in cuts:
        side = found.vertices[found.triangles][..., axis] - place
        assert ((side >= 0).all(axis=1) | (side <= 0).all(axis=1)).all()
    assert len(found.triangles) > 2 * len(whole.triangles)
