"""Data mode's results on disk: whole chunks, none twice, none missing, and the same in Parquet."""

import csv
import json

import fastparquet
import pytest

from seethrough.analysis.load.study import load_study
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.runs.batch import Batch
from seethrough.experiment.people.runs.batch_files import NAME, Results, render
from seethrough.experiment.people.runs.data_mode import Played
from seethrough.experiment.record.chain import verify
from seethrough.experiment.study.config import load

JOB = Batch("demo", 1, 2)
STUDY = load("demo")


def played(slot):
    """A person with one trial and one answer."""
    who = {"study": "demo", "participant": f"S{slot:02d}", "session": 1, "source": "simulated"}
    trial = {
        **who, "row_id": f"simulated-S{slot:02d}-1-trial001", "slot": slot, "trial": 1, "block": 1,
        "task_set": 1, "trial_in_set": 1, "attempt": 1, "transparency": "dynamic",
        "scenario": "abstract", "task": "count", "scene": 'a "b", c', "targets": 9, "answer": "8",
        "truth": "9", "correct": False, "count_error": -1, "time": 0.1 + slot, "time_clean": 1.5,
        "timed_out": False, "frames": 3,
    }  # fmt: skip
    question = {**who, "row_id": f"simulated-S{slot:02d}-1-question001", "item": "ease",
                "transparency": "dynamic", "scenario": "abstract", "value": "3"}  # fmt: skip
    return Played("demo", f"S{slot:02d}", slot, trials=[trial], questions=[question],
                  status="complete")  # fmt: skip


def fill(out, count, job=JOB):
    """Simulate, so to say, what the folder lacks; the chunks that were written."""
    about = job.about(STUDY)
    with Results(out, STUDY, about) as results:
        chunks = results.missing(range(1, count + 1))
        for slots in chunks:
            results.add(render(about, STUDY, slots, [played(s) for s in slots]))
    return chunks


def parquet(path):
    """The rows, by a reader that shares no code with the writer."""
    with open(path, "rb") as file:
        return fastparquet.ParquetFile(file).to_pandas()


def test_a_folder_grows_by_what_it_lacks(tmp_path):
    assert fill(tmp_path, 20) == [tuple(range(1, 17)), (17, 18, 19, 20)]
    assert fill(tmp_path, 20) == []
    assert fill(tmp_path, 7) == []
    assert fill(tmp_path, 40) == [tuple(range(21, 33)), tuple(range(33, 41))]
    trials = load_study(tmp_path).trials
    assert sorted(trials["slot"]) == list(range(1, 41))
    assert len(set(trials["row_id"])) == 40


def test_a_chunk_that_was_lost_in_the_middle_is_made_again(tmp_path):
    fill(tmp_path, 40)
    lost = tmp_path / "data" / "simulated" / "S00017-S00032"
    for file in lost.iterdir():
        file.unlink()
    lost.rmdir()
    (tmp_path / "unfinished" / "S00017-S00032").mkdir(parents=True)
    (tmp_path / "unfinished" / "S00017-S00032" / "half_trials_data.csv").write_text("row_")
    assert fill(tmp_path, 40) == [tuple(range(17, 33))]
    assert not (tmp_path / "unfinished").exists()
    assert len(load_study(tmp_path).trials) == 40


def test_the_chain_holds_and_a_changed_digit_breaks_it(tmp_path):
    fill(tmp_path, 3)
    (folder,) = (tmp_path / "data" / "simulated").iterdir()
    assert NAME.fullmatch(folder.name)
    assert load_study(tmp_path).chains[0].state == "verified"
    assert verify(folder) == []
    (table,) = folder.glob("*_trials_data.csv")
    table.write_text(table.read_text().replace("2.1,", "2.2,", 1))
    with pytest.raises(Exception, match="row 3: changed"):
        load_study(tmp_path)
    table.write_text(table.read_text().replace("2.2,", "2.1,", 1))
    (end,) = folder.glob("*_end.json")
    end.unlink()  # a chunk's folder is whole, or it is not there
    with pytest.raises(Exception, match=r"_end\.json: missing: expected in a folder of data mode"):
        load_study(tmp_path)


def test_bids_takes_rows_that_do_not_say_when_they_began(tmp_path):
    fill(tmp_path / "d", 3)
    out = tmp_path / "bids"
    words = ["export", str(tmp_path / "d"), "--format", "bids", "--out", str(out)]
    assert cli.main(words) == 0
    for slot in (1, 2, 3):
        folder = out / f"sub-S{slot:02d}" / "ses-1" / "beh"
        (table,) = folder.glob("*_events.tsv")
        (row,) = csv.DictReader(table.read_text("utf-8").splitlines(), delimiter="\t")
        assert row["onset"] == "n/a" and float(row["duration"]) == 0.1 + slot


