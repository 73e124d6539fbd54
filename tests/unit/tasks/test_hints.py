"""What does nothing says why: a hint that follows from the events alone, and goes with the next."""

import numpy as np
import pytest
from played_tasks import begun, button, click, keys, of, play

from seethrough.renderer.events import KeyPress, PointerPress
from seethrough.tasks.kit.hud import FloorPlan, Label
from seethrough.tasks.worlds.building.building_parameters import METRES
from seethrough.tasks.worlds.building.floor import room_at

ENTER = [KeyPress(1.0, "enter")]


def hints(task, state):
    return [e.text for e in of(Label, task.view(state)) if e.tone == "hint"]


@pytest.mark.parametrize(
    ("name", "pressed", "said", "then"),
    [
        ("count", ["enter"], "hint.number", "7"),
        ("count", ["x"], "hint.digits", "7"),
        ("count", ["7", "backspace", "enter"], "hint.number", "7"),
        ("count", ["1", "2", "3", "4", "5"], "hint.long", "backspace"),
        ("count_in_building", ["enter"], "hint.number", "0"),
        ("count_in_building", ["m"], "hint.digits", "0"),
        ("pattern", ["enter"], "hint.letter", "k"),
        ("pattern", ["a"], "hint.letters", "k"),
        ("pattern", ["7"], "hint.letters", "k"),
        ("unique", ["space", "enter"], "hint.mark", "left"),
    ],
)
def test_a_key_that_cannot_be_an_answer_says_what_is_missing(name, pressed, said, then):
    task, state = begun(name)
    assert hints(task, state) == []
    later = play(task, state, keys(pressed))
    assert hints(task, later) == [said] and task.outcome(later) is None
    # Looking around is no answer, and takes no hint away; an answer does.
    assert hints(task, play(task, later, keys(["up"] if name != "unique" else ["q"]))) == [said]
    answered = play(task, later, keys([then]))
    assert hints(task, answered) == []
    assert task.outcome(play(task, answered, ENTER)) is not None


@pytest.mark.parametrize(("name", "said"), [("count", "number"), ("pattern", "letter")])
def test_the_button_says_the_same_as_enter(name, said):
    task, state = begun(name)
    later = play(task, state, click(button(task.view(state), "button.confirm")))
    assert hints(task, later) == [f"hint.{said}"]


def test_a_click_beside_the_plan_says_where_to_click():
    task, state = begun("unique")
    state = play(task, state, keys(["space"]))
    (plan,) = of(FloorPlan, task.view(state))
    beside = play(task, state, [PointerPress(1.0, plan.rect.x - 0.05, 0.5)])
    assert (
        hints(task, beside) == ["hint.outside"] and of(FloorPlan, task.view(beside))[0].mark is None
    )
    confirm = button(task.view(state), "button.confirm")
    assert hints(task, play(task, state, click(confirm))) == ["hint.mark"]
    on = play(task, beside, click(plan.rect))
    assert hints(task, on) == [] and task.outcome(play(task, on, ENTER)) is not None
    # A click beside it later moves no mark, and says so as well.
    later = play(task, on, [PointerPress(2.0, plan.rect.x - 0.05, 0.5)])
    assert hints(task, later) == ["hint.outside"]
    assert of(FloorPlan, task.view(later))[0].mark == of(FloorPlan, task.view(on))[0].mark


@pytest.mark.parametrize("seed", range(4))
def test_the_solution_shows_the_mark_and_the_true_place_at_their_distance(seed):
    task, state = begun("unique", seed)
    ended = play(task, state, keys(["space", "up", *["left"] * 5, *["down"] * seed, "enter"]))
    outcome, plan = task.outcome(ended), task.solution(ended)
    scale = ended.plan.side / plan.rect.width
    apart = scale * np.hypot(plan.mark[0] - plan.place[0], plan.mark[1] - plan.place[1])
    assert apart == pytest.approx(outcome.distance)
    b = ended.building
    places = [((x - plan.rect.x) * scale - b.parameters.side / 2,
               (y - plan.rect.y) * scale - b.parameters.side / 2)
              for x, y in (plan.mark, plan.place)]  # fmt: skip
    rooms = {room_at(b.floor, x, z, b.parameters) for x, z in places}
    assert outcome.correct == (len(rooms) == 1)
    # While the mark is being set, the true place is on no plan.
    assert all(p.place is None for p in of(FloorPlan, task.view(ended)))


def test_metres_are_those_that_doors_and_eyes_were_chosen_in():
    _, state = begun("unique")
    p = state.building.parameters
    assert (METRES * p.door_height, METRES * p.eye_height, METRES * p.speed) == pytest.approx(
        (2.1, 1.6, 3.0)
    )
