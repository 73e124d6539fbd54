"""Every page and every task's HUD of the published study, for tests that lay all of them out."""

from dataclasses import replace
from types import SimpleNamespace

from seethrough.experiment.display.display import LEAVE
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.questionnaire import after, asked, before
from seethrough.experiment.session.running import MENU
from seethrough.experiment.session.session import _feedback, _instruction, _page
from seethrough.experiment.session.trial import TrialRun
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_scenes import StudyScenes
from seethrough.experiment.study.tables.ready import one_page
from seethrough.renderer.events import KeyPress, PointerPress
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.kit.base import Outcome
from seethrough.tasks.kit.hud import FloorPlan, practice_mark


class Keeping:
    """Stands in for a participant: keeps each page, answers with the first option."""

    def __init__(self):
        self.pages = []

    def ask(self, page):
        self.pages.append(page)
        return {"button": "0", "age": "", **dict.fromkeys(page.required, "0")}


def pages(aspect):
    """Every page of the published study, and every block of questions there is."""
    study, person = load("published"), Keeping()
    list(asked(before(study, 1), person))
    display = SimpleNamespace(aspect=aspect)
    run = TrialRun(study, SimpleNamespace(scenes=None, display=display, tasks=TASKS))
    for task_set in session_for(1, study.plan):
        person.pages.append(_instruction(study, task_set.trials[0], 8, run))
    names = ("welcome", "ready", "pause", "time", "thanks")
    person.pages += [*map(_page, names), LEAVE, MENU]
    person.pages += [
        one_page("tlx", transparency="dynamic"),
        one_page("sus", transparency="standard"),
    ]
    trial = session_for(1, study.plan)[0].training[0]
    for outcome in (None, Outcome("12", "14", False, count_error=-2), Outcome("K", "K", True)):
        person.pages.append(_feedback(ended(trial, outcome), TASKS["count"]))
    for keys in ("right", "up"), ("left", "down"):
        state = marked(begun("unique", aspect), *keys)
        outcome, plan = TASKS["unique"].outcome(state), TASKS["unique"].solution(state)
        person.pages.append(_feedback(ended(trial, outcome, plan), TASKS["unique"]))
    list(asked(after(study), person))
    return person.pages


def ended(trial, outcome, solution=None):
    """What a session knows of a practice trial that ended so."""
    return TrialRecord(
        trial, outcome, 14, 0.0, 30.0, 0.0, False, 1800, 0, 0.0, 0.0, 0.0, solution=solution
    )


def begun(task, aspect):
    """The first state of a published trial of the task."""
    study = load("published")
    trial = next(t.trials[0] for t in session_for(1, study.plan) if t.trials[0].task == task)
    return StudyScenes(study).begin(TASKS[task], trial, aspect)


def after_keys(task, state, *keys):
    """The state after keys pressed one after the other."""
    for number, key in enumerate(keys):
        state = TASKS[task].on_event(state, KeyPress(float(number), key))
    return state


def marked(state, *keys):
    """A confirmed mark, so many arrow keys from the plan's middle."""
    return after_keys("unique", state, "space", "up", *[k for k in keys for _ in range(9)], "enter")


KEYS = {  # what brings up each hint and each longest answer
    "count": [(), ("enter",), ("x",), tuple("20000")],
    "pattern": [(), ("enter",), ("k",), ("z",)],
    "unique": [(), ("space",), ("space", "enter"), ("space", "up", "left")],
    "count_in_building": [(), ("enter",), ("x",), tuple("20000")],
}


def views(aspect):
    """(name, view, whether a plan lies over the scene) of each task in each of its states, as
    a practice trial and as one that counts."""
    for task, states in KEYS.items():
        state = begun(task, aspect)
        for keys in states:
            later = after_keys(task, state, *keys)
            shown = [TASKS[task].view(later)]
            if task == "unique" and keys:
                click = PointerPress(9.0, 0.01, 0.5)  # beside the plan
                shown.append(TASKS[task].view(TASKS[task].on_event(later, click)))
            for view in shown:
                plan = any(isinstance(e, FloorPlan) for e in view.hud)
                for marks in ((), (practice_mark(aspect),)):
                    name = f"{task} {' '.join(keys)} {len(marks)}"
                    yield name, replace(view, hud=(*view.hud, *marks)), plan
