"""Data folders that something went wrong with: one line each, naming file and row."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from data_folders import ANSWERS, TRIALS, edit, refused
from made_data import Made, make_folder

from seethrough.analysis.errors import SHOWN, DataError
from seethrough.analysis.load.study import load_study
from seethrough.analysis.report import Options, make_report
from seethrough.experiment.cli import main


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    return make_folder(tmp_path_factory.mktemp("made") / "data", Made(participants=3, trials=2))


@pytest.fixture
def folder(made, tmp_path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "data"))


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
