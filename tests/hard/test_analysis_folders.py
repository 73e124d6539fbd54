"""Data folders that something went wrong with: one line each, naming file and row."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from made_data import Made, make_folder

from analysis.errors import SHOWN, DataError
from analysis.load.chain import link, seal_of, start_of
from analysis.load.study import load_study
from analysis.page.markdown import as_markdown
from analysis.report import Options, make_report
from experiment.cli import main

TRIALS = "data/human/P01/study-made_subject-P01_session-1_trials_data.csv"
ANSWERS = "data/human/P01/study-made_subject-P01_session-1_questionnaire_data.csv"


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    return make_folder(tmp_path_factory.mktemp("made") / "data", Made(participants=3, trials=2))


@pytest.fixture
def folder(made, tmp_path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "data"))


def edit(path: Path, row: int, column: str, value: str) -> None:
    """Change one cell; rows are counted as a spreadsheet does, the header is row 1."""
    lines = path.read_text().split("\n")
    names, cells = lines[0].split(","), lines[row - 1].split(",")
    cells[names.index(column)] = value
    lines[row - 1] = ",".join(cells)
    path.write_text("\n".join(lines))


def snapshot(folder: Path) -> dict[str, str]:
    return {
        str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()
    }


def refused(folder: Path, pattern: str) -> None:
    """Loading says `pattern` in one of its lines, and touches nothing."""
    before = snapshot(folder)
    with pytest.raises(DataError) as caught:
        load_study(folder)
    assert all("\n" not in line for line in caught.value.lines)
    assert any(re.search(pattern, line) for line in caught.value.lines), caught.value.lines
    assert snapshot(folder) == before


@pytest.mark.parametrize(
    ("column", "value", "pattern"),
    [
        ("time", "fast", r"row 5: time = 'fast': expected a finite number"),
        ("time", "nan", r"row 5: time = 'nan': expected a finite number"),
        ("time", "inf", r"row 5: time = 'inf': expected a finite number"),
        ("time", "-3.5", r"row 5: time = -3.5: expected a positive time"),
        ("time", "0", r"row 5: time = 0: expected a positive time"),
        ("time", "", r"row 5: time = '': expected a value"),
        ("block", "1.5", r"row 5: block = '1.5': expected a whole number"),
        ("correct", "yes", r"row 5: correct = 'yes': expected true or false"),
        ("timed_out", "", r"row 5: timed_out = '': expected a value"),
        ("transparency", "ghostly", r"row 5: transparency = 'ghostly': expected standard, dynamic"),
        ("task", "juggle", r"row 5: task = 'juggle': expected count, pattern, unique, count_in"),
        ("source", "simulated", r"row 5: source = 'simulated': expected human, the folder's"),
        ("participant", "../x", r"row 5: participant = '../x': expected \[A-Za-z0-9_-\]"),
        ("distance", "-1", r"row 5: distance = -1: expected a distance, 0 or more"),
    ],
)
def test_a_bad_value_is_named_by_file_and_row(folder, column, value, pattern):
    edit(folder / TRIALS, 5, column, value)
    refused(folder, re.escape(TRIALS) + ": " + pattern)


def test_a_duplicate_row_names_both_places(folder):
    path = folder / TRIALS
    lines = path.read_text().split("\n")
    path.write_text("\n".join([*lines[:-1], lines[3], ""]))
    refused(folder, r"row 18: row_id = .* expected a unique one, but .*: row 4 has it too")


def test_a_row_cut_in_the_middle(folder):
    path = folder / TRIALS
    path.write_bytes(path.read_bytes()[:-60])
    refused(folder, r"row 17: half-written: the line has no end")


def test_a_row_with_too_few_values(folder):
    path = folder / TRIALS
    lines = path.read_text().split("\n")
    lines[7] = ",".join(lines[7].split(",")[:9])
    path.write_text("\n".join(lines))
    refused(folder, r"row 8: 9 of 32 values: expected a whole row")


def test_a_missing_and_a_renamed_column(folder):
    path = folder / TRIALS
    path.write_text(path.read_text().replace("transparency,", "technique,", 1))
    refused(folder, r"column = transparency: missing \(columns it does not know: .*technique")


def test_a_column_twice(folder):
    path = folder / TRIALS
    path.write_text(path.read_text().replace("worst_frame", "time", 1))
    refused(folder, "column = time: twice in the header")


def test_bytes_that_are_no_text(folder):
    path = folder / TRIALS
    path.write_bytes(path.read_bytes().replace(b"set2", b"s\xff\xfe2", 1))
    refused(folder, r"row 3: not UTF-8 text")


def test_a_broken_sidecar(folder):
    (folder / TRIALS).with_suffix(".json").write_text('{"config": ')
    refused(folder, r"trials_data.json: not JSON")


def test_an_empty_trial_table(folder):
    (folder / TRIALS).write_text("")
    refused(folder, "column = row_id: missing")


def test_folders_that_are_no_dataset(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").write_text("Dear")
    for name, said in (
        ("missing", "no such folder"),
        ("empty", "an empty folder: expected dataset_description.json"),
        ("other", "no dataset: expected dataset_description.json"),
    ):
        assert main(["report", str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
        error = capsys.readouterr().err
        assert said in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_dataset_without_participants(tmp_path):
    (tmp_path / "dataset_description.json").write_text("{}")
    refused(tmp_path, "no participants yet")


def test_many_problems_end_in_a_count(folder, capsys, tmp_path):
    path = folder / TRIALS
    path.write_text(path.read_text().replace(",standard,", ",ghost,").replace(",dynamic,", ",x,"))
    for other in ("P02", "P03"):
        twin = folder / TRIALS.replace("P01", other)
        twin.write_text(twin.read_text().replace(",standard,", ",ghost,"))
    assert main(["report", str(folder), "--out", str(tmp_path / "out")]) == 2
    lines = capsys.readouterr().err.strip().split("\n")
    assert len(lines) == SHOWN + 1
    assert re.search(r"and \d+ more like these", lines[-1])


def test_an_unknown_exclusion_rule(folder, capsys, tmp_path):
    words = ["report", str(folder), "--out", str(tmp_path / "out"), "--exclude", "ugly"]
    assert main(words) == 2
    assert "exclude = 'ugly': expected one of timed_out" in capsys.readouterr().err


def test_rows_of_windows_line_ends_and_quoted_texts_are_fine(folder):
    path = folder / ANSWERS
    text = path.read_text().replace("enjoy,", '"enjoy",', 1)
    path.write_text(text.replace("\n", "\r\n"), newline="")
    study = load_study(folder)
    assert len(study.questionnaire) == 45


def test_free_text_with_line_breaks_counts_rows_not_lines(folder):
    path = folder / ANSWERS
    lines = path.read_text().split("\n")
    lines[1] += '"two\nlines, one answer"'
    path.write_text("\n".join(lines))
    edited = path.read_text().replace(",ease,standard,abstract,", ",ease,standard,abstract,x", 1)
    path.write_text(edited)
    refused(folder, r"row 3: value = 'x\d': expected a finite number")


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def chain(folder: Path) -> Path:
    """Give P01's table a hash chain and traces, as the recorder does."""
    path = folder / TRIALS
    traces = path.parent / "traces"
    traces.mkdir()
    lines = path.read_text().rstrip("\n").split("\n")
    names = lines[0].split(",")
    header = lines[0] + ",events_sha256,camera_sha256,chain"
    sidecar = path.with_suffix(".json")
    about = {**json.loads(sidecar.read_text()), "chain": {}}
    before = start_of(about, header)
    sidecar.write_text(json.dumps({**about, "chain": {"start": before}}))
    out = [header]
    for number, line in enumerate(lines[1:], start=1):
        cells = line.split(",")
        for trace in ("events", "camera"):
            name = f"traces/session-1_trial-{number:03d}_{trace}.csv"
            (path.parent / name).write_text(f"t,{trace}\n{number},0.5\n")
            cells[names.index(f"{trace}_file")] = name
        cells += [
            sha256(path.parent / cells[names.index(f"{t}_file")]) for t in ("events", "camera")
        ]
        before = link(before, ",".join(cells))
        out.append(",".join([*cells, before]))
    path.write_text("\n".join(out) + "\n")
    training = traces / "session-1_training-101_events.csv"
    training.write_text("t,event\n")
    others = [p for p in (folder / ANSWERS, training) if p.is_file()]
    files = {str(p.relative_to(path.parent)): sha256(p) for p in others}
    end = path.with_name(path.name.replace("_trials_data.csv", "_end.json"))
    about = {"status": "complete", "chain": before, "files": files}
    end.write_text(json.dumps({**about, "seal": seal_of(about)}))
    return end


