"""Questions between trials: when they are asked, about what, and on which earlier answers."""

from collections import Counter

import pytest
from scripted_session import ANSWERS, MemoryRecorder, ScriptedInput, study
from scripted_session import FakeDisplay as Display

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.display import Leave
from seethrough.experiment.pages.pages import Scale
from seethrough.experiment.session.questionnaire import item_of, said_in
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.experiment.study.config import parse
from seethrough.experiment.study.design.design import session_for
from seethrough.tasks.catalog import TASKS

LIKERT = {"use": "likert", "text": "Hard?", "points": 7}


class Person(ScriptedInput):
    """Fills in scales by what `say` has for an item; leaves at the page `leaves`, once."""

    leaves, met = "", 0

    def ask(self, page):
        answers = super().ask(page)
        if self.leaves and any(getattr(b, "name", "") == self.leaves for b in page.blocks):
            self.met += 1
            if self.met == 3:
                raise Leave
        for block in page.asked:
            said = getattr(self, "say", {}).get(block.name, "0")
            answers[block.name] = said.pop(0) if isinstance(said, list) else said
        return answers


def play(config, done=frozenset(), given=None, **about):
    clock = SimulatedClock(100.0)
    person, recorder = Person(clock, ANSWERS), MemoryRecorder()
    for name, value in about.items():
        setattr(person, name, value)
    world = Surroundings(Display(clock), person, clock, recorder, TASKS)
    status = run_session(config, 1, world, done, given)
    return status, recorder, person


def questions(**tables):
    return study(design={"trials": 2, "tasks": ["count"]}, questions=tables, practice={"trials": 0})


def test_each_trial_task_set_and_condition_is_asked_about():
    asked = study(
        practice={"trials": 0},
        questions={"hard": {**LIKERT, "when": "trial"}, "odd": {**LIKERT, "when": "task_set"},
                   "tired": {**LIKERT, "when": "condition"}},
    )  # fmt: skip
    _, recorder, _ = play(asked)
    sets = session_for(1, asked.plan)
    rows = {i: [r for r in recorder.rows if r["item"] == i] for i in ("hard", "odd", "tired")}
    trials = [t for s in sets for t in s.trials]
    assert [
        (r["transparency"], r["after_trial"], r["after_task"]) for r in rows["hard"]
    ] == [(t.levels["transparency"], str(t.number), t.task) for t in trials]  # fmt: skip
    assert [(r["after_trial"], r["after_task"]) for r in rows["odd"]] == [
        (str(s.trials[-1].number), s.trials[-1].task) for s in sets
    ]
    assert [r["transparency"] for r in rows["tired"]] == [
        sets[0].trials[0].levels["transparency"], sets[-1].trials[0].levels["transparency"]
    ]  # fmt: skip
    assert all("after_trial" not in r for r in rows["tired"])


def test_once_for_each_level_is_the_last_time_that_it_is_met():
    """Of a factor that is mixed within blocks; and once at all."""
    asked = study(
        factors={"transparency": {"levels": {
            "standard": {"technique": {"use": "standard"}},
            "dynamic": {"technique": {"use": "dynamic"}}}},
            "clutter": {"set": "world.abstract.objects", "values": [90, 100], "order": "mixed"}},
        design={"trials": 2, "tasks": ["count"]}, practice={"trials": 0},
        questions={"hard": {**LIKERT, "when": "trial", "each": ["clutter"]},
                   "once": {**LIKERT, "when": "condition", "each": []}},
    )  # fmt: skip
    _, recorder, _ = play(asked)
    trials = [t for s in session_for(1, asked.plan) for t in s.trials]
    last = {t.levels["clutter"]: str(t.number) for t in trials}
    assert {r["clutter"]: r["after_trial"] for r in recorder.rows if "clutter" in r} == last
    assert Counter(r["item"] for r in recorder.rows) == {"hard": 2, "once": 1}


