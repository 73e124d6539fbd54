"""The session's state machine, through its Protocols only: no window, no GPU, no files."""

from collections import Counter

import pytest
from scripted_session import ANSWERS, FRAME, FakeDisplay, MemoryRecorder, ScriptedInput, play, study

from seethrough.experiment.display.clock import SimulatedClock
from seethrough.experiment.display.display import DisplayLost, Leave
from seethrough.experiment.session.session import run_session
from seethrough.experiment.session.surroundings import Surroundings
from seethrough.renderer.events import FocusChange, KeyPress, PointerPress, Tick
from seethrough.tasks.catalog import TASKS


def test_every_task_set_has_its_instruction_training_and_trials_in_that_order():
    status, recorder, person, _ = play(study())
    assert status == recorder.status == "complete"
    assert [r.trial.number for r in recorder.ended] == list(range(1, 9))
    assert Counter((r.trial.levels["transparency"], r.trial.task) for r in recorder.ended) == {
        (t, k): 2 for t in ("standard", "dynamic") for k in ("count", "pattern")
    }
    # One training trial before each of the four task sets; it is shown but leaves no row.
    assert [t.training for t in recorder.begun] == [True, False, False] * 4
    names = [p.name for p in person.pages]
    block = ["instruction", "feedback", "ready"] * 2
    assert names == ["welcome", *block, "pause", *block, "thanks"]


def test_time_runs_from_the_first_frame_to_the_confirmation():
    _, recorder, _, _ = play(study(), thinking=9)
    # The first frame is shown at once; nine frames of thinking, then the answer in the tenth.
    assert {r.time for r in recorder.ended} == {10 * FRAME}
    assert all(r.frames == 10 and r.timed_out is False for r in recorder.ended)
    # 0.25 s a frame is over 1.5 × 1/60 s: every one of the nine intervals is a missed frame.
    assert all(r.frames_missed == 9 and r.worst_frame == FRAME for r in recorder.ended)


def test_missed_frames_are_counted_by_the_measured_period_where_there_is_one():
    _, recorder, _, _ = play(study(), thinking=9, period=FRAME / 1.4)
    assert all(r.frames_missed == 0 for r in recorder.ended)
    _, recorder, _, _ = play(study(), thinking=9, period=FRAME / 1.6)
    assert all(r.frames_missed == 9 for r in recorder.ended)


def test_answers_are_scored_by_the_task():
    _, recorder, _, _ = play(study())
    for record in recorder.ended:
        if record.trial.task == "count":
            assert record.outcome.count_error == 20 - record.targets
        else:
            assert record.outcome.answer == "K"
            assert record.outcome.truth in "CKRXY"


def test_the_transparency_level_decides_the_technique():
    config = study()
    _, _, _, display = play(config)
    kinds = {type(technique).__name__ for _, technique in display.shown}
    assert kinds == {"Standard", "DynamicTransparency"}
    assert {t for _, t in display.shown} == {part.technique for part in config.parts.values()}


def test_the_trial_limit_ends_a_trial_without_an_answer():
    config = study(task={"limit": 1.0})
    _, recorder, _, _ = play(config, thinking=100)
    assert len(recorder.ended) == 8
    assert all(r.timed_out and r.outcome is None and r.time == 1.0 for r in recorder.ended)


def test_training_ends_at_its_limit():
    config = study(practice={"limit": 1.0})
    _, _, person, _ = play(config, thinking=40)
    feedback = [p for p in person.pages if p.name == "feedback"]
    assert len(feedback) == 4
    assert all(p.blocks[0].text == "feedback.time" for p in feedback)


def test_the_session_limit_ends_the_session_after_the_task_set():
    config = study(session={"limit": 5.0})
    status, recorder, person, _ = play(config)
    assert status == recorder.status == "time limit"
    assert person.pages[-1].name == "time"
    assert len(recorder.ended) == 2


def test_leaving_keeps_what_was_completed():
    # Trials 1 (training), 2 and 3 are played; in the fourth, a training, Esc is confirmed.
    status, recorder, person, _ = play(study(), leave_at=4)
    assert status == recorder.status == "left"
    assert [r.trial.number for r in recorder.ended] == [1, 2]
    assert person.pages[-1].name == "leave"


def test_going_on_after_escape_subtracts_the_question_from_the_clean_time():
    class GoesOn(ScriptedInput):
        def ask(self, page):
            answers = super().ask(page)
            if page.name == "leave":
                self.leave_at = -1
            return {**answers, "button": "0"}

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    person = GoesOn(clock, ANSWERS, leave_at=2)
    run_session(study(), 1, Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS))
    first = recorder.ended[0]
    assert first.away == 2.0
    assert first.time - first.away == 4 * FRAME


def test_what_came_with_a_question_is_not_taken_after_it():
    """The keys of the same moment were meant for the question, or for nothing."""

    class Interrupted(ScriptedInput):
        def events(self, view):
            events = super().events(view)
            now = events[0].time
            if self.frames == 2:
                return [KeyPress(now, "escape"), KeyPress(now, "7"), KeyPress(now, "enter")]
            return events

        def ask(self, page):
            return {**super().ask(page), "button": "0"}

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    world = Surroundings(FakeDisplay(clock), Interrupted(clock, ANSWERS), clock, recorder, TASKS)
    run_session(study(), 1, world)
    assert {r.outcome.answer for r in recorder.ended if r.trial.task == "count"} == {"20"}


def test_trials_done_before_are_not_played_again():
    status, recorder, _, _ = play(study(), done=frozenset({1, 2, 3, 4, 5}))
    assert status == "complete"
    assert [r.trial.number for r in recorder.ended] == [6, 7, 8]