def test_a_good_chain_is_verified(folder):
    end = chain(folder)
    states = {c.file: c.state for c in load_study(folder).chains}
    assert states[TRIALS] == "verified"
    assert sorted(states.values()) == ["none", "none", "verified"]
    end.unlink()
    assert {c.file: c.state for c in load_study(folder).chains}[TRIALS] == "open"


def test_one_changed_byte_is_found_and_named(folder):
    chain(folder)
    path = folder / TRIALS
    lines = path.read_text().split("\n")
    lines[9] = lines[9].replace("false", "true", 1)
    path.write_text("\n".join(lines))
    refused(folder, r"P01.*: row 10: changed, or a row before it removed")


def test_rows_cut_off_at_the_end_are_found(folder):
    chain(folder)
    path = folder / TRIALS
    path.write_text("\n".join(path.read_text().split("\n")[:-3]) + "\n")
    refused(folder, r"P01.*: rows at its end were removed or added")


def test_a_changed_sidecar_is_found(folder):
    chain(folder)
    sidecar = (folder / TRIALS).with_suffix(".json")
    sidecar.write_text(sidecar.read_text().replace("0.1.0", "0.1.1"))
    refused(folder, r"P01.*: row 1: this header, or its sidecar, was changed")


def test_a_changed_questionnaire_is_found(folder):
    chain(folder)
    edit(folder / ANSWERS, 4, "value", "4")
    refused(folder, r"P01.*questionnaire_data.csv: changed after the session")


