"""A study end to end: simulated, recorded, reported, from the commands a researcher types."""

import csv
import json
import subprocess
import sys
from collections import Counter

import pytest

from seethrough.experiment import cli
from seethrough.experiment.replay.replayer import find_trial, replay
from seethrough.experiment.study.config import load

PARTICIPANTS = 4  # one pass through the Latin square


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "data"
    words = ["--participants", str(PARTICIPANTS), "--seed", "3", "--out", str(folder)]
    assert cli.main(["simulate", "demo", *words]) == 0
    return folder


def tables(data, name):
    rows = []
    for path in sorted(data.glob(f"data/simulated/*/*_{name}_data.csv")):
        with open(path, encoding="utf-8", newline="") as file:
            rows += list(csv.DictReader(file))
    return rows


def test_every_participant_completes_every_trial_of_the_design(data):
    rows = tables(data, "trials")
    assert len(rows) == PARTICIPANTS * 8
    assert len({r["row_id"] for r in rows}) == len(rows)
    cells = Counter((r["transparency"], r["task"]) for r in rows)
    assert len(cells) == 8 and set(cells.values()) == {PARTICIPANTS}
    assert {r["source"] for r in rows} == {"simulated"}
    assert all(r["answer"] and 0 < float(r["time"]) < 1000 for r in rows)
    # Each condition stands once at each position over one pass through the square.
    places = Counter((r["block"], r["transparency"], r["scenario"]) for r in rows)
    assert len(places) == 16 and len(set(places.values())) == 1


def test_simulated_participants_see_and_are_mostly_right(data):
    rows = tables(data, "trials")
    letters = [r for r in rows if r["task"] == "pattern"]
    # By guessing among five letters, six of eight right would come in under 1 of 800 runs.
    assert sum(r["correct"] == "true" for r in letters) >= 6
    counts = [r for r in rows if r["task"] == "count"]
    error = sum(abs(int(r["count_error"])) for r in counts) / sum(int(r["truth"]) for r in counts)
    assert error < 0.25


def test_traces_and_sidecars_lie_beside_the_tables(data):
    for path in data.glob("data/simulated/*/*_trials_data.csv"):
        about = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
        assert about["provenance"]["study_sha256"] == load("demo").digest()
        with open(path, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                assert (path.parent / row["events_file"]).stat().st_size > 0
                assert (path.parent / row["camera_file"]).stat().st_size > 0


def test_every_trace_of_a_simulated_session_can_be_replayed(data):
    for row in tables(data, "trials"):
        recorded = find_trial(data, row["participant"], int(row["trial"]))
        frames = list(replay(recorded))
        assert frames[-1].time - frames[0].time == pytest.approx(float(row["time"]), abs=1e-6)


def test_the_report_is_made_from_the_folder_alone_and_says_that_nobody_was_there(data, tmp_path):
    out = tmp_path / "report"
    command = [sys.executable, "-m", "seethrough", "report", str(data), "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "simulated" in page.lower() and "never evidence" in page.lower()
    assert list((out / "tables").glob("*.csv")) and list((out / "figures").glob("*.svg"))


def test_the_same_seed_plays_the_same_session(data, tmp_path):
    again = tmp_path / "again"
    words = ["--participants", "1", "--seed", "3", "--out", str(again)]
    assert cli.main(["simulate", "demo", *words]) == 0

    def kept(folder):
        return [
            {k: v for k, v in row.items() if k not in ("started", "chain")}
            for row in tables(folder, "trials")
            if row["participant"] == "S01"
        ]

    assert kept(again) == kept(data)


def test_simulating_into_the_same_folder_is_refused_and_changes_nothing(data, capsys):
    before = {p: p.read_bytes() for p in data.rglob("*") if p.is_file()}
    assert cli.main(["simulate", "demo", "--participants", "1", "--out", str(data)]) == 2
    message = capsys.readouterr().err.strip().splitlines()[-1]
    assert "S01" in message and "already, who are never played twice" in message
    assert {p: p.read_bytes() for p in data.rglob("*") if p.is_file()} == before


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["simulate", "nothing.toml", "--out", "x"], "nothing.toml: no such file"),
        (["simulate", "demo", "--participants", "0", "--out", "x"], "--participants = 0: expected"),
        (["simulate", "demo", "--seed", "-1", "--out", "x"], "--seed = -1: expected"),
        (["run", "demo", "--participant", "../x"], "--participant = '../x': expected 1 to 32"),
        (["check", "nowhere"], "nowhere: no such file"),
    ],
)
def test_bad_input_is_one_line_and_status_2(words, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(words) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith("seethrough: ")
    assert message in said.err and said.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_help_imports_none_of_the_heavy_packages():
    code = (
        "import sys\nfrom seethrough.experiment.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'numba', 'scipy', 'pandas', 'matplotlib', 'statsmodels', 'pyglet'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip().endswith("[]")


def test_the_demo_without_a_display_plays_and_reports(tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    out = tmp_path / "demo"
    command = [sys.executable, "-m", "seethrough", "demo", "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip().splitlines()[-1].endswith("report.html")
    assert (out / "report" / "report.html").exists()
