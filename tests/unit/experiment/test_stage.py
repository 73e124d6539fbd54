"""Small pictures of a stage: kept while they have one size, replaced when they have another."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.interface import INSET_TEXTURES
from seethrough.experiment.pages.pages import Picture
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.hud import Inset, Rect

CAMERA = look_at(np.array([0.0, 0.0, 4.0]), np.zeros(3), fov_y=0.8, near=1, far=9)
VIEW = View(Scene((Object(box(1, 1, 1), color=(0.9, 0.1, 0.1)),)), CAMERA)


@pytest.fixture
def stage(context):
    made = Stage(context, (80, 60), Texts("en"))
    yield made
    made.interface.close()


def inset(width, height):
    return Inset(VIEW.scene, lambda: CAMERA, Rect(0.1, 0.1, width, height))


def test_a_picture_is_kept_until_it_has_another_size(stage):
    names = [stage._inset(0, inset(0.5, 0.25), 60) for _ in range(3)]
    assert names == [INSET_TEXTURES + 1] * 3
    kept = stage._pictures[0]
    assert kept.size == (30, 15)
    stage._inset(0, inset(0.5, 0.25), 60)
    assert stage._pictures[0] is kept
    stage._inset(0, inset(0.5, 0.5), 60)
    assert stage._pictures[0] is not kept and stage._pictures[0].size == (30, 30)


def test_pictures_side_by_side_have_names_of_their_own(stage):
    assert [stage._inset(n, inset(0.3, 0.3), 60) for n in (0, 1, 2)] == [
        INSET_TEXTURES + n for n in (1, 2, 3)
    ]
    assert stage._picture(Picture(lambda: VIEW, Standard()), 40, 30) == INSET_TEXTURES
    assert {p.size for p in stage._pictures.values()} == {(18, 18), (40, 30)}
    assert len(stage.interface.overlay._textures) == 4


def test_one_too_small_to_be_seen_has_a_pixel(stage):
    stage._inset(0, inset(0.001, 0.0), 60)
    assert stage._pictures[0].size == (1, 1)


def test_what_a_picture_shows_is_its_view(stage):
    stage._picture(Picture(lambda: VIEW, Standard()), 40, 30)
    pixels = np.frombuffer(stage._pictures[-1]._texture.read(), np.uint8).reshape(30, 40, 4)
    red = pixels[..., 0] > 2 * pixels[..., 1].astype(int)
    half = 0.5 / 3.5 / np.tan(0.4) * 15  # the front side's half, in pixels
    assert red.sum() == pytest.approx((2 * half) ** 2, rel=0.15)  # whole pixels of 10
    assert red[15, 20] and not red[0, 0]