def test_a_forged_questionnaire_is_no_part_of_a_closed_session(folder):
    """Its own answers were listed as it closed: those that lie there without were added later."""
    answers = (folder / ANSWERS).read_bytes()
    (folder / ANSWERS).unlink()
    chain(folder)
    states = {c.file: c.state for c in load_study(folder).chains}
    assert states[TRIALS] == "verified"
    (folder / ANSWERS).write_bytes(answers)
    refused(folder, r"P01.*session-1_questionnaire_data\.csv: added after the session")
    (folder / ANSWERS).unlink()
    later = folder / ANSWERS.replace("session-1", "session-2")
    later.write_bytes(answers)
    refused(folder, r"P01.*session-2_questionnaire_data\.csv: expected its session's trial table")


def test_a_trace_added_to_a_closed_session_is_named(folder):
    chain(folder)
    (folder / TRIALS).with_name("traces").joinpath("session-1_trial-999_events.csv").write_text("")
    refused(folder, r"P01/traces/session-1_trial-999_events\.csv: added after the session")
    (folder / TRIALS).with_name("traces").joinpath("session-1_trial-999_events.csv").unlink()
    (folder / TRIALS).with_name("traces").joinpath("session-10_trial-1_events.csv").write_text("")
    load_study(folder)  # another session's, not this one's


def test_a_changed_byte_in_any_recorded_file_is_found_and_named(folder):
    """Each file of a session in turn: tables, sidecar, traces of trials and of training."""
    chain(folder)
    load_study(folder)
    for path in sorted((folder / TRIALS).parent.rglob("*")):
        if not path.is_file():
            continue
        whole = path.read_bytes()
        # the last letter or digit: still a table, still JSON, and no longer what was written
        at = max(i for i, byte in enumerate(whole) if chr(byte).isalnum())
        path.write_bytes(
            whole[:at] + (b"1" if whole[at : at + 1] != b"1" else b"2") + whole[at + 1 :]
        )
        named = path.with_suffix(".csv") if path.name.endswith("_data.json") else path
        refused(folder, f"{named.relative_to(folder)}: .*changed")
        path.write_bytes(whole)
    load_study(folder)


def test_a_trace_names_its_trial(folder):
    chain(folder)
    (folder / TRIALS).parent.joinpath("traces/session-1_trial-003_camera.csv").write_text("")
    refused(folder, r"trial-003_camera.csv: changed after .*the trial in row 4 of .*P01")


def test_a_removed_trace_is_found_and_data_without_any_say_so(folder):
    chain(folder)
    traces = (folder / TRIALS).parent / "traces"
    (traces / "session-1_trial-002_events.csv").unlink()
    refused(folder, "trial-002_events.csv: removed after the session")
    shutil.rmtree(traces)
    text = as_markdown(make_report(folder, Options()))
    assert "1 without their traces, which are not in this folder" in text


