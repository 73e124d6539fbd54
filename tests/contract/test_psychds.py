"""The data folder against the rules of Psych-DS, one test for each, beside its own words.

Rules: psych-ds.github.io, "Rules and Conventions". They are checked on what the recorder writes;
one is broken on purpose (decisions/0005), which the copy of `export --format psychds` keeps.
"""

import csv
import json
import re

import pytest
from recorded import record

from seethrough.experiment import cli
from seethrough.experiment.record.columns import TABLES

# "keys can be any sequence of lowercase alphabetic characters (a-z)", "values can be any sequence
# of upper- and lowercase alphanumeric characters", joined by underscores, ending in _data.csv
STRICT = re.compile(r"[a-z]+-[a-zA-Z0-9]+(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv")
KEYWORDS = {"study", "subject", "session", "table"}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "demo"
    for slot, name in enumerate(("P01", "P_2-x"), start=1):
        record(folder, name, slot)
    return folder


@pytest.fixture(scope="module")
def copied(recorded, tmp_path_factory):
    out = tmp_path_factory.mktemp("export") / "out"
    assert cli.main(["export", str(recorded), "--format", "psychds", "--out", str(out)]) == 0
    return out


@pytest.fixture(params=["recorded", "copied"])
def dataset(request):
    """Every rule holds for the data folder and for its copy."""
    return request.getfixturevalue(request.param)


@pytest.fixture
def about(dataset):
    return json.loads((dataset / "dataset_description.json").read_text("utf-8"))


def tables(dataset):
    return sorted((dataset / "data").rglob("*_data.csv"))


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file, strict=True))


def test_metadata_is_json_in_the_root_directory(about):
    """ "a global metadata file named dataset_description.json in the root directory" """
    assert isinstance(about, dict)


@pytest.mark.parametrize("field", ["name", "description", "variableMeasured"])
def test_metadata_has_the_required_field(about, field):
    """ "must contain the following fields: name, description, variableMeasured" """
    assert about[field]


def test_the_namespace_is_schema_org(about):
    """ "by including a @context field with the value https://schema.org" """
    assert about["@context"] == "https://schema.org"


def test_the_type_is_dataset(about):
    """ "a field called @type or type with the value Dataset" """
    assert about["@type"] == "Dataset"


def test_variables_are_strings_or_property_values(about):
    """ "either in the form of strings or as JSON objects with PropertyValue as their @type" """
    assert {v["@type"] for v in about["variableMeasured"]} == {"PropertyValue"}
    assert all(v["name"] and v["description"] for v in about["variableMeasured"])


def test_variables_are_the_columns_of_the_data_files(dataset, about):
    """ "an array containing all of the column headers found across all the official data files" """
    measured = [v["name"] for v in about["variableMeasured"]]
    assert len(set(measured)) == len(measured)
    assert {name for path in tables(dataset) for name in rows(path)[0]} == set(measured)


def test_there_is_a_data_directory_with_a_data_file(dataset):
    """ "a subdirectory called data"; "at least one valid data file within" """
    assert {p.parent.parent.name for p in tables(dataset)} == {"human"}
    assert len(tables(dataset)) == 2 * len(TABLES)


def test_csv_files_are_utf8_with_a_header_and_whole_rows(dataset):
    """ "utf-8 encoded"; "headers in the first row"; "the same number of cells as the header" """
    for path in tables(dataset):
        path.read_bytes().decode("utf-8")
        header, *body = rows(path)
        assert all(re.fullmatch(r"[a-z][a-z0-9_]*", name) for name in header)
        assert body and {len(row) for row in body} == {len(header)}


def test_commas_in_values_are_quoted(dataset):
    """ "commas used within the data itself … must be enclosed by double-quotes" """
    values = [v for path in tables(dataset) for row in rows(path)[1:] for v in row]
    assert any("," in v for v in values)  # read back from between quotes: the rows were whole


def test_row_ids_are_unique(dataset):
    """ "a column with the header row_id … must contain a unique value in every row" """
    ids = [row[0] for path in tables(dataset) for row in rows(path)[1:]]
    assert all(rows(path)[0][0] == "row_id" for path in tables(dataset))
    assert len(set(ids)) == len(ids)


def test_names_end_in_the_suffix(dataset):
    """ "Names for data files must end with the suffix _data"; "use the .csv extension" """
    ours = {p.name for p in (dataset / "data").rglob("*.csv") if p.parent.name != "traces"}
    assert ours == {p.name for p in tables(dataset)}


def test_sidecars_share_the_name_of_their_data_file(dataset):
    """ "the exact same name as the data file … with .csv swapped for .json", same directory" """
    sidecars = list((dataset / "data").rglob("*_data.json"))
    assert len(sidecars) == 2
    for path in sidecars:
        assert path.with_suffix(".csv").is_file()
        # Fields of a sidecar replace the global ones: ours must not.
        assert not {"name", "description", "variableMeasured"} & set(json.loads(path.read_bytes()))


def test_names_are_keywords_in_the_copy(copied):
    """ "keywords are pairs of keys and values"; "combined together using underscores" """
    for path in tables(copied):
        assert STRICT.fullmatch(path.name), path.name
        keys = [part.partition("-")[0] for part in path.name.split("_")[:-1]]
        assert set(keys) == KEYWORDS and len(set(keys)) == len(keys)


def test_the_one_deviation_is_the_table_in_the_name(recorded, root):
    """Only `_trials_data` instead of `_table-trials_data` breaks the rule above."""
    for path in tables(recorded):
        assert not STRICT.fullmatch(path.name)
        name = re.sub(rf"_({'|'.join(TABLES)})_data", r"_table-\1_data", path.name)
        assert STRICT.fullmatch(name), path.name
    decision = root / "decisions" / "0005-trial-table-name.md"
    assert "_table-trials_data.csv" in decision.read_text("utf-8")


def test_the_copy_holds_the_same_bytes(recorded, copied):
    """Only names change."""
    for path in tables(recorded):
        name = re.sub(rf"_({'|'.join(TABLES)})_data", r"_table-\1_data", path.name)
        copy = copied / path.relative_to(recorded).with_name(name)
        assert copy.read_bytes() == path.read_bytes()
