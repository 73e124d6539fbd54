"""Exports, each read back by a reader that shares no code with the writer."""

import csv
import json
import shutil
import stat

import fastparquet
import pandas as pd
import pytest
from bids_validator import BIDSValidator
from recorded import REMARK, record

from seethrough.analysis.load.study import load_study
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.export.dataset import _rows, harmless
from seethrough.experiment.export.parquet import ParquetWriter
from seethrough.experiment.record.columns import with_factors
from seethrough.experiment.study.config import load
from seethrough.experiment.study.shown.described import design_entry


def columns_of_demo():
    """Every table's columns in the study that is recorded here."""
    entry = design_entry(load("demo"))
    return with_factors(entry["factors"], entry["tasks"])


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data") / "demo"
    record(folder, "P01", 1)
    record(folder, "P_2", 2)
    return folder


def exported(data, form, out, *words):
    assert cli.main(["export", str(data), "--format", form, "--out", str(out), *words]) == 0
    files = [p for p in out.rglob("*") if p.is_file()]
    assert {stat.S_IMODE(p.stat().st_mode) for p in files} == {0o600}
    return out


def original(data, table):
    """The recorded tables as pandas reads them, all as texts."""
    paths = sorted(data.glob(f"data/human/*/*_{table}_data.csv"))
    return pd.concat([pd.read_csv(p, dtype=str, keep_default_na=False) for p in paths])


def test_wide_has_each_measure_of_each_trial_once(data, tmp_path):
    out = exported(data, "wide", tmp_path / "out")
    table = pd.read_csv(out / "wide.csv", index_col="participant")
    assert list(table.index) == ["P01", "P_2"] and list(table["slot"]) == [1, 2]
    trials = original(data, "trials")
    last = trials[~trials.duplicated(["participant", "trial"], keep="last")]
    assert len(last) == 16 and len(trials) == 18
    seen = 0
    for _, trial in last.iterrows():
        cell = f"{trial['transparency']}_{trial['task']}_{trial['trial_in_set']}"
        row = table.loc[trial["participant"]]
        assert row[f"time_{cell}"] == float(trial["time"])
        assert row[f"timed_out_{cell}"] == (trial["timed_out"] == "true")
        for measure in ("correct", "count_error", "distance"):
            if trial[measure] != "":
                words = {"true": "1", "false": "0"}
                value = float(words.get(trial[measure], trial[measure]))
                assert row[f"{measure}_{cell}"] == value
                seen += 1
    assert seen > 20
    assert list(table["remarks"]) == [REMARK, REMARK]  # begins with no formula: as it is
    assert list(table["ease_standard_walkthrough"]) == [1, 1]
    codebook = json.loads((out / "wide.json").read_text("utf-8"))
    assert set(codebook) - {"*"} == {"participant", *table.columns}


def test_parquet_has_every_row_and_type(data, tmp_path):
    out = exported(data, "parquet", tmp_path / "out")
    # Integers and booleans are nullable where some are missing; fastparquet names them so.
    kinds = {
        "text": {"object"}, "integer": {"int64"}, "number": {"float64"},
        "boolean": {"bool", "boolean"},
    }  # fmt: skip
    for table, columns in columns_of_demo().items():
        with open(out / f"{table}.parquet", "rb") as file:
            read = fastparquet.ParquetFile(file)
            frame, types = read.to_pandas(), {k: str(v) for k, v in read.dtypes.items()}
        expected = original(data, table).sort_values("row_id").reset_index(drop=True)
        frame = frame.sort_values("row_id").reset_index(drop=True)
        assert list(frame) == [c.name for c in columns] and len(frame) == len(expected) > 1
        for column in columns:
            assert types[column.name].lower() in kinds[column.type], column.name
            for got, text in zip(frame[column.name], expected[column.name], strict=True):
                if text == "":
                    assert pd.isna(got)
                elif column.type == "text":
                    assert got == text
                elif column.type == "boolean":
                    assert bool(got) is (text == "true")
                else:
                    assert got == float(text)


