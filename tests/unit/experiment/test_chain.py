"""The hash chain: what a session writes verifies, and any changed byte is found and named."""

import hashlib
import json
import shutil

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from published_design import published

from seethrough.experiment.record.chain import verify
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.experiment.study.design.design import Trial
from seethrough.renderer.events import KeyPress, Tick
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.tasks.kit.base import Outcome, View

DESIGN = published()
LEVELS = {"transparency": "dynamic", "scenario": "abstract"}

VIEW = View(Scene(()), look_at(np.array([0.0, 0.0, 9.0]), np.zeros(3)))
STEM = "study-test_subject-P01_session-1"


def play(recorder, number):
    trial = Trial(number, 1, 1, number, LEVELS, "count", "stream-1", (1, 1), world="abstract")
    recorder.trial_begins(trial)
    recorder.frame(10.0, VIEW)
    recorder.event(Tick(10.5))
    recorder.event(KeyPress(11.0, "enter"))
    outcome = Outcome("12", "14", False, count_error=-2)
    record = TrialRecord(trial, outcome, 14, 10.0, 11.0, 0.0, False, 60, 0, 0.02, 1.5, 0.25)
    recorder.trial_ends(record)


def session(data, number=1, trials=3, status="complete", answers=True):
    who = Who("test", "P01", "human", 1, {"seed": 3}, number, DESIGN)
    recorder = FileRecorder(data, who, now=lambda: "2026-01-02T03:04:05.678Z")
    for trial in range(1, trials + 1):
        play(recorder, trial)
    if answers:
        recorder.answers([{"item": "remarks", "text": 'a "quote",\na line'}])
    if status:
        recorder.close(status)
    return recorder.folder


def test_the_chain_is_what_conventions_say(tmp_path):
    folder = session(tmp_path)
    assert verify(folder) == []
    header, *rows = (folder / f"{STEM}_trials_data.csv").read_text("utf-8").splitlines()
    assert header.endswith(",chain")
    sidecar = json.loads((folder / f"{STEM}_trials_data.json").read_text("utf-8"))
    start = sidecar["chain"].pop("start")
    plain = json.dumps(sidecar, sort_keys=True, ensure_ascii=False)
    value = hashlib.sha256((plain + header).encode()).hexdigest()
    assert value == start
    for row in rows:
        text, cell = row.rsplit(",", 1)
        value = hashlib.sha256((value + text).encode()).hexdigest()
        assert cell == value
    end = json.loads((folder / f"{STEM}_end.json").read_text("utf-8"))
    assert end["chain"] == value
    assert list(end["files"]) == [f"{STEM}_questionnaire_data.csv"]


def test_the_report_reads_the_same_chain(tmp_path):
    """Written here, verified by the analysis, which shares no code with the recorder."""
    from seethrough.analysis.errors import DataError
    from seethrough.analysis.load.whole import verified

    table = session(tmp_path) / f"{STEM}_trials_data.csv"
    assert [s.chain.state for s in verified(tmp_path).sessions] == ["verified"]
    table.write_bytes(table.read_bytes().replace(b",12,14,", b",14,14,", 1))
    with pytest.raises(DataError, match=r"_trials_data\.csv: row 2: changed"):
        verified(tmp_path)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_changed_byte_is_found_and_the_file_named(tmp_path_factory, data):
    folder = session(tmp_path_factory.mktemp("chain"))
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    path = data.draw(st.sampled_from(files))
    content, written = bytearray(path.read_bytes()), path.read_bytes()
    at = data.draw(st.integers(0, len(content) - 1))
    content[at] ^= 1 << data.draw(st.integers(0, 7))
    path.write_bytes(content)
    found = verify(folder)
    if path.suffix == ".json" and not found:
        # Space between JSON's values means nothing; every value is in the chain.
        assert json.loads(content) == json.loads(written)
    else:
        assert any(path.name in line or path.stem in line for line in found), (path, at, found)
    shutil.rmtree(folder)


def test_a_changed_row_is_named_by_its_number(tmp_path):
    folder = session(tmp_path)
    table = folder / f"{STEM}_trials_data.csv"
    text = table.read_text("utf-8")
    lines = text.split("\n")
    lines[2] = lines[2].replace(",false,", ",true,", 1)
    table.write_text("\n".join(lines), "utf-8")
    assert verify(folder) == [f"{table.name}: row 3: changed, or a row before it removed"]


