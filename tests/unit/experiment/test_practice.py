"""Practice trials are marked as such, feedback is in metres, and waiting is told."""

import threading
import time

import numpy as np
import pytest
from every_page import begun, ended
from every_page import marked as mark
from scripted_session import ANSWERS, FakeDisplay, MemoryRecorder, ScriptedInput, study

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.waiting import PATIENCE, meanwhile
from seethrough.experiment.pages.pages import PlanPicture
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.session import _feedback, run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.renderer.events import KeyPress, PointerPress, Tick
from seethrough.tasks.catalog import TASKS, WORLDS
from seethrough.tasks.explore import EXPLORE
from seethrough.tasks.kit.base import Outcome, Setting
from seethrough.tasks.kit.hud import Label

STUDY = load("published")
SETS = session_for(1, STUDY.plan)


def marked(view):
    return any(isinstance(e, Label) and e.tone == "practice" for e in view.hud)


class Looker:
    """Display, input and recorder of a trial in which nobody answers."""

    aspect = 4 / 3

    def __init__(self, clock):
        self.clock, self.shown = clock, []

    def show(self, view, technique):
        self.shown.append(view)
        return self.clock.now()

    def events(self, view):
        self.clock.advance(self.clock.now() + 0.25)
        return [KeyPress(self.clock.now(), "enter"), Tick(self.clock.now())]

    def digest(self):
        return ""

    def nothing(self, *_):
        pass

    begin_trial = trial_begins = frame = event = nothing


def played(trial, **how):
    """(views, record) of a trial that ends at its limit of 2 s."""
    clock = SimulatedClock(1.0)
    looker = Looker(clock)
    world = Surroundings(looker, looker, clock, looker, TASKS, **how)
    return looker.shown, TrialRun(STUDY, world).play(trial, 2.0)


@pytest.mark.parametrize("task", STUDY.tasks())
def test_every_frame_of_a_practice_trial_is_marked_and_none_of_any_other(task):
    (task_set, *_) = [t for t in SETS if t.trials[0].task == task]
    for trial in (task_set.training[0], task_set.trials[0]):
        views, record = played(trial)
        assert len(views) == 9 - 1 and record.timed_out
        assert [marked(v) for v in views] == [trial.training] * 8
        hints = [e.text for e in views[-1].hud if isinstance(e, Label) and e.tone == "hint"]
        assert hints  # Enter without an answer, in every task


@pytest.mark.parametrize(
    ("units", "correct", "en", "de"),
    [
        (41.6, False, "not in the right room. It was 21 m", "nicht im richtigen Raum. Sie war 21"),
        (9.3, True, "in the right room, 4.7 m from", "im richtigen Raum, 4,7 m vom"),
        (19.88, True, "9.9 m", "9,9 m"),
        (19.98, True, " 10 m", " 10 m"),
        (0.0, True, "0.0 m", "0,0 m"),
    ],
)  # fmt: skip
def test_distances_are_in_metres_with_the_digits_that_matter(units, correct, en, de):
    outcome = Outcome("0,0", "1,1", correct, distance=units)
    record = TrialRecord(None, outcome, 1, 0.0, 1.0, 0.0, False, 9, 0, 0.0, 0.0, 0.0)
    paragraph = _feedback(record, TASKS["unique"]).blocks[0]
    assert en in Texts("en").fill(paragraph.text, paragraph.values)
    assert de in Texts("de").fill(paragraph.text, paragraph.values)


def test_feedback_of_a_marked_place_has_its_plan():
    task = TASKS["unique"]
    state = mark(begun("unique", 4 / 3), "left")
    page = _feedback(ended(None, task.outcome(state), task.solution(state)), task)
    (plan,) = [b.plan for b in page.blocks if isinstance(b, PlanPicture)]
    assert plan.mark is not None and plan.place is not None and len(plan.walls) > 4


def test_meanwhile_shows_frames_until_the_work_is_done_and_gives_its_result():
    go, frames = threading.Event(), []

    def frame():
        frames.append(time.monotonic())
        if len(frames) == 5:
            go.set()

    def work():
        assert go.wait(20)
        return "made"

    assert meanwhile(work, frame, 0.0) == "made"
    assert len(frames) >= 5


def test_meanwhile_says_nothing_of_quick_work_but_on_a_page_once():
    frames = []
    assert meanwhile(lambda: 1, lambda: frames.append(1), 60.0) == 1
    assert frames == []
    assert meanwhile(lambda: 1, lambda: frames.append(1), 0.0) == 1
    assert len(frames) >= 1
    assert PATIENCE < 0.2


def test_what_goes_wrong_in_the_work_or_in_a_frame_is_raised():
    def fails():
        raise ValueError("no room")

    with pytest.raises(ValueError, match="no room"):
        meanwhile(fails, lambda: None, 0.0)

    def left():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        meanwhile(lambda: time.sleep(0.05), left, 0.0)


def test_the_scene_is_made_while_the_world_waits():
    """What `waiting` is given makes the trial's first state; nothing else is done in it."""
    made = []

    def waiting(work):
        made.append(work())
        return made[-1]

    trial = next(t.trials[0] for t in SETS if t.trials[0].task == "count")
    views, _ = played(trial, waiting=waiting)
    assert [state.cloud.scene for state in made] == [views[0].scene]


@pytest.mark.parametrize("explores", [True, False])
def test_people_may_look_around_before_they_practise(explores):
    """Until Enter, or for so long; in a scene that is no trial's; simulated people do not."""
    config = study(practice={"trials": 1, "explore": 5.0}, design={"trials": 1, "tasks": ["count"]})
    found = {}
    for name, keys in (("enter", ["left", "enter"]), ("limit", ["left"])):
        clock = SimulatedClock(100.0)
        recorder = MemoryRecorder()
        person = ScriptedInput(clock, {**ANSWERS, "explore": keys})
        world = Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS, explores=explores)
        assert run_session(config, 1, world) == "complete"
        found[name] = recorder
        looked = [t for t in recorder.begun if t.task == "explore"]
        assert len(looked) == (2 if explores else 0)
        assert {t.stream for t in looked}.isdisjoint(t.stream for t in recorder.begun
                                                     if t.task != "explore")  # fmt: skip
        assert [r.trial.task for r in recorder.ended] == ["count", "count"]
    if explores:
        began = [[t.task for t in r.begun] for r in found.values()]
        assert began[0] == began[1] == ["explore", "count", "count"] * 2


def test_looking_around_moves_as_the_world_does():
    """Orbiting turns by the arrow keys, and a click on the button is enough; walking captures the
    pointer, so Enter is."""
    for name, walks in (("abstract", False), ("building", True), ("scene", False)):
        world = WORLDS[name]
        place = world.Parameters()
        made = world.make(np.random.default_rng(1), place)
        start = EXPLORE.begin(made, Setting(world, place, None), 4 / 3)
        view = EXPLORE.view(start)
        assert view.captured == walks and view.scene.targets.any()
        later = EXPLORE.on_event(EXPLORE.on_event(start, KeyPress(0.0, "left")), Tick(0.5))
        assert not np.allclose(EXPLORE.view(later).camera.rotation, view.camera.rotation)
        assert EXPLORE.outcome(later) is None
        rect = start.button.rect if start.button else None
        done = PointerPress(1.0, rect.x + 0.01, rect.y + 0.01) if rect else KeyPress(1.0, "enter")
        assert EXPLORE.outcome(EXPLORE.on_event(later, done)) is not None
