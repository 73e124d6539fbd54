"""A frame is the same picture, to the bit, whatever was drawn before it: replay needs that."""

from dataclasses import replace

import numpy as np
import pytest
from played_tasks import begin

from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

SIZE = (800, 600)
CLOUD = AbstractParameters(side=50.0, objects=60, target_share=(0.3, 0.4))
HOUSE = BuildingParameters(grid=6, objects=8, count=(1, 3), types=("chair", "table", "cat"))


def views():
    """Eight clouds and a building, each with its first view."""
    found = []
    for seed, name in enumerate(["count", "pattern"] * 4 + ["unique"]):
        task = TASKS[name]
        place = CLOUD if "abstract" in task.worlds else HOUSE
        found.append(task.view(begin(name, place, seed=seed)))
    return found


def drawn(renderer, view):
    renderer.draw(view.scene, view.camera, DynamicTransparency())
    return renderer.read().copy()


@pytest.fixture(scope="module")
def context():
    return standalone()


def test_a_picture_does_not_depend_on_what_was_drawn_before(context):
    shown = views()
    alone = [drawn(Renderer(context, SIZE), view) for view in shown]
    one = Renderer(context, SIZE)
    for order in (range(9), reversed(range(9))):
        for k in order:
            np.testing.assert_array_equal(drawn(one, shown[k]), alone[k])


def test_masks_that_outgrow_their_buffer_between_two_kinds_of_frame_leave_no_trace(context):
    """Parts sorted by pixel borrow the masks of the frame; those of a frame sorted as a whole are
    their own, and more than the first buffer holds here."""
    some, whole = DynamicTransparency(doubt=0.0), DynamicTransparency(exact=True)
    frames = ((view, plan(view.scene, view.camera, some, SIZE)) for view in views())
    view = next(view for view, frame in frames if frame.levels and len(frame.exact))
    crowd = replace(
        view.scene, objects=tuple(replace(o, target=True) for o in 8 * view.scene.objects)
    )
    alone = Renderer(context, SIZE)
    alone.draw(view.scene, view.camera, some)
    expected = alone.read().copy()
    one = Renderer(context, SIZE)
    for scene, technique in ((view.scene, some), (crowd, whole), (view.scene, some)):
        one.draw(scene, view.camera, technique)
    np.testing.assert_array_equal(one.read(), expected)
