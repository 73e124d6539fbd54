"""The four tasks, played through their events: answers, scores, and what is on the view."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from played_tasks import ASPECT, PUBLISHED, begin, begun, button, click, keys, of, play

from seethrough.renderer.events import (
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    Tick,
)
from seethrough.tasks.catalog import TASKS, setting
from seethrough.tasks.kit.entry import NumberEntry
from seethrough.tasks.kit.hud import Button, Entry, FloorPlan, Inset, Label
from seethrough.tasks.kit.letters import LETTERS
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import RED
from seethrough.tasks.worlds.building.floor import room_at
from seethrough.tasks.worlds.building.plan_mark import wall_lines


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_trial_begins_without_an_answer_and_is_the_same_again(name):
    task, state = begun(name)
    assert task.name == name and task.outcome(state) is None
    view, again = task.view(state), task.view(begun(name)[1])
    assert np.array_equal(view.scene.transforms, again.scene.transforms)
    assert np.array_equal(view.camera.eye, again.camera.eye)
    assert of(Label, view)
    assert view.captured == ("building" in task.worlds)


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_scene_that_is_given_is_used(name):
    task, _ = begun(name)
    made = task.make_scene(np.random.default_rng(3), setting(task))
    states = [begin(name, made=made, seed=s) for s in (1, 2)]
    assert task.view(states[0]).scene is task.view(states[1]).scene


def test_count_scores_answer_minus_truth():
    task, state = begun("count")
    truth = sum(o.color == RED for o in task.view(state).scene.objects)
    for answer in (truth - 2, truth, truth + 1):
        ended = play(task, state, [*keys(str(answer)), KeyPress(1.0, "enter")])
        outcome = task.outcome(ended)
        assert outcome.count_error == answer - truth
        assert outcome.correct == (answer == truth)
        assert (outcome.answer, outcome.truth) == (str(answer), str(truth))
        assert outcome.distance is None


def test_count_with_the_mouse_alone():
    task, state = begun("count")
    view = task.view(state)
    for text in ("3", "7", "button.backspace", "1", "button.confirm"):
        state = play(task, state, click(button(view, text)))
    assert task.outcome(state).answer == "31"
    assert_allclose(task.view(state).camera.eye, view.camera.eye)  # clicks did not turn the view


def test_a_press_on_a_button_does_not_drag_the_view():
    task, state = begun("count")
    rect = button(task.view(state), "5")
    press = click(rect)[0]
    drag = PointerMove(1.1, rect.x, 0.5, 0.0, -0.4, dragging=True)
    held = play(task, state, [press, drag])
    assert_allclose(task.view(held).camera.eye, task.view(state).camera.eye)
    free = play(task, held, [PointerRelease(1.2, 0.5, 0.5), PointerPress(1.3, 0.5, 0.5), drag])
    assert np.linalg.norm(task.view(free).camera.eye - task.view(state).camera.eye) > 10


def test_the_answer_stays_once_confirmed():
    task, state = begun("count")
    ended = play(
        task, state, [*keys("12"), KeyPress(1, "enter"), *keys("34"), KeyPress(2, "enter")]
    )
    assert task.outcome(ended).answer == "12"


@pytest.mark.parametrize(
    "typed, text",
    [
        (["0", "0", "7"], "7"),
        (["0"], "0"),
        (["1", "2", "3", "4", "5"], "1234"),
        (["a", "1", "left", "²", ""], "1"),
        (["4", "backspace", "backspace"], ""),
    ],
)
def test_number_entry(typed, text):
    entry = NumberEntry(ASPECT)
    for key in typed:
        entry = entry.type(key)
    assert entry.text == text
    assert entry.type("enter").confirmed == (text != "")


@pytest.mark.parametrize("aspect", [1.0, 4 / 3, 16 / 9])
def test_buttons_lie_on_the_view_and_apart(aspect):
    rects = [r for _, r in NumberEntry(aspect).buttons()]
    for i, a in enumerate(rects):
        assert a.x >= 0 and a.y >= 0 and a.x + a.width <= aspect and a.y + a.height <= 1
        for b in rects[:i]:
            assert not b.contains(a.x, a.y) and not b.contains(a.x + a.width, a.y + a.height)


@pytest.mark.parametrize("letter", sorted(LETTERS))
def test_pattern_by_keys(letter):
    task, state = begun("pattern", seed=ord(letter))
    chosen = play(task, state, [KeyPress(1.0, letter.lower())])
    assert task.outcome(chosen) is None
    assert [b.text for b in of(Button, task.view(chosen)) if b.chosen] == [letter]
    outcome = task.outcome(play(task, chosen, [KeyPress(2.0, "enter")]))
    assert outcome.answer == letter
    assert outcome.correct == (outcome.truth == letter)
    assert outcome.count_error is None and outcome.distance is None


def test_pattern_by_mouse_and_changed_minds():
    task, state = begun("pattern")
    view = task.view(state)
    assert [b.text for b in of(Button, view)] == [*sorted(LETTERS), "button.confirm"]
    early = play(task, state, click(button(view, "button.confirm")))
    assert task.outcome(early) is None  # nothing chosen yet
    for text in ("X", "Y", "button.confirm", "C"):
        state = play(task, state, click(button(view, text)))
    assert task.outcome(state).answer == "Y"


def test_all_five_letters_come_up():
    task = TASKS["pattern"]
    given = setting(task, AbstractParameters(objects=120, target_share=(0.2, 0.3)))
    letters = [task.make_scene(np.random.default_rng(s), given).letter for s in range(60)]
    assert set(letters) == set(LETTERS)


def test_unique_by_mouse():
    task, state = begun("unique")
    place = state.building.scene.transforms[state.building.asked_objects[0]][[0, 2], 3]
    state = play(task, state, [KeyPress(5.0, "space")])
    view = task.view(state)
    assert not view.captured and of(FloorPlan, view)[0].mark is None
    assert task.outcome(play(task, state, click(button(view, "button.confirm")))) is None
    x, y = state.plan.on_view(*place)
    state = play(task, state, [PointerPress(6.0, x, y)])
    assert_allclose(of(FloorPlan, task.view(state))[0].mark, (x, y))
    assert task.outcome(state) is None
    outcome = task.outcome(play(task, state, click(button(view, "button.confirm"))))
    assert outcome.correct
    assert_allclose(outcome.distance, 0, atol=1e-12)


def test_unique_by_keys_scores_the_distance():
    task, state = begun("unique")
    b = state.building
    place = b.scene.transforms[b.asked_objects[0]][[0, 2], 3]
    marked = play(task, state, [*keys(["enter", "left", "left", "up", "enter"])])
    outcome = task.outcome(marked)
    mark = np.array([-80 / 32, -80 / 32])  # the first arrow puts the mark in the middle
    assert_allclose(outcome.distance, np.linalg.norm(mark - place), rtol=1e-12)
    assert outcome.answer == "-2.500,-2.500"
    same = room_at(b.floor, *mark, b.parameters) == room_at(b.floor, *place, b.parameters)
    assert outcome.correct == same
    far = play(task, state, [*keys(["enter"] + ["right"] * 40), KeyPress(2, "enter")])
    assert task.outcome(far).answer == "40.000,0.000"  # the mark stays on the plan


def test_the_walker_stands_still_while_the_plan_is_up():
    task, state = begun("unique")
    state = play(task, state, [KeyPress(0.0, "up"), KeyPress(1.0, "enter"), Tick(9.0)])
    assert_allclose(task.view(state).camera.eye[2], 2.5 - 6.0)


def test_the_plan_shows_every_doorway():
    task, state = begun("unique")
    b = state.building
    lines = wall_lines(b)
    assert len(lines) == 4 + 2 * len(b.floor.walls)
    length = sum(np.hypot(x1 - x0, z1 - z0) for (x0, z0), (x1, z1) in lines)
    walls = sum(w.end - w.start for w in b.floor.walls)
    assert_allclose(length, 4 * 80 + walls - len(b.floor.walls) * b.parameters.door_width)
    plan = of(FloorPlan, task.view(play(task, state, [KeyPress(1.0, "enter")])))[0]
    assert all(plan.rect.contains(*end) for line in plan.walls for end in line)
    assert_allclose(state.plan.world(*state.plan.on_view(3.0, -7.0)), (3.0, -7.0))


def test_count_in_building_while_walking():
    task, state = begun("count_in_building")
    truth = sum(o.kind == state.building.asked for o in state.building.scene.objects)
    walking = [KeyPress(1.0, "up"), *keys("12", 1.5), KeyRelease(2.0, "up"), Tick(3.0)]
    state = play(task, state, walking)
    assert [e.text for e in of(Entry, task.view(state))] == ["12"]
    assert_allclose(task.view(state).camera.eye[2], 2.5 - 6.0)
    outcome = task.outcome(play(task, state, [KeyPress(4.0, "enter")]))
    assert (outcome.answer, outcome.count_error) == ("12", 12 - truth)
    # The pointer is captured: pressing it where a button would be types nothing.
    pressed = play(task, state, click(NumberEntry(ASPECT).buttons()[0][1]))
    assert [e.text for e in of(Entry, task.view(pressed))] == ["12"]


@pytest.mark.parametrize("name", ["unique", "count_in_building"])
def test_the_current_target_turns_in_the_upper_left_corner(name):
    task, state = begun(name)
    early, late = (of(Inset, task.view(play(task, state, [Tick(t)])))[0] for t in (0.0, 1.0))
    assert early.scene is late.scene  # one picture, kept by the display
    assert early.rect.x < 0.1 and early.rect.y < 0.1
    assert [o.kind for o in early.scene.objects] == [state.building.asked]
    turn = early.camera.rotation.T @ late.camera.rotation
    assert_allclose((np.trace(turn) - 1) / 2, np.cos(0.8), rtol=1e-9)
    mesh = early.scene.objects[0].mesh
    for element in (early, late):
        clip = (
            np.insert(mesh.vertices, 3, 1, axis=1)
            @ (element.camera.projection(1.0) @ element.camera.view()).T
        )
        assert (np.abs(clip[:, :3]) <= clip[:, 3:]).all()


def test_a_tick_after_which_no_time_has_passed_leaves_the_very_state():
    """So that what follows from a state is not made again for it; a digit makes another one."""
    task = TASKS["count_in_building"]
    moment = task.on_event(begin("count_in_building"), Tick(0.5))
    assert task.on_event(moment, Tick(0.5)) is moment
    assert task.on_event(moment, Tick(0.6)) is not moment
    assert task.on_event(moment, KeyPress(0.5, "7")).entry.text == "7"