def test_once_for_each_cell_is_the_last_time_that_it_is_met():
    asked = questions(hard={**LIKERT, "when": "trial", "each": ["transparency"]})
    _, recorder, _ = play(asked)
    trials = [t for s in session_for(1, asked.plan) for t in s.trials]
    last = {t.levels["transparency"]: str(t.number) for t in trials}
    assert len(trials) > len(last) > 1
    rows = [r for r in recorder.rows if r["item"] == "hard"]
    assert len(rows) == len(last)
    assert {r["transparency"]: r["after_trial"] for r in rows} == last


@pytest.mark.parametrize(
    ("given", "asked"),
    [({"hard": 2}, [2]), ({"hard": [1, 7]}, [1, 4]), ({"hard": {"least": 3}}, [3, 4]),
     ({"hard": {"least": 2, "most": 3}}, [2, 3]), ({"hard": {"most": 7}}, [1, 2, 3, 4])],
)  # fmt: skip
def test_a_question_follows_on_the_answer_about_the_same_trial(given, asked):
    config = questions(
        hard={**LIKERT, "when": "trial"},
        why={**LIKERT, "when": "trial", "given": given},
    )
    _, recorder, _ = play(config, say={"hard": ["0", "1", "2", "6"]})
    assert [int(r["after_trial"]) for r in recorder.rows if r["item"] == "why"] == asked


def test_a_later_question_asks_about_the_same_level_and_texts_count():
    """At the end, for each level: the choice that was made after that level's condition."""
    config = questions(
        tool={"use": "choice", "when": "condition", "text": "?", "options": ["mouse", "keys"]},
        why={**LIKERT, "when": "end", "each": ["transparency"], "given": {"tool": "keys"}},
    )
    _, recorder, _ = play(config, say={"tool": ["0", "1"]})
    (second,) = [r for r in recorder.rows if r["text" if "text" in r else "item"] == "keys"]
    assert [r["transparency"] for r in recorder.rows if r["item"] == "why"] == [
        second["transparency"]
    ]


def test_neighbours_come_in_another_order_for_each_participant_and_the_same_again():
    shuffled = {**LIKERT, "when": "end", "order": "shuffled"}
    names = ["a", "b", "c", "d"]
    config = questions(first={**LIKERT, "when": "end"}, **dict.fromkeys(names, shuffled))
    orders = []
    for slot in (1, 1, 2, 3, 4):
        clock = SimulatedClock(0.0)
        recorder = MemoryRecorder()
        person = Person(clock, ANSWERS)
        run_session(config, slot, Surroundings(Display(clock), person, clock, recorder, TASKS))
        orders.append([r["item"] for r in recorder.rows])
    assert all(o[0] == "first" and sorted(o[1:]) == names for o in orders)
    assert orders[0] == orders[1] and len({tuple(o) for o in orders}) > 2


def test_who_left_before_what_belongs_to_a_trial_is_asked_it_first_when_they_go_on():
    """The third trial is on disk, its question was left: it is asked, and nothing twice."""
    config = questions(hard={**LIKERT, "when": "trial"}, end={**LIKERT, "when": "condition"})
    status, before, _ = play(config, leaves="hard")
    assert status == "left" and [r.trial.number for r in before.ended] == [1, 2, 3]
    given = {item_of(row): said_in(row) for row in before.rows}
    _, after, _ = play(config, frozenset({1, 2, 3}), given)
    assert [r["after_trial"] for r in after.rows if r["item"] == "hard"] == ["3", "4"]
    assert [r.trial.number for r in after.ended] == [4]
    # A block that is played again is asked about again: its first answers were about others.
    _, again, _ = play(config, frozenset({1, 2}), given)
    assert [r["after_trial"] for r in again.rows if r["item"] == "hard"] == ["3", "4"]
    _, all_of_it, _ = play(config, frozenset(), given)
    assert [r["after_trial"] for r in all_of_it.rows if r["item"] == "hard"] == list("1234")


def test_a_condition_that_was_whole_is_asked_about_when_they_go_on():
    config = questions(end={**LIKERT, "when": "condition"})
    first = session_for(1, config.plan)[0]
    _, recorder, _ = play(config, frozenset(t.number for t in first.trials))
    assert recorder.rows[0]["transparency"] == first.trials[0].levels["transparency"]
    assert len(recorder.rows) == 2