@pytest.mark.parametrize("how", ["middle", "last", "order"])
def test_removed_and_exchanged_rows_are_found(tmp_path, how):
    folder = session(tmp_path)
    table = folder / f"{STEM}_trials_data.csv"
    lines = table.read_text("utf-8").split("\n")
    if how == "order":
        lines[1], lines[2] = lines[2], lines[1]
    else:
        del lines[2 if how == "middle" else 3]
    table.write_text("\n".join(lines), "utf-8")
    assert verify(folder)


def test_a_trace_that_was_changed_or_removed_is_named_with_its_trial(tmp_path):
    folder = session(tmp_path)
    trace = folder / "traces" / "session-1_trial-002_events.csv"
    trace.write_text(trace.read_text("utf-8").replace("11.0", "10.9"), "utf-8")
    line = f"(the trial in row 3 of {STEM}_trials_data.csv)"
    assert verify(folder) == [f"traces/{trace.name}: changed after the session {line}"]
    trace.unlink()
    assert verify(folder) == [f"traces/{trace.name}: removed after the session {line}"]


@pytest.mark.parametrize(
    "name",
    [
        f"{STEM}_questionnaire_data.csv",
        f"{STEM}_notes_data.csv",
        "traces/session-1_trial-004_events.csv",
    ],
)
def test_a_file_added_to_a_closed_session_is_named(tmp_path, name):
    folder = session(tmp_path, answers=False)
    assert verify(folder) == []
    (folder / name).write_text("forged", "utf-8")
    assert verify(folder) == [f"{name}: added after the session"]


def test_answers_of_a_session_that_never_was_are_named(tmp_path):
    folder = session(tmp_path)
    name = f"{STEM[:-1]}2_questionnaire_data.csv"
    (folder / name).write_text("forged", "utf-8")
    assert verify(folder) == [f"{name}: expected its session's trial table"]


def test_a_session_that_was_killed_verifies_as_far_as_it_goes(tmp_path):
    folder = session(tmp_path, status="")
    assert verify(folder) == []
    table = folder / f"{STEM}_trials_data.csv"
    with open(table, "a", encoding="utf-8") as file:
        file.write("human-P01-1-trial004,te")
    assert verify(folder) == [f"{table.name}: row 5: half-written: the line has no end"]


@pytest.mark.parametrize("how", ["changed", "removed", "added"])
def test_what_a_killed_session_left_beside_its_rows_is_held_by_the_next(tmp_path, how):
    from seethrough.analysis.errors import DataError
    from seethrough.analysis.load.whole import verified

    folder = session(tmp_path, status="", answers=how != "added")
    (folder / "traces" / "session-1_trial-004_events.csv").write_text("begun", "utf-8")
    session(tmp_path, number=2)
    assert verify(folder) == []
    assert [s.chain.state for s in verified(tmp_path).sessions] == ["open", "verified"]
    answers = folder / f"{STEM}_questionnaire_data.csv"
    if how == "removed":
        answers.unlink()
    else:
        answers.write_text("forged", "utf-8")
    assert verify(folder) == [f"{answers.name}: {how} after the session"]
    with pytest.raises(
        DataError, match=rf"session-1_questionnaire_data\.csv: {how} after the session"
    ):
        verified(tmp_path)


def test_a_continued_session_goes_on_with_the_chain_and_mends_the_half_row(tmp_path):
    folder = session(tmp_path, status="")
    table = folder / f"{STEM}_trials_data.csv"
    whole = table.read_bytes()
    table.write_bytes(whole + b"human-P01-1-tri")
    session(tmp_path, number=2)
    assert verify(folder) == []
    assert table.read_bytes() == whole
    second = folder / f"{STEM[:-1]}2_trials_data.json"
    sidecar = json.loads(second.read_text("utf-8"))
    assert sidecar["mended"] == {table.name: 15}
    assert sidecar["chain"]["follows"] == whole.decode().rsplit(",", 1)[1].strip()
    # Rows that are cut off the first session later are missed by the second.
    table.write_bytes(whole[: whole[:-1].rindex(b"\n") + 1])
    table_ = second.with_suffix(".csv")
    assert verify(folder) == [f"{table_.name}: does not follow the session before it"]