def test_bids_names_and_columns_are_valid(data, tmp_path):
    out = exported(data, "bids", tmp_path / "out")
    files = [p for p in out.rglob("*") if p.is_file()]
    valid = BIDSValidator()
    assert not [f for f in files if not valid.is_bids("/" + f.relative_to(out).as_posix())]
    about = json.loads((out / "dataset_description.json").read_text("utf-8"))
    assert {"Name", "BIDSVersion"} <= set(about)
    people = pd.read_csv(out / "participants.tsv", sep="\t")
    assert list(people["participant_id"]) == ["sub-P01", "sub-P2"]
    inherited = json.loads((out / "task-seethrough_events.json").read_text("utf-8"))
    tables = sorted(out.rglob("*_events.tsv"))
    assert len(tables) == 2
    trials = original(data, "trials")
    for path, participant in zip(tables, ("P01", "P_2"), strict=True):
        events = pd.read_csv(path, sep="\t", quoting=csv.QUOTE_NONE, na_values="n/a")
        assert list(events)[:2] == ["onset", "duration"] and set(events) <= set(inherited)
        mine = trials[trials["participant"] == participant]
        assert list(events["duration"]) == [float(t) for t in mine["time"]]
        began = pd.to_datetime(mine["started"])
        assert list(events["onset"]) == list((began - began.min()).dt.total_seconds())
        shown = json.loads(path.with_suffix(".json").read_text("utf-8"))["StimulusPresentation"]
        assert shown["SoftwareName"] == "Seethrough" and shown["WindowSize"] == "800x600"
    answers = pd.read_csv(out / "phenotype" / "questionnaire.tsv", sep="\t")
    assert set(answers) - {"participant_id"} == set(
        json.loads((out / "phenotype" / "questionnaire.json").read_text("utf-8"))
    )


def test_bids_labels_that_would_be_one_are_refused(tmp_path, capsys):
    record(tmp_path / "data", "P_1", 1)
    with pytest.raises(InputError, match="'P_1' has files already: expected an id that differs"):
        record(tmp_path / "data", "P1", 2)  # file names would say the same of both
    record(tmp_path / "other", "P1", 2)  # as older versions let them be
    shutil.copytree(tmp_path / "other" / "data", tmp_path / "data" / "data", dirs_exist_ok=True)
    for form in ("bids", "psychds"):
        words = ["export", str(tmp_path / "data"), "--format", form, "--out", str(tmp_path / "o")]
        assert cli.main(words) == 2
        assert "participants P1, P_1: expected ids that differ" in capsys.readouterr().err
        assert not (tmp_path / "o").exists()
    exported(tmp_path / "data", "wide", tmp_path / "o")


def test_sources_are_never_mixed_and_nothing_is_overwritten(data, tmp_path, capsys):
    folder = tmp_path / "both"
    record(folder, "P01", 1)
    record(folder, "S01", 1, "simulated")
    words = ["export", str(folder), "--format", "wide", "--out", str(tmp_path / "out")]
    assert cli.main(words) == 2
    assert "sources are never mixed: choose with --source" in capsys.readouterr().err
    assert cli.main([*words, "--source", "pilot"]) == 2
    assert "source = pilot: expected one that has data (human, simulated)" in (
        capsys.readouterr().err
    )
    exported(folder, "wide", tmp_path / "out", "--source", "simulated")
    assert list(pd.read_csv(tmp_path / "out" / "wide.csv")["participant"]) == ["S01"]
    assert cli.main([*words, "--source", "human"]) == 2
    assert "expected a new or an empty folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("false,0,60,", "maybe,0,60,", r"row 2: timed_out = 'maybe': expected boolean"),
        (",60,1,", ",60.5,1,", r"row 2: frames = '60.5': expected integer"),
        ("row_id,", "row,", r"header: expected \d+ columns; not so: \['row', 'row_id'\]"),
        (",P01,", ",P01,P01,", r"row 2: \d+ of \d+ values: expected a whole row"),
        (",P01,", ",../x,", r"row 2: participant: expected a participant's id"),
    ],
)
def test_a_broken_table_is_named(tmp_path, capsys, old, new, message):
    record(tmp_path / "data", "P01", 1)
    (path,) = tmp_path.rglob("*_trials_data.csv")
    path.write_text(path.read_text("utf-8").replace(old, new, 1), "utf-8")
    with pytest.raises(InputError, match=rf"_trials_data\.csv: {message}$"):
        _rows(path, path.read_bytes(), "trials")  # another program's table, which has no chain
    for form in ("wide", "parquet", "bids", "psychds"):  # this one has: nothing takes it
        words = ["export", str(tmp_path / "data"), "--format", form, "--out", str(tmp_path / "out")]
        assert cli.main(words) == 2
        assert "session-1_trials_data.csv: " in capsys.readouterr().err
        assert not (tmp_path / "out").exists()


