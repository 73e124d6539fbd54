"""Watching a simulated participant in the window, under a real X server."""

import csv

import pytest
from desktop import Desktop, Program, wait_until
from player import ARTEFACTS, START, has_window
from small_study import SMALL

from seethrough.experiment.study.config import load

TITLE = load("demo").general.title


@pytest.fixture
def desktop():
    with Desktop() as screen:
        yield screen


def test_watched_at_real_speed_until_escape(desktop, tmp_path):
    """Its pointer moves, its events are recorded as they happen, and Esc ends the watching."""
    study = tmp_path / "watched.toml"
    study.write_text(SMALL, encoding="utf-8")
    data = tmp_path / "data"
    words = ["simulate", study, "--watch", "--participants", "1", "--seed", "3", "--out", data]
    program = Program(desktop, tmp_path / "watch.log", *words)
    try:
        wait_until(lambda: has_window(desktop, "Small"), START, "the window")
        traces = data / "data" / "simulated" / "S01" / "traces"
        wait_until(lambda: list(traces.glob("*_trial-001_events.csv")), START, "the first trial")
        desktop.screenshot(ARTEFACTS / "watched.png")
        desktop.keys("Escape")
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
        assert "Traceback" not in program.said()
    finally:
        program.close()
    (events,) = traces.glob("*_trial-001_events.csv")
    assert events.read_text(encoding="utf-8").startswith("time,event,")
    (end,) = data.glob("data/simulated/S01/*_end.json")
    assert '"status": "left"' in end.read_text(encoding="utf-8")


def test_the_simulated_demo_plays_to_its_end_and_reports(desktop, tmp_path):
    """At 60 times the speed: what is watched is the same session, with its report at the end."""
    out = tmp_path / "demo"
    words = ["demo", "--simulated", "--speed", "60", "--no-open", "--out", out]
    program = Program(desktop, tmp_path / "demo.log", *words)
    try:
        wait_until(lambda: has_window(desktop, TITLE), START, "the window")
        wait_until(lambda: program.trials() >= 1, START, "the first trial")
        desktop.screenshot(ARTEFACTS / "demo-simulated.png")
        wait_until(lambda: not program.running(), 4 * START, "the end")
        assert program.process.returncode == 0, program.said()
    finally:
        program.close()
    assert "session complete; report: " in program.said()
    (table,) = out.glob("data/data/simulated/S01/*_trials_data.csv")
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 8 and {row["source"] for row in rows} == {"simulated"}
    assert "never evidence" in (out / "report" / "report.html").read_text(encoding="utf-8")
