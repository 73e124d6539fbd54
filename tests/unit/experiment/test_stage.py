"""Small pictures of a stage: kept while they have one size, replaced when they have another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment.display.stage import Stage
from seethrough.experiment.pages.interface import INSET_TEXTURES
from seethrough.experiment.pages.pages import Picture
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
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


@pytest.mark.parametrize("mask", ["outline", "hull", "ring", "circle"])
@pytest.mark.parametrize("window", [60, 240])
def test_a_mask_is_as_wide_against_the_picture_as_against_the_window(context, mask, window):
    """A border of so many pixels of the window is that part of them in a picture of part of its
    height: what an instruction shows is what the trial will look like, only smaller."""
    target = Object(box(1, 1, 1), translation(0, 0, -3), (0.9, 0.1, 0.1), target=True)
    scene = Scene((Object(box(6, 6, 0.1), color=(0.2, 0.4, 0.9)), target))
    high = 60
    technique = DynamicTransparency(mask=mask, width=4.0 * window / high)
    stage = Stage(context, (window * 4 // 3, window), Texts("en"))
    stage._picture(Picture(lambda: View(scene, CAMERA), technique), 80, high)
    shown = np.frombuffer(stage._pictures[-1]._texture.read(), np.uint8).reshape(high, 80, 4)
    stage.interface.close()
    alone = Renderer(context, (80, high))
    for width, same in ((4.0, True), (8.0, False)):
        alone.draw(scene, CAMERA, replace(technique, width=width))
        assert np.array_equal(shown[::-1, :, :3], alone.read()) == same


def test_a_picture_is_drawn_anew_for_a_window_of_another_height(stage):
    stage._picture(Picture(lambda: VIEW, Standard()), 40, 30)
    kept = stage._pictures[-1]
    stage.resize((160, 120))
    stage._picture(Picture(lambda: VIEW, Standard()), 40, 30)
    assert stage._pictures[-1] is not kept and stage._pictures[-1].window == 120
