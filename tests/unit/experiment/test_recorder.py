"""What the recorder writes, read back; and what it refuses."""

import csv
import json
import shutil
from dataclasses import replace

import numpy as np
import pytest
from published_design import columns, published

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import check_participant, next_free, stem_of
from seethrough.experiment.record.columns import columns_in
from seethrough.experiment.record.record_files import cell
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.design.design import Trial
from seethrough.renderer.events import KeyPress, PointerMove, Tick
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Outcome, View

DESIGN = published()
LEVELS = {"transparency": "dynamic", "scenario": "abstract"}

TRIAL = Trial(5, 1, 2, 2, LEVELS, "count", "stream-1", (1, 1), world="abstract")
RECORD = TrialRecord(
    TRIAL, Outcome("12", "14", False, count_error=-2), 14, 10.0, 52.25, 2.25, False,
    2500, 3, 0.05, 12.5, 3.25,
)  # fmt: skip


def recorder(folder, participant="P01", source="human"):
    who = Who("test", participant, source, 1, {"seed": 3}, design=DESIGN)
    return FileRecorder(folder, who, now=lambda: "2026-01-02T03:04:05.678Z")


def play(rec, record=RECORD):
    view = View(Scene(()), look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3)))
    rec.trial_begins(record.trial)
    rec.frame(10.0, view)
    rec.event(PointerMove(11.0, 0.5, 0.25, 0.1, 0.0, True))
    rec.event(Tick(11.5))
    rec.frame(11.5, view)
    rec.event(KeyPress(52.25, "enter"))
    rec.trial_ends(record)


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_a_trial_is_a_row_on_disk_as_soon_as_it_ends(tmp_path):
    rec = recorder(tmp_path)
    play(rec)
    copy = tmp_path / "copy"
    shutil.copytree(tmp_path / "data", copy / "data")  # as a crash now would leave it
    rec.close("left")
    folder = copy / "data" / "human" / "P01"
    (row,) = rows(folder / "study-test_subject-P01_session-1_trials_data.csv")
    assert list(row) == [c.name for c in columns()["trials"]]
    expected = {
        "row_id": "human-P01-1-trial005", "participant": "P01", "source": "human",
        "trial": "5", "transparency": "dynamic", "task": "count", "answer": "12", "truth": "14",
        "correct": "false", "count_error": "-2", "distance": "", "time": "42.25",
        "time_clean": "40.0", "timed_out": "false", "frames": "2500", "frames_missed": "3",
        "started": "2026-01-02T03:04:05.678Z",
    }  # fmt: skip
    assert {k: row[k] for k in expected} == expected
    events = rows(folder / row["events_file"])
    assert [e["event"] for e in events] == ["PointerMove", "tick", "KeyPress"]
    assert events[0] | {"x": "0.5", "dragging": "true"} == events[0]
    camera = rows(folder / row["camera_file"])
    assert [c["eye_z"] for c in camera] == ["9.0", ""]  # a camera that stands is written once


def test_columns_are_the_declared_ones_and_unknown_ones_are_refused(tmp_path):
    rec = recorder(tmp_path)
    with pytest.raises(KeyError, match="columns not declared: \\['mood'\\]"):
        rec.answers([{"item": "ease", "value": "3", "mood": "good"}])
    rec.close("left")
    described = json.loads((tmp_path / "dataset_description.json").read_text(encoding="utf-8"))
    names = {v["name"] for v in described["variableMeasured"]}
    assert names == {c.name for table in columns().values() for c in table}


