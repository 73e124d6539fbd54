"""A look of a simulated participant is the window's frame made smaller, masks as wide in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.experiment.display.looking import HEIGHT, Looking
from seethrough.experiment.people.runs.pool import LazyDraw
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import View

STUDY = load("published")
WINDOW = (800, 600)
TECHNIQUES = {
    "standard": Standard(),
    "no border": DynamicTransparency(width=0),
    "published": DynamicTransparency(),
    "wide": DynamicTransparency(width=40),
    "circle": DynamicTransparency(mask="circle", width=20),
    "ring": DynamicTransparency(mask="ring", width=20),
    "by pixel": DynamicTransparency(exact=True),
}


@pytest.fixture(scope="module")
def views() -> list[View]:
    """The first view of a trial of each task."""
    scenes, found = StudyScenes(STUDY), {}
    for task_set in session_for(1, STUDY.plan):
        trial = task_set.trials[0]
        task = TASKS[trial.task]
        found[trial.task] = task.view(scenes.begin(task, trial, 4 / 3))
    return list(found.values())


def _reduced(picture, size):
    """Means over the window's pixels that make up one of the small picture."""
    parts = picture.shape[0] // size[1]
    return picture.reshape(size[1], parts, size[0], parts, 3).mean(axis=(1, 3), dtype=float)


@pytest.mark.parametrize(
    ("name", "window"), [*((n, WINDOW) for n in TECHNIQUES), ("published", (1600, 1200))]
)
def test_a_look_is_the_windows_frame_made_smaller(context, views, name, window):
    """The mean colour, and how much of the picture each object has.

    A small picture takes one of 16 pixels or more, the frame all of them. Over 30,000 pixels,
    most of them edges of something, that moves the mean colour by at most .3 of 255 as measured,
    so 1 is allowed; at the edges, objects win and lose 6 % of what all have, so 10 % are. Masks
    as many pixels wide in the small picture as in the window move them by over 4, and by a third.
    """
    technique = TECHNIQUES[name]
    frame, eyes = Renderer(context, window), Looking(context, window)
    eyes.technique = technique
    for view in views:
        frame.draw(view.scene, view.camera, technique)
        seen = eyes.look(view)
        picture = eyes._renderer._small.read()
        apart = picture - _reduced(frame.read(), eyes.size)
        assert np.abs(apart.mean(axis=(0, 1))).max() < 1.0
        whole = frame.look(view.scene, view.camera, technique, window)
        assert np.abs(seen.area - whole.area).sum() < 0.10 * whole.area.sum()


def test_a_mask_keeps_its_part_of_the_picture_whatever_the_window(context, views):
    """Twice the window, twice the width in its pixels: the same look, to the last bit."""
    for name in ("published", "wide", "circle"):
        technique = TECHNIQUES[name]
        double = type(technique)(mask=technique.mask, width=2 * technique.width)
        looks = []
        for window, shown in ((WINDOW, technique), ((1600, 1200), double)):
            eyes = Looking(context, window)
            eyes.technique = shown
            looks.append(eyes.look(views[0]))
        for one, other in zip(*(vars(seen).values() for seen in looks), strict=True):
            np.testing.assert_array_equal(one, other)


def test_a_window_of_another_size_is_looked_at_anew(context, views):
    """Somebody who watches may drag the window's edge: the eyes take its size as it is now."""
    eyes, fresh = Looking(context, WINDOW), Looking(context, (1200, 900))
    eyes.technique = fresh.technique = DynamicTransparency()
    first = eyes.look(views[0])
    eyes.resize((1200, 900))
    again, right = eyes.look(views[0]), fresh.look(views[0])
    np.testing.assert_array_equal(again.area, right.area)
    assert not np.array_equal(first.area, again.area)
    eyes.resize((600, 600))
    assert eyes.size == (HEIGHT, HEIGHT)


def test_tables_hold_what_the_eyes_see(context, views):
    """Data mode draws for its tables what visual mode looks at, in the study's own window."""
    display = STUDY.display.model_copy(update={"width": 1024, "height": 768})
    study = replace(STUDY, display=display)
    eyes, draws = Looking(context, (1024, 768), simple=True), LazyDraw(study)
    for technique in (Standard(), DynamicTransparency()):
        eyes.technique = technique
        for view in views:
            drawn, seen = draws(technique)(view.scene, view.camera), eyes.look(view)
            np.testing.assert_array_equal(drawn.area, seen.area)
            np.testing.assert_array_equal(drawn.contrast, seen.contrast)