def test_the_report_prints_what_the_chains_say(folder):
    chain(folder)
    text = as_markdown(make_report(folder, Options()))
    rows = (folder / TRIALS).read_text().count("\n") - 1
    assert "1 verified to the end of the session; 2 without a chain" in text
    assert f"{2 * rows + 1} traces as they were recorded" in text


def test_a_session_that_does_not_follow_the_one_before_is_found(folder):
    """Session 2's chain goes on from session 1's end: exchanging or dropping a session shows."""
    chain(folder)
    first = folder / TRIALS
    second = Path(str(first).replace("session-1", "session-2"))
    header = first.read_text().split("\n")[0]
    for follows, pattern in (("", "does not follow the session before"), (None, "")):
        last = first.read_text().rstrip("\n").rpartition(",")[2] if follows is None else follows
        about = {"chain": {"follows": last}}
        start = start_of(about, header)
        second.with_suffix(".json").write_text(
            json.dumps({"chain": {**about["chain"], "start": start}})
        )
        second.write_text(header + "\n")
        if pattern:
            refused(folder, f"session-2.*: {pattern}")
        else:
            load_study(folder)


def test_a_participant_without_a_cell_is_left_out_by_name(folder):
    path = folder / TRIALS
    rows = path.read_text().split("\n")
    path.write_text("\n".join(r for r in rows if not (",unique," in r and ",dynamic," in r)))
    report = make_report(folder, Options())
    section = next(s for s in report.sections if s.key == "participants")
    missing = next(b for b in section.blocks if getattr(b, "key", "") == "missing")
    named = {(r["where"], r["participant"], r["cells"]) for r in missing.rows}
    assert ("completion time", "P01", "unique × dynamic") in named


def test_somebody_who_never_met_a_task_or_a_question_is_named(folder):
    """No row is no reason to vanish: in T3's distance, and in the ratings."""
    path = folder / TRIALS
    rows = path.read_text().split("\n")
    path.write_text("\n".join(r for r in rows if ",unique," not in r))
    (folder / ANSWERS).unlink()
    report = make_report(folder, Options())
    section = next(s for s in report.sections if s.key == "participants")
    missing = next(b for b in section.blocks if getattr(b, "key", "") == "missing")
    named = {(r["where"], r["participant"]) for r in missing.rows}
    assert {("distance", "P01"), ("completion time", "P01"), ("ratings", "P01")} <= named
    assert all(participant == "P01" for _, participant in named)


def test_a_repeated_trial_counts_once_and_the_earlier_attempt_is_named(folder):
    path = folder / TRIALS
    lines = path.read_text().rstrip("\n").split("\n")
    again = lines[4].split(",")
    again[0], again[10] = "human-P01-1-trial900", "2"
    path.write_text("\n".join([*lines, ",".join(again)]) + "\n")
    report = make_report(folder, Options())
    section = next(s for s in report.sections if s.key == "participants")
    excluded = next(b for b in section.blocks if getattr(b, "key", "") == "excluded")
    assert [(r["rule"], r["row"]) for r in excluded.rows] == [("repeated", 5)]


def test_one_level_of_transparency_says_so_and_still_reports(folder):
    for path in folder.glob("data/human/*/*_data.csv"):
        rows = path.read_text().split("\n")
        path.write_text("\n".join(r for r in rows if ",dynamic," not in r))
    report = make_report(folder, Options())
    assert [s.key for s in report.sections][:2] == ["summary", "participants"]


def test_random_damage_never_gives_a_traceback(folder):
    """300 damaged copies of a table: each loads, or is refused in lines that name the file."""
    rng = np.random.default_rng(11)
    path = folder / TRIALS
    whole = path.read_bytes()
    refusals = 0
    for _ in range(300):
        data = bytearray(whole)
        for _ in range(int(rng.integers(1, 4))):
            kind, at = int(rng.integers(4)), int(rng.integers(len(data)))
            if kind == 0:
                data[at] = int(rng.integers(256))
            elif kind == 1:
                del data[at : at + int(rng.integers(1, 200))]
            elif kind == 2:
                data[at:at] = data[at : at + int(rng.integers(1, 90))]
            else:
                data[at:at] = bytes(rng.choice(list(b',"\n\r\x00-e.')) for _ in range(2))
        path.write_bytes(bytes(data))
        try:
            load_study(folder)
        except DataError as error:
            refusals += 1
            assert all(line and "\n" not in line for line in error.lines)
    assert refusals > 200