def test_an_error_in_a_task_still_closes_the_record():
    class Broken(ScriptedInput):
        def events(self, view):
            raise RuntimeError("lost")

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    world = Surroundings(FakeDisplay(clock), Broken(clock, ANSWERS), clock, recorder, TASKS)
    with pytest.raises(RuntimeError, match="lost"):
        run_session(study(), 1, world)
    assert recorder.status == "left"
    assert Leave is not RuntimeError


def test_a_lost_display_ends_the_session_and_is_told_to_the_caller_and_the_record():
    class Fails(FakeDisplay):
        def show(self, view, technique):
            if len(self.shown) == 10:  # in the third trial
                raise DisplayLost("GL_CONTEXT_LOST")
            return super().show(view, technique)

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    config = study(practice={"trials": 0})
    world = Surroundings(Fails(clock), ScriptedInput(clock, ANSWERS), clock, recorder, TASKS)
    with pytest.raises(DisplayLost, match=r"^display: .*\(GL_CONTEXT_LOST\); every completed tr"):
        run_session(config, 1, world)
    assert recorder.status == "display lost"
    assert [r.trial.number for r in recorder.ended] == [1, 2]


def test_the_same_slot_gives_the_same_scenes_and_another_slot_others():
    def centers(slot):
        return [v.scene.centers.tobytes() for v, _ in play(study(), slot)[3].shown[:40:13]]

    assert centers(1) == centers(1)
    assert centers(1) != centers(2)


def test_pointer_presses_answer_the_letter_too():
    class Clicks(ScriptedInput):
        def events(self, view):
            events = super().events(view)
            if self.task == "pattern" and self.frames > self.thinking:
                button = next(e for e in view.hud if getattr(e, "text", "") == "X")
                x, y = button.rect.x + 0.01, button.rect.y + 0.01
                return [PointerPress(events[-1].time, x, y), *events[1:]]
            return events

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    person = Clicks(clock, ANSWERS)
    run_session(study(), 1, Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS))
    patterns = [r for r in recorder.ended if r.trial.task == "pattern"]
    assert {r.outcome.answer for r in patterns} == {"X"}


def test_f1_takes_a_note_and_repeats_the_trial_as_another_attempt():
    class Menu(ScriptedInput):
        def events(self, view):
            if self.trials == 2 and not any(p.name == "menu" for p in self.pages):
                return [KeyPress(self.clock.now(), "f1"), Tick(self.clock.now())]
            return super().events(view)

        def ask(self, page):
            answers = super().ask(page)
            return {"button": "1", "note": "phone rang"} if page.name == "menu" else answers

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    run_session(
        study(), 1, Surroundings(FakeDisplay(clock), Menu(clock, ANSWERS), clock, recorder, TASKS)
    )
    assert [r.trial.number for r in recorder.ended[:3]] == [1, 1, 2]
    assert recorder.ended[0].repeat and recorder.ended[0].outcome is None
    assert recorder.ended[1].outcome is not None
    assert [text for _, text in recorder.notes] == ["phone rang"]


def test_time_without_focus_is_subtracted_from_the_clean_time():
    class Looks(ScriptedInput):
        def events(self, view):
            events = super().events(view)
            if self.frames == 1:
                return [FocusChange(events[0].time, False), *events]
            if self.frames == 3:
                return [FocusChange(events[0].time, True), *events]
            return events

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    person = Looks(clock, ANSWERS)
    run_session(study(), 1, Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS))
    assert {(r.time, r.away) for r in recorder.ended} == {(4 * FRAME, 2 * FRAME)}


def test_refusing_consent_ends_the_session_before_any_trial():
    class Refuses(ScriptedInput):
        def ask(self, page):
            super().ask(page)
            return {"button": "1" if page.name == "consent" else "0"}

    clock = SimulatedClock(0.0)
    recorder = MemoryRecorder()
    config = study(texts={"consent.text": "Please."}, questions={"consent": {}})
    world = Surroundings(FakeDisplay(clock), Refuses(clock, ANSWERS), clock, recorder, TASKS)
    assert run_session(config, 1, world) == "left"
    assert recorder.begun == [] and recorder.rows == []


def test_keys_from_before_the_first_frame_answer_nothing():
    class Hasty(ScriptedInput):
        def events(self, view):
            events = super().events(view)
            if self.frames == 1:
                early = events[0].time - FRAME - 0.01
                return [KeyPress(early, "7"), KeyPress(early, "enter"), *events]
            return events

    clock = SimulatedClock(50.0)
    recorder = MemoryRecorder()
    person = Hasty(clock, ANSWERS)
    run_session(study(), 1, Surroundings(FakeDisplay(clock), person, clock, recorder, TASKS))
    assert all(r.time == 4 * FRAME for r in recorder.ended)
    assert {r.outcome.answer for r in recorder.ended if r.trial.task == "count"} == {"20"}


def test_escape_from_before_the_first_frame_asks_at_it():
    asked = []

    class Leaves(ScriptedInput):
        def events(self, view):
            events = super().events(view)
            return [KeyPress(events[0].time - FRAME - 0.01, "escape"), *events]

        def ask(self, page):
            asked.append(page.name)
            return {"button": "1" if page.name == "leave" else "0"}

    clock = SimulatedClock(50.0)
    recorder = MemoryRecorder()
    world = Surroundings(FakeDisplay(clock), Leaves(clock, ANSWERS), clock, recorder, TASKS)
    assert run_session(study(), 1, world) == "left"
    assert asked.count("leave") == 1 and recorder.ended == []
