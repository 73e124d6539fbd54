"""`seethrough simulate` and `power`: data mode to a report, and one line for bad input."""

import csv
import json

import pytest

from seethrough import api
from seethrough.experiment import cli
from seethrough.experiment.power import effects
from seethrough.experiment.study.config import load


def rows(folder):
    files = sorted(folder.glob("data/simulated/*/*_trials_data.csv"))
    texts = [file.read_text(encoding="utf-8").splitlines() for file in files]
    return [row for lines in texts for row in csv.DictReader(lines)]


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    return tmp_path_factory.mktemp("tables") / "demo.db"


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    monkeypatch.setattr("seethrough.experiment.people.runs.batch_files.CHUNK", 2)


def data_mode(tables, out, *more):
    words = ["simulate", "demo", "--mode", "data", "--pool", "1", "--tables", str(tables)]
    return cli.main([*words, "--out", str(out), *more])


def test_an_interrupted_run_goes_on_and_a_finished_one_is_left_alone(tables, tmp_path):
    out = tmp_path / "out"
    assert data_mode(tables, out, "--participants", "2") == 0
    first = rows(out)
    assert data_mode(tables, out, "--participants", "4") == 0
    assert rows(out)[: len(first)] == first and len(rows(out)) == 4 * 8


def test_data_mode_ends_in_a_report_that_says_what_it_is(tables, tmp_path):
    out = tmp_path / "out"
    assert data_mode(tables, out, "--participants", "2", "--without", "slips,people") == 0
    sidecar = json.loads(next(out.glob("data/simulated/*/*_trials_data.json")).read_text())
    assert sidecar["provenance"]["without"] == ["people", "slips"]
    assert "never evidence" in sidecar["mode"]
    assert cli.main(["report", str(out), "--out", str(tmp_path / "report")]) == 0
    text = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert "never evidence" in text and "Questionnaire" in text
    assert cli.main(["export", str(out), "--format", "wide", "--out", str(tmp_path / "w")]) == 0


def test_visual_mode_explains_its_effects(tmp_path, capsys):
    words = ["simulate", "demo", "--participants", "1", "--seed", "3", "--out", str(tmp_path / "v")]
    assert cli.main([*words, "--explain", "--without", "crowding", "--profile", "hasty"]) == 0
    told = capsys.readouterr().out
    assert told.count("left out by --without") == 8
    assert "no walking" in told and "nothing is counted" in told
    sidecar = json.loads(next(tmp_path.glob("v/data/simulated/S01/*_trials_data.json")).read_text())
    assert "hasty" in json.dumps(sidecar) and "crowding" in json.dumps(sidecar)


def test_two_workers_play_the_same_real_sessions_as_one(tmp_path):
    """Byte for byte but for when they were recorded."""
    told = {}
    for workers in ("1", "2"):
        out = tmp_path / workers
        words = ["simulate", "demo", "--participants", "2", "--workers", workers]
        assert cli.main([*words, "--out", str(out)]) == 0
        told[workers] = [
            {k: v for k, v in row.items() if k not in ("started", "chain")} for row in rows(out)
        ]
        traces = sorted(out.glob("data/simulated/*/traces/*"))
        told[workers].append([(path.name, path.read_bytes()) for path in traces])
    assert told["1"] == told["2"] and len(told["1"]) == 2 * 8 + 1


def test_power_from_the_paper_and_from_simulated_people(tables, tmp_path, capsys):
    page = tmp_path / "p.html"
    words = ["--participants", "8..12", "--replications", "50", "--out", str(page)]
    assert cli.main(["power", "published", "--effect", "published", *words]) == 0
    assert "completion time overall" in capsys.readouterr().out
    text = page.read_text(encoding="utf-8")
    assert "<svg" in text and "A plan, no evidence" in text and "never evidence" not in text
    out = tmp_path / "people"
    assert data_mode(tables, out, "--participants", "4") == 0
    assert cli.main(["power", "demo", "--effect", str(out), *words]) == 0
    said = capsys.readouterr().out
    assert "drawn: 4 simulated participants of people" in said
    text = page.read_text(encoding="utf-8")
    assert "never evidence" in text and text.index("Drawn.") < text.index("<svg")
    assert cli.main(["power", "published", "--effect", str(out), *words]) == 2
    assert f"--effect = {out}: expected data of this study" in capsys.readouterr().err


