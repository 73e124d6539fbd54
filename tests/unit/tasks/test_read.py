"""Reading a sign: what stands there, and what counts as read."""

import numpy as np
import pytest

from seethrough.experiment.suites.played import played
from seethrough.renderer.events import KeyPress
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import named
from seethrough.tasks.catalog import TASKS, setting
from seethrough.tasks.read.read_task import ReadParameters
from seethrough.tasks.read.sign import SIGN, sign_mesh
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters

TASK = TASKS["read"]

# Where ink is in a picture five columns wide and seven rows high, drawn by hand.
DRAWN = {
    0: "##### #...# #...# #...# #...# #...# #####", 1: "....# ....# ....# ....# ....# ....# ....#",
    2: "##### ....# ....# ##### #.... #.... #####", 3: "##### ....# ....# ##### ....# ....# #####",
    4: "#...# #...# #...# ##### ....# ....# ....#", 5: "##### #.... #.... ##### ....# ....# #####",
    6: "##### #.... #.... ##### #...# #...# #####", 7: "##### ....# ....# ....# ....# ....# ....#",
    8: "##### #...# #...# ##### #...# #...# #####", 9: "##### #...# #...# ##### ....# ....# #####",
}  # fmt: skip


def begun(seed, place=None, height=16.0):
    given = setting(TASK, place, ReadParameters(height))
    return TASK.begin(TASK.make_scene(np.random.default_rng(seed), given), given, 4 / 3)


def picture(digit, side):
    """(96, 72) brightness of a sign seen from afar: from its front (1) or from behind (−1)."""
    scene = Scene((Object(sign_mesh(digit)),))
    camera = look_at(np.array([0.0, 0.0, side * 40.0]), np.zeros(3), fov_y=2 * np.arctan(0.5 / 40))
    return exact(scene, camera, named("standard"), (72, 96)).picture.mean(axis=2)


@pytest.mark.parametrize("digit", range(10))
def test_a_sign_shows_its_digit_on_its_front_alone(digit):
    seen = picture(digit, 1)
    rows = [round((0.5 - y) * 95) for y in np.linspace(0.36, -0.36, 7)]
    columns = [round(35.5 + x * 95) for x in np.linspace(-0.2, 0.2, 5)]
    ink = seen[np.ix_(rows, columns)] < 0.4
    assert [" ".join("".join(".#"[int(c)] for c in row) for row in ink)] == [DRAWN[digit]]
    assert (picture(digit, -1) > 0.4).all()


def test_the_sign_is_the_only_target_and_lies_in_the_cube():
    p = AbstractParameters()
    digits = []
    for seed in range(40):
        made = begun(seed).place
        things = made.scene.objects
        assert [i for i, o in enumerate(things) if o.target] == [made.sign]
        assert things[made.sign].kind == f"{SIGN}{made.digit}"
        sign = things[made.sign]
        corners = sign.mesh.vertices @ sign.transform[:3, :3].T + sign.transform[:3, 3]
        assert (np.abs(corners) <= p.side / 2 + 1).all()
        assert np.allclose(sign.transform[:3, 2] / 16.0, made.normal)
        digits.append(made.digit)
    assert set(digits) == set(
        range(10)
    )  # of 40 draws one is missing once in seven: seeds are fixed


def test_the_answer_is_right_or_not():
    state = begun(3)
    digit = state.place.digit
    for answer, right in ((str(digit), True), (str((digit + 1) % 10), False)):
        done = state
        for name in (answer, "enter"):
            done = TASK.on_event(done, KeyPress(1.0, name))
        outcome = TASK.outcome(done)
        assert (outcome.answer, outcome.truth, outcome.correct) == (answer, str(digit), right)
        assert outcome.count_error is None
    assert TASK.outcome(TASK.on_event(state, KeyPress(1.0, "enter"))) is None


def test_simulated_people_turn_until_the_front_is_seen():
    given = setting(TASK)
    for seed in range(10):
        trial = played(TASK, given, seed)
        assert trial.outcome.correct
        camera, made = TASK.view(trial.states[-1]).camera, trial.states[-1].place
        away = camera.eye - made.scene.objects[made.sign].transform[:3, 3]
        assert made.normal @ away > 0


def test_a_sign_that_has_no_room_is_said():
    with pytest.raises(ValueError, match="height = 200, expected a sign that fits a cube of 100"):
        begun(1, height=200.0)