def test_confidence_is_a_measure_of_the_trial_and_leaving_its_page_keeps_the_trial():
    config = study(design={"trials": 2, "tasks": ["count"]}, task={"confidence": True})
    _, recorder, person = play(config, say={"confidence": ["0", "4", "2", "1"]})
    assert [r.outcome.more["confidence"] for r in recorder.ended] == [1, 5, 3, 2]
    (page,) = {p.title for p in person.pages if p.name == "confidence"}
    assert page == "confidence.title"
    (scale,) = [b for b in person.pages[-2].blocks if isinstance(b, Scale)]
    assert (scale.first, scale.steps) == (1, 5)
    status, left, _ = play(config, leaves="confidence")
    assert status == "left" and [r.trial.number for r in left.ended] == [1, 2, 3]
    assert "confidence" not in left.ended[-1].outcome.more


def test_who_does_not_know_says_so_and_nothing_is_measured(monkeypatch):
    monkeypatch.setitem(ANSWERS, "count", ["1", "f2"])
    config = study(design={"trials": 1, "tasks": ["count", "pattern"]},
                   task={"count": {"unsure": True}})  # fmt: skip
    _, recorder, person = play(config)
    found = {r.trial.task: r.outcome for r in recorder.ended}
    assert (found["count"].answer, found["count"].truth, found["count"].correct) == (
        "unknown", "", False,
    )  # fmt: skip
    assert found["count"].count_error is None and found["pattern"].answer == "K"
    said = [b.text for p in person.pages if p.name == "feedback" for b in p.blocks]
    assert "feedback.unsure" in said


def test_a_study_that_asks_for_no_option_is_the_study_that_it_was():
    """Its digest, so that who began it before may go on; with an option it is another one."""
    plain = study()
    assert study(task={"confidence": False}).digest() == plain.digest()
    asked = study(task={"count": {"confidence": True}})
    assert asked.digest() != plain.digest()
    again = parse(asked.resolved(), "again")
    assert again.digest() == asked.digest()
    levels = {"transparency": "dynamic"}
    assert again.part(levels).task_options.of("count").confidence
    assert not again.part(levels).task_options.of("pattern").confidence


CHOICE = {"use": "choice", "when": "end", "text": "?", "options": ["a", "b"]}
WRONG = [
    (
        {"b": {**LIKERT, "given": {"nothing": 1}}},
        "questions.b.given.nothing = 1: expected an item of a question before b",
    ),
    ({"b": {**LIKERT, "given": {"b": 1}}}, "expected an item of a question before b: b is asked"),
    ({"b": {**LIKERT, "given": {"c": 1}}, "c": LIKERT}, "is asked by c, which comes later"),
    ({"b": {**LIKERT, "given": {"c": 1}}, "c": {**LIKERT, "given": {"b": 1}}}, "which comes later"),
    (
        {"c": {**LIKERT, "when": "end"}, "b": {**LIKERT, "when": "trial", "given": {"c": 1}}},
        "which comes later",
    ),
    (
        {
            "c": {**LIKERT, "order": "shuffled"},
            "b": {**LIKERT, "order": "shuffled", "given": {"c": 1}},
        },
        "expected no question that is shuffled with c",
    ),
    ({"b": {**CHOICE, "given": {"c": {"lest": 1}}}}, "questions.b.given = "),
    ({"b": {**CHOICE, "given": {"c": []}}}, "questions.b.given = "),
    ({"b": {**CHOICE, "given": 3}}, "questions.b.given = 3"),
    ({"b": {**CHOICE, "order": "random"}}, 'questions.b.order = "random"'),
    ({"b": {**CHOICE, "when": "often"}}, 'questions.b.when = "often"'),
    ({"b": {**LIKERT, "per_page": -1}}, "questions.b.per_page = -1"),
    ({"b": {"use": "tlx", "weighted": 1}}, "questions.b.weighted = 1"),
]


@pytest.mark.parametrize(("tables", "message"), WRONG)
def test_a_question_that_cannot_be_asked_is_refused_in_a_line(tables, message):
    with pytest.raises(Exception) as error:
        study(questions=tables)
    (line,) = error.value.lines
    assert message in line
