"""The exact picture's surfaces, and that nothing it is checked against has a part in it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from sample_scenes import before_column, column

from seethrough.renderer.reference.pixel_fragments import fragments
from seethrough.renderer.reference.surfaces import surfaces
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.base import Shot

SIZE = (96, 72)
ALONE = """
import sys
import numpy as np
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques import named
from seethrough import registry

scene = Scene((Object(geometry.box(), translation(0, 0, -4)),
               Object(geometry.sphere(), translation(0, 0, -8), target=True)))
for name in registry.known("technique"):
    exact(scene, Camera(np.zeros(3), np.eye(3)), named(name), (32, 24))
print("LOADED", *(m for m in sys.modules if m.startswith("seethrough.renderer")))
"""


def test_the_reference_knows_neither_plans_nor_the_gpu() -> None:
    """Neither does any technique's rule: what draws the picture does not say what is right."""
    command = [sys.executable, "-c", ALONE]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    loaded = run.stdout.partition("LOADED ")[2].split()
    assert "seethrough.renderer.reference.reference" in loaded
    parts = ("seethrough.renderer.plan", "seethrough.renderer.gpu")
    assert not [m for m in loaded if m.startswith(parts)]


@pytest.mark.parametrize("seed", range(4))
def test_the_nearest_front_faces_are_those_of_another_scan(seed: int) -> None:
    """The depth buffer of `fragments` has the same depths, triangles and lit pixels."""
    scene, camera = column(seed), before_column(seed)
    seen, edges = surfaces(Shot(scene, camera, SIZE))
    truth = fragments(scene, camera, SIZE)
    first = seen.first(seen.front)
    depth = np.full((len(scene.objects), SIZE[0] * SIZE[1]), np.inf)
    depth[seen.object[first], seen.pixel[first]] = seen.depth[first]
    np.testing.assert_array_equal(depth.reshape(truth.depth.shape), truth.depth)
    np.testing.assert_array_equal(edges[0], truth.near_edge)
    np.testing.assert_array_equal(
        seen.triangle[first],
        truth.surface.reshape(len(depth), -1)[seen.object[first], seen.pixel[first]],
    )


def test_a_box_shows_front_and_back_where_rays_meet_its_sides() -> None:
    """Each ray meets a box twice: depths, sides, normals and places in closed form."""
    box = Object(geometry.box(4, 3, 2), transforms.translation(0.3, -0.2, -5))
    camera = Camera(np.zeros(3), np.eye(3), fov_y=0.3)
    seen, edges = surfaces(Shot(Scene((box,)), camera, (40, 30)))
    assert (np.diff(seen.starts) == 2).all()  # it fills the view, which is narrower than its front
    assert seen.front.tolist() == [True, False] * 1200
    np.testing.assert_allclose(seen.depth, [4.0, 6.0] * 1200, rtol=1e-12)
    np.testing.assert_allclose(seen.normal[::2], [[0, 0, 1]] * 1200, atol=1e-12)
    np.testing.assert_allclose(seen.normal[1::2], [[0, 0, -1]] * 1200, atol=1e-12)
    scale = 15 / np.tan(0.15)
    x = (seen.place[:, 0] - 20) / scale * seen.depth
    y = (15 - seen.place[:, 1]) / scale * seen.depth
    np.testing.assert_allclose(seen.offset, np.stack([x, y, -seen.depth], axis=1), atol=1e-12)
    assert not edges.all()


def test_rows_come_by_pixel_from_the_front_and_the_later_object_first() -> None:
    """Of two boxes at the same place, the second one comes first at each pixel."""
    box = Object(geometry.box(), transforms.translation(0, 0, -4))
    scene = Scene((box, replace(box, color=(1, 0, 0))))
    seen, _ = surfaces(Shot(scene, Camera(np.zeros(3), np.eye(3), fov_y=0.2), (8, 6)))
    assert (np.diff(seen.pixel) >= 0).all()
    assert seen.object[:4].tolist() == [1, 0, 1, 0]
    assert seen.nearest(seen.object == 0).tolist() == pytest.approx([3.5] * 48)
    assert seen.farthest(seen.front).tolist() == pytest.approx([3.5] * 48)
