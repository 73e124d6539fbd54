"""Every technique but dynamic (tests/hard/test_render_hard.py) where pictures break."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough import registry
from seethrough.experiment.gallery.gallery_techniques import placed
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.base import Shot

SHAPES = (geometry.sphere(1.0, 1), geometry.cone(0.9, 1.6, 20), geometry.box(1.3, 1.3, 1.3))
NAMES = [name for name in registry.known("technique") if name != "dynamic"]
AHEAD = Camera(np.zeros(3), np.eye(3), 0.9, 0.1, 200.0)


def many() -> tuple[Scene, Camera]:
    """200 targets and 100 things among them, by chance into one another."""
    rng = np.random.default_rng(5)
    objects = [
        Object(
            SHAPES[i % 3],
            transforms.placed(rng.uniform(-4, 4, 3), transforms.random_rotation(rng), 0.35),
            tuple(rng.uniform(0.2, 1, 3)),
            target=i < 200,
        )
        for i in range(300)
    ]
    eye = np.array([0, 0, 14.0])
    return Scene(tuple(objects)), look_at(eye, np.zeros(3), fov_y=0.7, near=1, far=60)


def deep() -> tuple[Scene, Camera]:
    """Fifty plates one behind the other before a target."""
    plates = [
        Object(geometry.box(2, 2, 0.1), transforms.translation(0, 0, -5 - k), (0.3, 0.5, 0.9))
        for k in range(50)
    ]
    ball = Object(geometry.sphere(3.0, 2), transforms.translation(0, 0, -60), (0.9, 0.2, 0.1), True)
    return Scene((*plates, ball)), AHEAD


def coplanar() -> tuple[Scene, Camera]:
    """Two boxes whose front faces lie in one plane, and one twice at the same place."""
    box = geometry.box(1, 1, 1)
    at = transforms.translation
    objects = (
        Object(box, at(-0.4, 0, -4), (0.3, 0.5, 0.9)),
        Object(box, at(0.4, 0.3, -4), (0.3, 0.8, 0.3)),
        Object(box, at(0.4, -1.2, -5), (0.6, 0.6, 0.3)),
        Object(box, at(0.4, -1.2, -5), (0.6, 0.6, 0.3)),
        Object(geometry.sphere(0.6, 2), at(0, 0, -8), (0.9, 0.2, 0.1), True),
    )
    return Scene(objects), AHEAD


def flat_and_behind() -> tuple[Scene, Camera]:
    """A target without volume, one behind the viewer, one that the near plane cuts."""
    at, cube = transforms.translation, geometry.box(1.3, 1.3, 1.3)
    sheet = replace(cube, vertices=cube.vertices * [1, 1, 0])
    objects = (
        Object(geometry.box(2, 2, 0.2), at(0, 0, -3), (0.3, 0.5, 0.9)),
        Object(sheet, at(0, 0, -6) @ transforms.rotation_y(0.3), (0.9, 0.2, 0.1), True),
        Object(SHAPES[0], at(0, 0, 5), (0.9, 0.2, 0.1), True),
        Object(SHAPES[0], at(0.9, 0, -0.6), (0.9, 0.6, 0.1), True),
    )
    return Scene(objects), AHEAD


def apart(context, name, scene, camera, size):
    """Steps of 255 by which the exact picture and the drawn one differ, where they may not, and
    the share of the pixels that is left out."""
    p, state = placed(name, Shot(scene, camera, size), 9.0)
    p = p.technique.exactly(p)
    renderer = Renderer(context, size)
    renderer.draw(scene, camera, p, state=state)
    truth = exact(scene, camera, p, size, state)
    steps = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
    return steps.max(initial=0.0), truth.near_edge.mean()


@pytest.mark.parametrize("make", [many, deep, coplanar])
@pytest.mark.parametrize("name", NAMES)
def test_many_deep_and_coplanar(context, name, make):
    """Within 1/255, what lies in one plane being left out: nobody says which of it is in front."""
    steps, left_out = apart(context, name, *make(), (96, 72))
    assert steps <= 1.0
    # Edges of 300 small things, dilated for blueprint, whose lines look at neighbours.
    assert left_out <= (0.2 if make is coplanar or name == "blueprint" else 0.06)


@pytest.mark.parametrize("name", NAMES)
def test_targets_without_volume_behind_the_viewer_and_cut_by_the_near_plane(context, name):
    """They take part as far as they are there."""
    scene, camera = flat_and_behind()
    steps, left_out = apart(context, name, scene, camera, (96, 72))
    assert steps <= 1.0 and left_out <= 0.06


@pytest.mark.parametrize("size", [(1, 1), (301, 7)])
@pytest.mark.parametrize("name", NAMES)
def test_pictures_of_odd_sizes(context, name, size):
    """A single pixel, and a strip."""
    assert apart(context, name, *many(), size)[0] <= 1.0


@pytest.mark.parametrize("name", NAMES)
def test_scenes_without_targets_or_without_anything(context, name):
    """They are drawn, and what there is shows."""
    scene, camera = many()
    others = Scene(tuple(o for o in scene.objects if not o.target))
    assert apart(context, name, others, camera, (48, 36))[0] <= 1.0
    assert apart(context, name, Scene(()), camera, (48, 36)) == (pytest.approx(0, abs=0.51), 0.0)
