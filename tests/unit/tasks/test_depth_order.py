"""Which of two marked things is nearer: the pair, its marks and the answer."""

import numpy as np
import pytest

from seethrough.experiment.suites.played import played
from seethrough.renderer.events import KeyPress, PointerPress
from seethrough.tasks.catalog import TASKS, WORLDS, setting
from seethrough.tasks.depth_order.depth_order_task import DepthOrderParameters, buttons
from seethrough.tasks.depth_order.pair import LIFT
from seethrough.tasks.kit.errors import NoScene
from seethrough.tasks.kit.hud import Label

TASK = TASKS["depth_order"]
WORLD_NAMES = ("abstract", "building")


def begun(world, seed, ratio=1.2, aspect=4 / 3):
    given = setting(TASK, WORLDS[world].Parameters(), DepthOrderParameters(ratio))
    return TASK.begin(TASK.make_scene(np.random.default_rng(seed), given), given, aspect)


@pytest.mark.parametrize("world", WORLD_NAMES)
@pytest.mark.parametrize("ratio", [1.2, 1.6])
def test_the_pair_is_in_view_and_as_far_apart_as_asked(world, ratio):
    """By the camera's matrices, which the task does not use."""
    for seed in range(8):
        for aspect in (4 / 3, 16 / 9):
            state = begun(world, seed, ratio, aspect)
            view, made = TASK.view(state), state.marked
            camera = view.camera
            points = np.c_[view.scene.centers[list(made.pair)], np.ones(2)]
            clip = points @ (camera.projection(aspect) @ camera.view()).T
            depth = clip[:, 3]
            assert depth.max() >= ratio * depth.min()
            assert made.nearer == int(depth.argmin())
            assert all(view.scene.targets[list(made.pair)])
            device = clip[:, :2] / depth[:, None]
            assert (np.abs(device) < 1).all()
            at = np.c_[(device[:, 0] + 1) / 2 * aspect, (1 - device[:, 1]) / 2]
            marks = [e for e in view.hud if isinstance(e, Label) and len(e.text) == 1]
            assert [m.text for m in marks] == ["A", "B"]
            assert np.allclose([m.at for m in marks], at - [0, LIFT], atol=1e-9)


def test_either_is_the_nearer_one_equally_often():
    nearer = [begun("abstract", seed).marked.nearer for seed in range(60)]
    assert 15 < sum(nearer) < 45  # 60 fair coins: outside once in ten thousand


def test_the_first_answer_counts_by_key_and_by_button():
    state = begun("abstract", 3)
    truth = "AB"[state.marked.nearer]
    wrong = "BA"[state.marked.nearer]
    assert TASK.outcome(TASK.on_event(state, KeyPress(1.0, "c"))) is None
    assert TASK.outcome(TASK.on_event(state, PointerPress(1.0, 0.1, 0.9))) is None
    for answer, right in ((truth, True), (wrong, False)):
        rect = buttons(4 / 3)[answer]
        middle = (rect.x + rect.width / 2, rect.y + rect.height / 2)
        for event in (KeyPress(1.0, answer.lower()), PointerPress(1.0, *middle)):
            done = TASK.on_event(state, event)
            outcome = TASK.outcome(done)
            assert (outcome.answer, outcome.truth, outcome.correct) == (answer, truth, right)
            assert TASK.on_event(done, KeyPress(2.0, "a")) is done
            assert TASK.on_event(done, KeyPress(2.0, "b")) is done


@pytest.mark.parametrize("world", WORLD_NAMES)
def test_simulated_people_see_the_larger_difference_better_than_chance(world):
    given = setting(TASK, WORLDS[world].Parameters(), DepthOrderParameters(1.5))
    right = sum(played(TASK, given, seed).outcome.correct for seed in range(20))
    assert right >= 16  # of 20 fair coins so many come up once in 170 tries


def test_a_ratio_that_no_world_has_is_said():
    with pytest.raises(
        NoScene, match="ratio = 10: expected two targets in one view of the world abstract"
    ):
        begun("abstract", 1, ratio=10.0)
