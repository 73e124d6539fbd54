"""Every page and every task's HUD of the published study, for tests that lay all of them out."""

from types import SimpleNamespace

from experiment import blocks
from experiment.config import load
from experiment.design import session_for
from experiment.questionnaire import after, asked, before
from experiment.session import _feedback, _instruction, _page
from experiment.trial import LEAVE, MENU, TrialRun
from experiment.world import TrialRecord
from tasks.base import Outcome
from tasks.catalog import TASKS


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
    for task_set in session_for(1, study.design.factors()):
        person.pages.append(_instruction(task_set.trials[0], 8, run))
    names = ("welcome", "ready", "pause", "time", "thanks")
    person.pages += [*map(_page, names), LEAVE, MENU]
    person.pages += [blocks.tlx("dynamic"), blocks.sus("standard")]
    trial = session_for(1, study.design.factors())[0].training[0]
    for outcome in (None, Outcome("12", "14", False, count_error=-2), Outcome("K", "K", True)):
        record = TrialRecord(trial, outcome, 14, 0.0, 30.0, 0.0, False, 1800, 0, 0.0, 0.0, 0.0)
        person.pages.append(_feedback(record))
    list(asked(after(study), person))
    return person.pages
