"""What simulated people answer on pages, from the times that their trials took."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scripted_session import study

from seethrough.experiment.people.forms import Opinions
from seethrough.experiment.session import questionnaire
from seethrough.tasks.kit.skills.profile import AVERAGE

OPTIONS = ("plain", "neither", "cut")


def forms(**times: list[float]) -> Opinions:
    made = Opinions(SimpleNamespace(rng=np.random.default_rng(1)))
    for level, spent in times.items():
        made._levels = (("view", level),)
        for seconds in spent:
            made.begin("find")
            made.spent("find", seconds)
    return made


@pytest.mark.parametrize(
    "times",
    [
        {"plain": [0.0, 0.0], "cut": [0.0]},  # a task that answers at once, as one begins
        {"plain": [0.0], "cut": [3.0]},
        {"plain": [3.0], "cut": [0.0]},
        {"plain": [3.0]},
        {},
    ],
)
def test_where_a_level_took_no_time_nothing_is_preferred(times):
    assert OPTIONS[forms(**times)._preference(OPTIONS)] == "neither"


def test_who_was_much_faster_with_a_level_prefers_it():
    """Five doublings of time: a chance of 1 / (1 + e^-15) to prefer the quick one."""
    assert OPTIONS[forms(plain=[64.0], cut=[2.0])._preference(OPTIONS)] == "cut"
    assert OPTIONS[forms(plain=[2.0], cut=[64.0])._preference(OPTIONS)] == "plain"


class Fills:
    """Someone simulated before the pages of a session."""

    def __init__(self, seed):
        self.opinions = Opinions(SimpleNamespace(rng=np.random.default_rng(seed), profile=AVERAGE))

    def ask(self, page):
        return self.opinions.answer(page)[0]


def answers(asked, seed=1):
    steps = questionnaire.after(study(questions=asked))
    rows = [row for page in questionnaire.asked(steps, Fills(seed)) for row in page]
    return {row["item"]: row.get("text") or row["value"] for row in rows}


HARD = {"use": "likert", "text": "Hard?", "when": "end", "points": 9}
WHY = {"use": "text", "text": "Why?", "when": "end"}
OFTEN = {"use": "choice", "text": "Often?", "options": ["once", "twice"], "required": False}
SIZE = {"use": "number", "text": "How many?", "low": 3, "high": 5, "required": False}


def test_who_is_asked_because_of_an_earlier_answer_says_something():
    """Free text and whatever else may stay open: else a dry run never fills those columns in. What
    everybody is asked stays open."""
    met = {"when": "end", "given": {"hard": {"most": 9}}}
    said = answers({
        "hard": HARD, "open": WHY, "often_open": OFTEN, "size_open": SIZE, "why": {**WHY, **met},
        "often": {**OFTEN, **met}, "size": {**SIZE, **met}, "remarks": met,
    })  # fmt: skip
    assert [*said] == ["hard", "why", "often", "size", "remarks"]
    assert said["why"] == said["remarks"] == "simulated"
    assert said["often"] in ("once", "twice") and 3 <= int(said["size"]) <= 5


def test_whom_it_does_not_concern_is_not_asked():
    asked = {"hard": HARD, "why": {**WHY, "given": {"hard": {"least": 6}}}}
    met = [answers(asked, seed) for seed in range(12)]
    assert {int(said["hard"]) >= 6 for said in met} == {True, False}
    assert all(("why" in said) == (int(said["hard"]) >= 6) for said in met)


def test_what_has_to_be_answered_is():
    asked = {"why": {**WHY, "required": True}, "size": {**SIZE, "required": True, "whole": False}}
    said = answers(asked)
    assert said["why"] == "simulated" and 3 <= float(said["size"]) <= 5 and "." in said["size"]