def test_a_table_from_before_a_column_was_added_is_read_with_empty_cells(tmp_path):
    record(tmp_path / "data", "P01", 1)
    (path,) = tmp_path.rglob("*_trials_data.csv")
    new = pd.read_csv(path, dtype=str, keep_default_na=False)
    old = new.drop(columns=["time_within", "early", "world"]).to_csv(index=False).encode()
    rows = _rows(path, old, "trials")
    assert [list(row) for row in rows] == [list(new)] * len(new)
    assert {(row["time_within"], row["early"], row["world"]) for row in rows} == {("", "", "")}
    assert [row["time"] for row in rows] == list(new["time"])
    with pytest.raises(InputError, match=r"not so: \['early'\]"):  # one of them alone never was
        _rows(path, new.drop(columns="early").to_csv(index=False).encode(), "trials")


def test_parquet_joins_tables_from_before_and_after_a_column_was_added(tmp_path):
    record(tmp_path / "data", "P01", 1)
    (path,) = tmp_path.rglob("*_trials_data.csv")
    new = pd.read_csv(path, dtype=str, keep_default_na=False)
    new.drop(columns=["time_within", "early", "world"]).to_csv(tmp_path / "old.csv", index=False)
    with ParquetWriter() as writer:
        writer.write("trials", [tmp_path / "old.csv", path], tmp_path / "both.parquet")
    with open(tmp_path / "both.parquet", "rb") as file:
        both = fastparquet.ParquetFile(file).to_pandas()
    assert list(both) == list(new) and list(both["row_id"]) == 2 * list(new["row_id"])
    assert list(both["early"].isna()) == [True] * len(new) + list(new["early"] == "")
    assert list(both["time"]) == pytest.approx(2 * list(new["time"].astype(float)))


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("=cmd|' /C calc'!A0", "'=cmd|' /C calc'!A0"),
        ("+1 for dynamic", "'+1 for dynamic"),
        ("-1.5", "-1.5"),
        ("-1e-3", "-1e-3"),
        ("+7", "+7"),
        ("- it was fun", "'- it was fun"),
        ("@SUM(A1)", "'@SUM(A1)"),
        ("\t=1", "'\t=1"),
        ("'tis fine", "''tis fine"),
        ("fun = yes", "fun = yes"),
        ("", ""),
        ("-1.5\n=1", "'-1.5\n=1"),
    ],
)
def test_no_remark_is_a_formula_and_each_can_be_had_again(text, shown):
    assert harmless(text) == shown
    undone = shown[1:] if shown.startswith("'") else shown
    assert undone == text


def test_a_cell_of_any_length_is_read(tmp_path):
    """More than the 131,072 characters that Python's reader takes by itself."""
    record(tmp_path / "data", "P01", 1, remark="=" + "long " * 40_000)
    out = exported(tmp_path / "data", "wide", tmp_path / "out")
    csv.field_size_limit(2**31 - 1)
    with open(out / "wide.csv", encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert row["remarks"] == "'=" + "long " * 40_000
    assert len(load_study(tmp_path / "data").questionnaire) == 5
