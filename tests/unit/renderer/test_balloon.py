"""Where a balloon probe's things go, and its rods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose

from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import changed, named
from seethrough.renderer.techniques.base import Shot

PLACES = np.array(
    [[0.5, 0.2, -10.1], [0, 1, -10], [0, -0.3, -10.0], [-1, 0, -9], [0, 0, -10], [7, 0, -10.0]]
)  # two straight above and below the ball's middle, one in it, the last beside it
EYE = Camera(np.zeros(3), np.eye(3))


def test_things_lie_on_the_ball_and_rods_lead_there_from_where_they_were():
    cube = geometry.box(0.4, 0.4, 0.4)
    scene = Scene(tuple(Object(cube, transforms.placed(p), target=True) for p in PLACES))
    p = changed(named("balloon"), radius=2.0, depth=10.0, trace=0.03)
    shown = p.technique.shown(p, p.technique.begin(p), Shot(scene, EYE, (80, 60))).scene
    moved, rods = shown.centers[: len(PLACES)], shown.objects[len(PLACES) :]
    assert_allclose(np.linalg.norm(moved[:5] - [0, 0, -10], axis=1), 2.0)
    assert_allclose(moved[5], PLACES[5])
    straight = np.cross(moved[:4] - PLACES[:4], PLACES[:4] - [0, 0, -10])
    assert_allclose(straight, 0, atol=1e-12)  # away from the middle
    assert len(rods) == 5
    for rod, start, end in zip(rods, PLACES, moved, strict=False):
        corners = rod.mesh.vertices @ rod.transform[:3, :3].T + rod.transform[:3, 3]
        along = (end - start) / np.linalg.norm(end - start)
        length = (corners - start) @ along
        assert_allclose([length.min(), length.max()], [0, np.linalg.norm(end - start)], atol=1e-12)
        aside = corners - start - length[:, None] * along
        assert_allclose(np.linalg.norm(aside, axis=1), 0.06 / np.sqrt(2))  # half of its diagonal
        assert np.linalg.det(rod.transform[:3, :3]) > 0  # its outside is out
    bare = replace(p, trace=0.0)
    none = p.technique.shown(bare, p.technique.begin(bare), Shot(scene, EYE, (80, 60))).scene
    assert len(none.objects) == len(PLACES)
