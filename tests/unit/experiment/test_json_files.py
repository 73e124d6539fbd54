"""What stands in a data folder's JSON files, and in place of them."""

import re

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.json_files import number_in, part_of, read_object
from seethrough.experiment.ledger.ledger import study_in
from seethrough.experiment.ledger.ledger_files import ends_complete
from seethrough.experiment.session.resume import past

NONE = [
    (b"[]", "expected a JSON object"),
    (b"null", "expected a JSON object"),
    (b'"text"', "expected a JSON object"),
    (b"{", "not JSON"),
    (b"", "not JSON"),
    (b"\xff\xfe{}", "UTF-16"),
    (b'{"a": "\xff"}', "not UTF-8"),
    (b'{"a": 1, "a": 2}', "'a' is there twice"),
    (b"[" * 100_000, "nested too deep"),
]


@pytest.mark.parametrize(("content", "words"), NONE)
def test_what_is_no_object_is_refused_in_a_line(tmp_path, content, words):
    path = tmp_path / "a.json"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_object(path)
    (line,) = error.value.lines
    assert line.startswith(f"{path}: ") and words in line and "\n" not in line


def test_a_folder_and_a_missing_file_are_told_apart(tmp_path):
    (tmp_path / "a.json").mkdir()
    with pytest.raises(InputError, match=r"a\.json: (cannot be read|a folder)"):
        read_object(tmp_path / "a.json")
    with pytest.raises(InputError, match=r"b\.json: no such file"):
        read_object(tmp_path / "b.json")


@pytest.mark.parametrize("value", ["x", "1", 0, -1, 1.0, True, None, [1], {}])
def test_a_number_is_a_whole_one(tmp_path, value):
    with pytest.raises(InputError, match=r"a\.json: slot = .*: expected a whole number from 1"):
        number_in({"slot": value}, "slot", tmp_path / "a.json")
    assert number_in({"slot": 7}, "slot", tmp_path / "a.json") == 7


SIDECARS = [
    ("[]", "expected a JSON object"),
    ("{}", "session: missing: expected a whole number from 1"),
    ('{"session": 1, "provenance": {}}', "slot: missing: expected a whole number from 1"),
    ('{"session": 1, "slot": "x", "provenance": {}}', 'slot = "x": expected a whole number'),
    ('{"session": "1", "slot": 1, "provenance": {}}', 'session = "1": expected a whole number'),
    ('{"session": 1, "slot": 1, "provenance": []}', "provenance = []: expected a JSON object"),
    ('{"session": 1, "slot": 1}', "provenance: missing: expected a JSON object"),
]


@pytest.mark.parametrize(("content", "words"), SIDECARS)
def test_a_sidecar_that_does_not_say_where_one_was_is_refused(tmp_path, content, words):
    """Not a traceback, and not as if it were the first session."""
    folder = tmp_path / "data" / "human" / "P01"
    folder.mkdir(parents=True)
    sidecar = folder / "sub-P01_ses-1_trials_data.json"
    sidecar.write_text(content)
    with pytest.raises(InputError, match=re.escape(words)) as error:
        past(tmp_path, "human", "P01")
    assert str(sidecar) in str(error.value)


def test_a_table_whose_trial_is_no_number_is_refused(tmp_path):
    folder = tmp_path / "data" / "human" / "P01"
    folder.mkdir(parents=True)
    sidecar = folder / "sub-P01_ses-1_trials_data.json"
    sidecar.write_text('{"session": 1, "slot": 1, "provenance": {}}')
    sidecar.with_suffix(".csv").write_text("trial,x\none,2\n")
    with pytest.raises(InputError, match='trial = "one": expected a whole number'):
        past(tmp_path, "human", "P01")


def test_an_end_that_is_no_object_is_not_an_end_that_says_nothing(tmp_path):
    (tmp_path / "x_end.json").write_text("[]")
    with pytest.raises(InputError, match="expected a JSON object"):
        ends_complete(tmp_path)


def test_a_description_that_cannot_be_read_is_not_a_missing_one(tmp_path):
    assert study_in(tmp_path) == ""
    path = tmp_path / "dataset_description.json"
    for content, words in (("[]", "expected a JSON object"), ("{}", "name = null"), ("{", "JSON")):
        path.write_text(content)
        with pytest.raises(InputError, match=words):
            study_in(tmp_path)


def test_an_object_within_one(tmp_path):
    assert part_of({"a": {"b": 1}}, "a", tmp_path) == {"b": 1}
