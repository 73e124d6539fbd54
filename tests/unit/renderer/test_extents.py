"""What objects cover on the screen: close about what they show, and never less."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seethrough.renderer.scene import transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import AROUND, box, cylinder, quad, sphere, torus
from seethrough.renderer.scene.projection import screen_boxes
from seethrough.renderer.scene.scene import Object, Scene

SIZE = (160, 120)
MESHES = [box(1, 2, 0.4), cylinder(), sphere(1.0, 1), torus(), quad(3, 1), sphere(1.0, 4)]


def surface(thing, camera, rng):
    """(k, 3) points of an object's surface in camera coordinates: corners of its triangles, and
    places on them drawn at random, many more than lie on one side of any near plane."""
    corners = thing.mesh.vertices[thing.mesh.triangles]
    places = rng.dirichlet(np.ones(3), (len(corners), 8))
    points = np.concatenate([corners.reshape(-1, 3), (places @ corners).reshape(-1, 3)])
    world = points @ thing.transform[:3, :3].T + thing.transform[:3, 3]
    return (world - camera.eye) @ camera.rotation


@given(st.integers(0, 2**32), st.sampled_from(range(len(MESHES))), st.booleans())
@settings(max_examples=150, deadline=None)
def test_nothing_shows_beside_the_extents(seed, which, close):
    """Turned, stretched and mirrored, also about the eye, where the near plane cuts."""
    rng = np.random.default_rng(seed)
    eye = rng.normal(size=3) * (0.6 if close else 4.0)
    camera = look_at(eye, rng.normal(size=3) * 0.3, fov_y=0.8, near=0.3, far=40)
    pose = transforms.placed(rng.uniform(-1, 1, 3), transforms.random_rotation(rng), 1.0)
    pose[:3, :3] *= rng.uniform(0.3, 2, 3) * rng.choice([-1, 1], 3)
    scene = Scene((Object(MESHES[which], pose),))
    boxes = screen_boxes(scene.corners, camera, SIZE, scene.around)
    seen = surface(scene.objects[0], camera, rng)
    # An object's own coordinates are off by as much as float64 rounds those of its hull.
    assert boxes.near[0] <= -seen[:, 2].max() + 1e-9
    assert boxes.far[0] >= -seen[:, 2].min() - 1e-9
    ahead = seen[-seen[:, 2] > camera.near]
    if len(ahead):
        assert boxes.within[0]
        lens = camera.lens(SIZE[1])
        x, y = ahead[:, :2].T / -ahead[:, 2] * lens * [[1], [-1]] + [[SIZE[0] / 2], [SIZE[1] / 2]]
        left, top, right, bottom = boxes.extents[0]
        assert x.min() >= left - 1e-6 and y.min() >= top - 1e-6
        assert x.max() <= right + 1e-6 and y.max() <= bottom + 1e-6
        shows = (x > 0) & (x < SIZE[0]) & (y > 0) & (y < SIZE[1])
        assert boxes.inside[0] or not shows.any()


@pytest.mark.parametrize("mesh", MESHES[:5])
def test_the_extents_are_those_of_the_corners(mesh):
    """In front of the near plane no box is wider than what it holds."""
    rng = np.random.default_rng(3)
    camera = look_at(np.array([1.0, 2, 9]), np.zeros(3), fov_y=0.8, near=0.3, far=40)
    pose = transforms.placed(rng.uniform(-1, 1, 3), transforms.random_rotation(rng), 1.0)
    scene = Scene((Object(mesh, pose),))
    boxes = screen_boxes(scene.corners, camera, SIZE, scene.around)
    seen = surface(scene.objects[0], camera, rng)
    x, y = seen[:, :2].T / -seen[:, 2] * camera.lens(SIZE[1]) * [[1], [-1]]
    truth = [x.min() + 80, y.min() + 60, x.max() + 80, y.max() + 60]
    np.testing.assert_allclose(boxes.extents[0], truth, atol=1e-9)


def test_of_a_mesh_with_many_corners_its_bounds_are_taken():
    """Else each frame would look at all of them."""
    assert len(MESHES[-1].hull) > AROUND
    assert len(MESHES[-1].around) == 8
    np.testing.assert_array_equal(
        [MESHES[-1].around.min(axis=0), MESHES[-1].around.max(axis=0)], MESHES[-1].bounds
    )
