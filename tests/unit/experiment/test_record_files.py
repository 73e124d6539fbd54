"""Rows of tables: texts of several lines stay one cell, and half a row is cut off as a whole."""

import csv
import hashlib
import io

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.record.columns import NOTES, QUESTIONNAIRE
from seethrough.experiment.record.record_files import (
    CHUNK,
    Table,
    Trace,
    csv_line,
    mend,
    whole_rows,
)

TEXTS = ("one\ntwo", "one\r\ntwo", "\r", "\n", 'a "quoted"\nline', "comma, and\nbreak", "plain")


@pytest.mark.parametrize("text", TEXTS)
def test_a_text_comes_back_as_it_was_typed(text):
    line = csv_line(["a", text, "b"]) + "\n"
    assert list(csv.reader(io.StringIO(line, newline=""))) == [["a", text, "b"]]


@pytest.mark.parametrize("text", TEXTS)
def test_wherever_a_table_was_cut_only_its_whole_rows_are_left(text):
    lines = [csv_line([str(n), text]) + "\n" for n in range(3)]
    data = "".join(lines).encode()
    ends = [len("".join(lines[:n]).encode()) for n in range(4)]
    for cut in range(len(data) + 1):
        assert whole_rows(data[:cut]) == max(end for end in ends if end <= cut), cut


def test_mending_takes_the_first_line_of_half_a_text_too(tmp_path):
    path = tmp_path / "study-t_subject-P01_session-1_notes_data.csv"
    table = Table(path, NOTES)
    table.append({"row_id": "1", "text": "whole\nnote"})
    size = path.stat().st_size
    table.append({"row_id": "2", "text": "half\nof a note\nis no note"})
    table.close()
    cut = path.read_bytes()[:-12]
    path.write_bytes(cut)
    assert mend(tmp_path) == {path.name: len(cut) - size}
    with open(path, encoding="utf-8", newline="") as file:
        assert [(r["row_id"], r["text"]) for r in csv.DictReader(file)] == [("1", "whole\nnote")]


def test_rows_at_once_are_all_there_or_none(tmp_path):
    path = tmp_path / "a_questionnaire_data.csv"
    table = Table(path, QUESTIONNAIRE)
    table.append({"item": "ease", "value": "1"}, {"item": "enjoy", "value": "2"})
    size = path.stat().st_size
    with pytest.raises(KeyError, match="columns not declared"):
        table.append({"item": "ease", "value": "1"}, {"no_column": "2"})
    table.close()
    assert path.stat().st_size == size
    assert path.read_text().count("\n") == 3


def test_a_trace_that_was_begun_after_somebody_took_over_is_not_left(tmp_path):
    """A station may stand still between asking whether it still plays and making the file."""

    def taken_over():
        raise InputError("taken over")

    path = tmp_path / "session-1_trial-002_events.csv"
    with pytest.raises(InputError, match="taken over"):
        Trace(path, "time", taken_over)
    assert not list(tmp_path.iterdir())


class Taken:
    """A guard that says so from its call of this number on."""

    def __init__(self, number):
        self.left = number

    def __call__(self):
        self.left -= 1
        if self.left <= 0:
            raise InputError("taken over")


def test_a_row_written_while_somebody_took_over_is_taken_back(tmp_path):
    path = tmp_path / "a_questionnaire_data.csv"
    guard = Taken(99)
    table = Table(path, QUESTIONNAIRE, "start", guard)
    table.append({"item": "ease", "value": "1"})
    size, chain = path.stat().st_size, table.chain
    guard.left = 2  # it asks before, and again after
    with pytest.raises(InputError, match="taken over"):
        table.append({"item": "ease", "value": "2"})
    table.close()
    assert (path.stat().st_size, table.chain) == (size, chain)


@pytest.mark.parametrize("call", [1, 2])
def test_a_table_begun_while_somebody_took_over_is_not_left(tmp_path, call):
    with pytest.raises(InputError, match="taken over"):
        Table(tmp_path / "a_notes_data.csv", QUESTIONNAIRE, None, Taken(call))
    assert not list(tmp_path.iterdir())


def test_a_piece_of_a_trace_is_taken_back(tmp_path):
    guard = Taken(99)
    trace = Trace(tmp_path / "session-1_trial-002_events.csv", "time", guard)
    trace.line("x" * (CHUNK + 1))
    size = trace.path.stat().st_size
    assert size > CHUNK
    guard.left = 2
    with pytest.raises(InputError, match="taken over"):
        trace.line("y" * (CHUNK + 1))
    assert trace.path.stat().st_size == size
    guard.left = 99
    trace.close()
    assert trace.sha256 == hashlib.sha256(trace.path.read_bytes()).hexdigest()