def test_parquet_holds_the_same_rows_with_types(tmp_path):
    fill(tmp_path, 18)
    for table, number in (("trials", "time"), ("questionnaire", "value")):
        lines = [
            line
            for path in sorted(tmp_path.glob(f"data/simulated/*/*_{table}_data.csv"))
            for line in csv.DictReader(path.read_text().splitlines())
        ]
        rows = []
        for path in sorted((tmp_path / "parquet" / table).iterdir()):
            rows += parquet(path).to_dict("records")
        assert [r["row_id"] for r in rows] == [line["row_id"] for line in lines]
        assert [r[number] for r in rows] == [float(line[number]) for line in lines]
    trials = parquet(tmp_path / "parquet" / "trials" / "S00017-S00018.parquet")
    assert trials["scene"].tolist() == ['a "b", c'] * 2
    assert trials["correct"].tolist() == [False, False]


def test_parquet_files_of_a_chunk_that_never_appeared_are_removed(tmp_path, monkeypatch):
    """Killed after its Parquet files and before its folder; gone on with for more people."""
    monkeypatch.setattr("pathlib.Path.rename", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        fill(tmp_path, 3)
    monkeypatch.undo()
    assert (tmp_path / "parquet" / "trials" / "S00001-S00003.parquet").exists()
    mine = tmp_path / "parquet" / "trials" / "mine.parquet"
    mine.write_bytes(b"")
    fill(tmp_path, 5)
    mine.unlink()
    for table in ("trials", "questionnaire"):
        files = list((tmp_path / "parquet" / table).iterdir())
        assert [f.name for f in files] == ["S00001-S00005.parquet"]
        assert len(parquet(files[0])) == 5


def test_chunks_made_without_duckdb_get_their_parquet_files_later(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "duckdb", None)
    fill(tmp_path, 2)
    assert not (tmp_path / "parquet").exists()
    monkeypatch.undo()
    fill(tmp_path, 3)
    for table in ("trials", "questionnaire"):
        files = sorted((tmp_path / "parquet" / table).iterdir())
        assert [f.stem for f in files] == ["S00001-S00002", "S00003-S00003"]
        assert [len(parquet(f)) for f in files] == [2, 1]
    assert not (tmp_path / "unfinished").exists()


NO_SIDECAR = {
    "[1]": "expected a JSON object",
    "{}": "provenance: missing: expected a JSON object",
    '{"provenance": 3}': "provenance = 3: expected a JSON object",
    "{": "not JSON",
    "": "not JSON",
}


@pytest.mark.parametrize("text", NO_SIDECAR)
def test_a_sidecar_that_is_no_json_object_is_refused_in_a_line(tmp_path, text):
    fill(tmp_path, 1)
    (sidecar,) = tmp_path.glob("data/simulated/*/*_trials_data.json")
    sidecar.write_text(text)
    with pytest.raises(InputError, match=f"trials_data.json: {NO_SIDECAR[text]}"):
        fill(tmp_path, 2)


def test_without_duckdb_a_line_says_so_and_csv_is_written(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "duckdb", None)
    with Results(tmp_path, STUDY, JOB.about(STUDY)) as results:
        assert "pip install 'seethrough[parquet]'" in results.note
        results.add(render(JOB.about(STUDY), STUDY, (1,), [played(1)]))
    assert len(load_study(tmp_path).trials) == 1 and not (tmp_path / "parquet").exists()


def test_folders_of_others_are_refused_in_a_line(tmp_path):
    fill(tmp_path / "a", 1)
    for job, message in (
        (Batch("demo", 2, 2), r"simulated with another simulation_seed: 1, expected 2"),
        (Batch("demo", 1, 3), r"simulated with another pool: 2, expected 3"),
        (Batch("demo", 1, 2, without=frozenset({"slips"})), r"with another without: \[\], expecte"),
    ):
        with pytest.raises(InputError, match=message) as error:
            fill(tmp_path / "a", 1, job)
        assert "\n" not in str(error.value)
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "dataset_description.json").write_text('{"name": "other"}')
    with pytest.raises(InputError, match=r"name = 'other': expected 'demo'; choose another"):
        fill(tmp_path / "b", 1)
    (tmp_path / "c" / "data" / "simulated" / "S01").mkdir(parents=True)
    with pytest.raises(InputError, match=r"holds S01 of visual mode: data mode expects a folder"):
        fill(tmp_path / "c", 1)


def test_who_stopped_early_is_named(tmp_path):
    late = played(2)
    late.status = "time limit"
    about = JOB.about(STUDY)
    chunk = render(about, STUDY, (1, 2), [played(1), late])
    (end,) = [json.loads(text) for name, text in chunk.texts.items() if name.endswith("_end.json")]
    assert end["status"] == "time limit" and end["early"] == {"S02": "time limit"}
    for statuses, said in (
        (("complete", "complete"), "complete"),
        (("left", "complete"), "left"),
        (("time limit", "left"), "left, time limit"),
    ):
        people = [played(1), played(2)]
        for person, status in zip(people, statuses, strict=True):
            person.status = status
        texts = render(about, STUDY, (1, 2), people).texts
        (end,) = [json.loads(text) for name, text in texts.items() if name.endswith("_end.json")]
        assert end["status"] == said
