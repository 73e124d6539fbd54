"""Keys for the view that change published tasks, and so are off there."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from seethrough.renderer.events import KeyPress, PointerMove, Tick
from seethrough.tasks.kit.base import Setting
from seethrough.tasks.kit.hud import FloorPlan, Label
from seethrough.tasks.unique import TASK
from seethrough.tasks.unique.unique_task import UniqueParameters
from seethrough.tasks.worlds.abstract import WORLD as ABSTRACT
from seethrough.tasks.worlds.building import WORLD as BUILDING


@pytest.mark.parametrize("aspect", [4 / 3, 1.0, 0.5])
@pytest.mark.parametrize("turn", [0.0, 1.1, 4.0])
def test_the_sphere_about_the_things_touches_the_smaller_side(aspect, turn):
    """Whichever way it is turned; the sphere is about the middle, which one turns about."""
    p = ABSTRACT.Parameters(fills="things", objects=30)
    place = ABSTRACT.make(np.random.default_rng(3), p)
    viewer = ABSTRACT.viewer(place, p, aspect)
    camera = viewer.on_event(PointerMove(1.0, 0.5, 0.5, turn / np.pi, 0.0, dragging=True)).camera()
    scene = place.scene
    radius = (np.linalg.norm(scene.centers, axis=1) + scene.radii).max()
    # A sphere's outline is seen at the angle asin(r / d) from its middle.
    outline = np.tan(np.arcsin(radius / np.linalg.norm(camera.eye)))
    half = np.tan(camera.fov_y / 2) * np.array([aspect, 1.0])
    assert_allclose(outline, half.min(), rtol=1e-12)
    # What is not cut: every thing lies between the planes.
    depth = camera.depth(scene.centers)
    assert (depth - scene.radii > camera.near).all() and (depth + scene.radii < camera.far).all()


def test_by_default_the_view_holds_the_cube():
    p = ABSTRACT.Parameters()
    assert p.fills == "cube"
    place = ABSTRACT.make(np.random.default_rng(3), p)
    assert_allclose(
        ABSTRACT.viewer(place, p, 4 / 3).distance, 1.02 * 50 * 3**0.5 / np.sin(np.pi / 6)
    )


def played(**asked):
    """The plan after a walk of two seconds, and where it began and ended."""
    setting = Setting(BUILDING, BUILDING.Parameters(), UniqueParameters(**asked))
    made = TASK.make_scene(np.random.default_rng(7), setting)
    state = TASK.begin(made, setting, 4 / 3)
    start = TASK.view(state).camera
    for event in (Tick(0.0), KeyPress(0.0, "up"), Tick(2.0), KeyPress(2.0, "space"), Tick(2.1)):
        state = TASK.on_event(state, event)
    view = TASK.view(state)
    (plan,) = [e for e in view.hud if isinstance(e, FloorPlan)]
    words = [e.text for e in view.hud if isinstance(e, Label)]
    return state, plan, words, start, view.camera


def test_the_plan_shows_where_one_began_and_was():
    state, plan, words, start, end = played(start_mark=True, you_were_here=True)
    assert_allclose(plan.start, state.plan.on_view(start.eye[0], start.eye[2]))
    assert_allclose(plan.here[0], state.plan.on_view(end.eye[0], end.eye[2]), atol=0.02)
    assert np.hypot(*np.subtract(plan.start, plan.here[0])) > 0.01  # it is not where it began
    toward = np.subtract(plan.here[1], plan.here[0])
    assert_allclose(toward / np.hypot(*toward), end.forward[[0, 2]], atol=1e-9)
    assert words[1:] == ["plan.start", "plan.here"]
    shown = TASK.solution(state)
    assert shown.start == plan.start and shown.here == plan.here


@pytest.mark.parametrize("asked", [{}, {"start_mark": True}, {"you_were_here": True}])
def test_the_plan_shows_no_more_than_is_asked_for(asked):
    _, plan, words, _, _ = played(**asked)
    assert (plan.start is not None) == ("start_mark" in asked)
    assert (plan.here is not None) == ("you_were_here" in asked)
    assert len(words) == 1 + len(asked)