def test_power_asks_what_the_report_asks(tables, tmp_path):
    """The people as they are: every test's p is the one that their report prints."""
    out = tmp_path / "people"
    assert data_mode(tables, out, "--participants", "6") == 0
    study = load("demo")
    effect = effects.effect_of(study, str(out), None, None)
    mine = effects.decisions(effect)
    printed = api.results(out)
    for mine_of, table, row, column in (
        ("completion time overall", "tests_log_time", "time_overall", "p"),
        ("relative error overall", "tests_count_error", "count_error_overall", "p"),
        ("distance T3 unique", "tests_distance", "distance_unique", "p"),
        ("right answers T1 count", "friedman_correct", "correct_count", "p_exact"),
    ):
        expected = printed[table].loc[row, column]
        if expected == expected:  # what the report cannot test is 1 here
            assert mine[mine_of] == pytest.approx(expected, rel=1e-9)
    assert mine["completion time overall"] < 1


@pytest.mark.parametrize(
    "words, message",
    [
        ("simulate demo --out {t}/x --participants 0", "--participants = 0: expected at least 1"),
        ("simulate demo --out {t}/x --without gravity", "--without = gravity: expected some of"),
        ("simulate demo --out {t}/x --profile hero", "--profile = hero: expected one of average"),
        ("simulate demo --out {t}/x --mode data --pool 0", "--pool = 0: expected at least 1 scene"),
        ("simulate demo --out {t}/x --mode data --workers 0", "--workers = 0: expected a number"),
        ("simulate demo --out {t}/x --workers 0", "--workers = 0: expected a number from 1"),
        ("simulate demo --out {t}/x --workers 2 --explain", "expected with one worker"),
        ("simulate demo --out {t}/x --scheduler tcp://h:1", "expected with --mode data only"),
        ("simulate demo --out {t}/x --mode data --scheduler tcp://h:1 --workers 2",
         "--workers and --scheduler: expected one of them"),
        ("simulate demo --out {t}/x --mode data --watch", "--explain and --watch: expected with"),
        ("simulate demo --out {t}/x --mode data --explain", "--explain and --watch: expected with"),
        ("power published --out {t}/p.html --participants 1..4",
         "--participants = 1..4: expected A..B"),
        ("power published --out {t}/p.html --participants many",
         "--participants = many: expected A..B"),
        ("power published --out {t}/p.html --replications 3",
         "--replications = 3: expected a number"),
        ("power published --out {t}/p.html", "--effect: expected \"PREDICTION=0.2 sd\", published"),
        ("power published --out {t}/p.html --effect {t}/nix", "published, or a data folder"),
        ("calibrate published --out {t}/c --tables {t}/t --participants 2",
         "--participants = 2: expected at least 3"),
        ("calibrate published --out {t}/c --tables {t}/t --last 2",
         "--last = 2: expected at least 3"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_status_2(tmp_path, capsys, words, message):
    assert cli.main(words.format(t=tmp_path).split(" ")) == 2
    told = capsys.readouterr().err
    assert message in told and told.count("\n") == 1


def test_a_folder_of_another_study_is_refused(tables, tmp_path, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / "dataset_description.json").write_text('{"name": "other"}')
    assert data_mode(tables, out, "--participants", "2") == 2
    assert "name = 'other': expected 'demo'; choose another folder" in capsys.readouterr().err


def test_people_are_put_among_no_other_things(tables, tmp_path, capsys):
    """What is there stays as it is, in either mode."""
    (tmp_path / "notes.txt").write_text("mine")
    words = ["simulate", "demo", "--participants", "1", "--out"]
    expected = (
        f"seethrough: --out = {tmp_path}: holds notes.txt, which no study recorded: expected a new "
        "or empty folder, or a study's data\n"
    )
    assert cli.main([*words, str(tmp_path)]) == data_mode(tables, tmp_path) == 2
    assert capsys.readouterr().err == 2 * expected
    assert cli.main([*words, str(tmp_path / "notes.txt")]) == 2
    assert "expected a folder, it is a file" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["notes.txt"]


def test_each_mode_has_folders_of_its_own(tables, tmp_path, capsys):
    assert data_mode(tables, tmp_path / "data", "--participants", "2") == 0
    words = ["simulate", "demo", "--participants", "1", "--out"]
    before = rows(tmp_path / "data")
    assert cli.main([*words, str(tmp_path / "data")]) == 2
    assert "holds S00001-S00002 of data mode: visual mode expects" in capsys.readouterr().err
    assert rows(tmp_path / "data") == before
    # What a check or a ledger may have put there before is no other thing.
    (tmp_path / "drawn").mkdir()
    (tmp_path / "drawn" / "certificate.csv").write_text("")
    assert cli.main([*words, str(tmp_path / "drawn")]) == 0
    assert cli.main([*words, str(tmp_path / "drawn")]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == (
        f"seethrough: --out = {tmp_path / 'drawn'}: holds S01 already, who are never played twice: "
        "expected a folder without them"
    )