def test_nothing_is_overwritten_and_the_next_free_number_is_named(tmp_path):
    play(first := recorder(tmp_path))
    first.close("complete")
    before = {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
    with pytest.raises(InputError, match=r"participant P01 exists already; .* free one is P02"):
        recorder(tmp_path)
    assert {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()} == before
    assert next_free(tmp_path, "human") == "P02"
    assert next_free(tmp_path, "simulated") == "S01"


def test_sources_have_folders_of_their_own(tmp_path):
    for source in ("human", "simulated", "pilot"):
        recorder(tmp_path, source=source).close("left")
        assert (tmp_path / "data" / source / "P01").is_dir()


def test_the_sidecar_says_how_and_the_end_says_how_it_ended(tmp_path):
    rec = recorder(tmp_path)
    play(rec)
    rec.close("complete")
    folder, stem = tmp_path / "data" / "human" / "P01", "study-test_subject-P01_session-1"
    sidecar = json.loads((folder / f"{stem}_trials_data.json").read_text(encoding="utf-8"))
    assert sidecar["provenance"] == {"seed": 3}
    end = json.loads((folder / f"{stem}_end.json").read_text(encoding="utf-8"))
    assert (end["status"], end["trials"]) == ("complete", 1)


@pytest.mark.parametrize("participant", ["", "../x", "a b", "é", "a/b", "x" * 33, "a\n"])
def test_ids_that_could_be_paths_or_names_are_refused(participant):
    with pytest.raises(InputError, match=r"--participant = .*: expected 1 to 32 letters"):
        check_participant(participant)


def test_file_names_keep_the_key_value_form_for_any_id():
    assert stem_of("demo", "P_0-1") == "study-demo_subject-P01_session-1"
    assert stem_of("demo", "--") == "study-demo_subject-x_session-1"


def test_a_folder_that_can_not_be_written_is_one_line(tmp_path):
    (tmp_path / "data").write_text("a file where a folder should be")
    with pytest.raises(InputError, match=r"data/human/P01: cannot be written: Not a directory"):
        recorder(tmp_path)


def test_a_repeated_trial_is_another_attempt_with_traces_of_its_own(tmp_path):
    rec = recorder(tmp_path)
    play(rec)
    play(rec)
    rec.close("complete")
    folder = tmp_path / "data" / "human" / "P01"
    table = rows(folder / "study-test_subject-P01_session-1_trials_data.csv")
    assert [(r["trial"], r["attempt"]) for r in table] == [("5", "1"), ("5", "2")]
    assert len({r["row_id"] for r in table}) == 2
    assert len({r["events_file"] for r in table}) == 2
    assert all((folder / r["events_file"]).exists() for r in table)


def test_a_continued_session_has_files_of_its_own_and_counts_attempts_on(tmp_path):
    play(first := recorder(tmp_path))
    first.close("left")
    who = Who("test", "P01", "human", 1, {}, 2, DESIGN)
    second = FileRecorder(tmp_path, who, now=lambda: "later", attempts={5: 1})
    play(second)
    second.close("complete")
    folder = tmp_path / "data" / "human" / "P01"
    (row,) = rows(folder / "study-test_subject-P01_session-2_trials_data.csv")
    assert (row["session"], row["attempt"]) == ("2", "2")


def test_answers_and_notes_are_on_disk_at_once(tmp_path):
    rec = recorder(tmp_path)
    rec.answers([{"item": "age", "value": "30"}])
    rec.note(TRIAL, 'a "phone", rang\nloudly')
    rec.answers([{"item": "ease", "value": "3", "transparency": "dynamic"}])
    folder = tmp_path / "data" / "human" / "P01"
    asked = rows(folder / "study-test_subject-P01_session-1_questionnaire_data.csv")
    (note,) = rows(folder / "study-test_subject-P01_session-1_notes_data.csv")
    rec.close("complete")
    assert [(r["item"], r["value"]) for r in asked] == [("age", "30"), ("ease", "3")]
    assert (note["trial"], note["text"]) == ("5", 'a "phone", rang\nloudly')


def test_numbers_of_numpy_are_written_as_numbers():
    values = (np.float64(0.1), np.float32(0.5), np.int64(3), np.bool_(True), 0.1, True, None)
    assert [cell(v) for v in values] == ["0.1", "0.5", "3", "true", "0.1", "true", ""]


def test_what_a_task_measures_besides_has_a_column(tmp_path):
    """As the sidecar's design declares it, read back by the file's header alone."""
    misses = {"name": "misses", "unit": "clicks", "label": "clicks on other things"}
    task = {"name": "select", "code": "S", "measures": [{**misses}, {**misses, "name": "correct"}]}
    who = Who("test", "P01", "human", 1, {"seed": 3}, design={**DESIGN, "tasks": [task]})
    rec = FileRecorder(tmp_path, who, now=lambda: "2026-01-02T03:04:05.678Z")
    outcome = Outcome("3", "3", True, more={"misses": 2})
    play(rec, replace(RECORD, outcome=outcome))
    rec.close("left")
    (table,) = (tmp_path / "data" / "human" / "P01").glob("*_trials_data.csv")
    (row,) = rows(table)
    names = list(row)
    assert row["misses"] == "2" and row["correct"] == "true" and names[-1] == "chain"
    assert names[names.index("distance") + 1] == "misses" and names.count("correct") == 1
    assert [c.name for c in columns_in("trials", names)] == names
    (column,) = [c for c in columns_in("trials", names) if c.name == "misses"]
    assert column.type == "number"
