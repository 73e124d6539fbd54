"""The picture on an instruction page shows what the task is about, whatever the scene."""

import numpy as np
import pytest
from instruction_pictures import SIZE, sights
from played_tasks import PUBLISHED, begin

from seethrough.experiment.session.viewpoint import best, shown
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.pixel_fragments import fragments
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.tasks.catalog import TASKS, world_of
from seethrough.tasks.kit.base import Example

# Ours; `python tests/support/instruction_pictures.py SEEDS` prints the least over more seeds.
LARGEST = {"unique": 0.01, "count_in_building": 0.01}  # of the picture, the largest thing asked for
SEEN = {"count": 0.5, "pattern": 0.5}  # of the things asked for, with 12 pixels or more


@pytest.mark.parametrize("seed", [2008, 7])
def test_every_instruction_shows_what_is_asked_for(context, seed):
    found = dict(sights(Renderer(context, SIZE), seed))
    assert len(found) == 8
    for (task, _), sight in found.items():
        assert sight.largest >= LARGEST.get(task, 0.0)
        assert sight.seen >= SEEN.get(task, 0.0) * sight.asked
        assert sight.seen >= 1


@pytest.mark.parametrize("task", PUBLISHED)
def test_what_is_counted_is_the_nearest_surface_of_the_whole_scene(task):
    """Leaving out what lies outside of the view changes no pixel."""
    state = begin(task, world_of(TASKS[task]).Parameters(objects=100), seed=5)
    scene = TASKS[task].view(state).scene
    for camera in TASKS[task].example(state, 4 / 3).cameras[::12]:
        depth = fragments(scene, camera, (32, 24)).depth
        first = depth.argmin(axis=0)[np.isfinite(depth.min(axis=0))]
        counts = np.bincount(first, minlength=len(scene.objects))
        assert np.array_equal(shown(scene, camera, (32, 24)), counts)


def test_the_camera_that_sees_the_thing_is_taken_and_not_the_one_before_a_wall():
    thing = Object(box(1, 1, 1), translation(0, 0, 0), target=True)
    wall = Object(box(4, 4, 0.1), translation(0, 0, 3))
    scene, half_turn = Scene((thing, wall)), np.diag([-1.0, 1.0, -1.0])
    behind_wall = Camera(np.array([0.0, 0.0, 6.0]), np.eye(3), near=0.1, far=20.0)
    free = Camera(np.array([0.0, 0.0, -6.0]), half_turn, near=0.1, far=20.0)
    away = Camera(np.array([0.0, 0.0, -6.0]), np.eye(3), near=0.1, far=5.0)
    assert shown(scene, behind_wall)[0] == 0 < shown(scene, free)[0]
    for cameras in ((behind_wall, free, away), (free, away, behind_wall)):
        assert best(scene, Example((0,), cameras)) is free
