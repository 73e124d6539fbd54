"""Where an interrupted session goes on."""

from dataclasses import replace

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.session.questionnaire import Said
from seethrough.experiment.session.resume import already_done, going_on, past, starting_point
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.shown.described import design_entry
from seethrough.tasks.kit.base import Outcome

STUDY = load("published")
SLOT = 3
DESIGN = design_entry(STUDY)
TRIALS = [t for s in session_for(SLOT, STUDY.plan) for t in s.trials]


def played(data, count, status="left", study=STUDY, session=1):
    """A folder in which the first `count` trials were completed."""
    provenance = {"study_sha256": study.digest()}
    who = Who("published", "P01", "human", SLOT, provenance, session, DESIGN)
    recorder = FileRecorder(data, who)
    for trial in TRIALS[:count]:
        recorder.trial_begins(trial)
        outcome = Outcome("1", "1", True)
        recorder.trial_ends(
            TrialRecord(trial, outcome, 1, 0.0, 1.0, 0.0, False, 1, 0, 0.0, 0.0, 0.0)
        )
    recorder.close(status)


def test_somebody_new_starts_at_the_beginning(tmp_path):
    start = starting_point(STUDY, tmp_path, "human", "P01", 5)
    assert (start.session, start.slot, start.done) == (1, 5, frozenset())


@pytest.mark.parametrize(("count", "whole"), [(0, 0), (5, 0), (6, 6), (11, 6), (12, 12), (23, 18)])
def test_an_interrupted_session_goes_on_at_the_start_of_its_block(tmp_path, count, whole):
    played(tmp_path, count)
    start = starting_point(STUDY, tmp_path, "human", "P01", 9)
    assert (start.session, start.slot) == (2, SLOT)  # its own slot, not the one offered
    assert start.done == frozenset(range(1, whole + 1))
    assert start.attempts == dict.fromkeys(range(1, count + 1), 1)


@pytest.mark.parametrize(
    ("count", "said"),
    [
        (6, "session 2 goes on at trial 7, part 3 of 8"),
        (8, "goes on at trial 7, part 3 of 8; 2 trials of a broken block are played again"),
        (24, "session 2 goes on at the questionnaire"),
    ],
)
def test_the_experimenter_is_told_where_it_goes_on(tmp_path, count, said):
    played(tmp_path, count)
    assert going_on(STUDY, starting_point(STUDY, tmp_path, "human", "P01", 9)).endswith(said)


def test_by_config_it_goes_on_at_the_trial(tmp_path):
    played(tmp_path, 8)
    before = past(tmp_path, "human", "P01")
    task_sets = session_for(SLOT, STUDY.plan)
    assert already_done(task_sets, before, "trial") == frozenset(range(1, 9))


def test_a_row_cut_short_by_a_crash_does_not_count(tmp_path):
    played(tmp_path, 7)
    (table,) = tmp_path.rglob("*_trials_data.csv")
    table.write_text(table.read_text()[:-9])
    assert set(past(tmp_path, "human", "P01").attempts) == set(range(1, 7))


def test_answers_of_all_sessions_so_far_are_known(tmp_path):
    for session, answers in enumerate((("ease", "3", "one\ntwo"), ("enjoy", "4", "")), start=1):
        who = Who(
            "published", "P01", "human", SLOT, {"study_sha256": STUDY.digest()}, session, DESIGN
        )
        recorder = FileRecorder(tmp_path, who)
        row = dict(zip(("item", "value", "text"), answers, strict=True))
        recorder.answers([{**row, "transparency": "dynamic", "scenario": "abstract"}])
        recorder.answers([{"item": "remarks", "value": "", "text": "cut\nshort\nby a crash"}])
        (table,) = tmp_path.rglob(f"*session-{session}_questionnaire_data.csv")
        table.write_bytes(table.read_bytes()[:-9])
    given = starting_point(STUDY, tmp_path, "human", "P01", 9).given
    here = (("scenario", "abstract"), ("transparency", "dynamic"))
    assert given == {("ease", here): Said("3", "one\ntwo"), ("enjoy", here): Said("4")}


def test_a_table_of_answers_without_its_columns_is_named(tmp_path):
    played(tmp_path, 2)
    table = tmp_path / "data/human/P01/study-published_subject-P01_session-1_questionnaire_data.csv"
    table.write_text("scenario,value\n")
    with pytest.raises(InputError, match="expected a column item, found scenario"):
        past(tmp_path, "human", "P01")


def test_a_complete_participant_is_refused_with_the_next_free_number(tmp_path):
    played(tmp_path, 24, "complete")
    with pytest.raises(InputError, match=r"P01 exists already; the next free one is P02"):
        starting_point(STUDY, tmp_path, "human", "P01", 1)


def test_another_version_of_the_study_is_refused(tmp_path):
    played(tmp_path, 4)
    changed = replace(STUDY, practice=STUDY.practice.model_copy(update={"trials": 2}))
    with pytest.raises(InputError, match=r"P01 began another version of this study"):
        starting_point(changed, tmp_path, "human", "P01", 1)


def test_a_second_interruption_is_the_third_session(tmp_path):
    played(tmp_path, 7)
    played(tmp_path, 9, session=2)
    start = starting_point(STUDY, tmp_path, "human", "P01", 1)
    assert start.session == 3
    assert start.attempts[1] == 2 and start.attempts[9] == 1


def test_a_folder_in_which_nothing_was_recorded_yet_is_no_past(tmp_path):
    (tmp_path / "data" / "human" / "P01" / "traces").mkdir(parents=True)
    assert past(tmp_path, "human", "P01") is None
    assert starting_point(STUDY, tmp_path, "human", "P01", 2).session == 1


def test_tables_without_their_sidecar_are_named(tmp_path):
    played(tmp_path, 2)
    for sidecar in tmp_path.rglob("*_trials_data.json"):
        sidecar.unlink()
    with pytest.raises(InputError, match=r"P01: expected a file …_trials_data\.json, found none"):
        past(tmp_path, "human", "P01")
