"""The window under a real X server, driven by real key and mouse events."""

import csv
import itertools
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from desktop import Desktop, Program, wait_until

from experiment.config import load
from experiment.design import session_for

ARTEFACTS = Path(__file__).parents[2] / "out" / "ci"

STUDY = """
[study]
name = "window"
title = "A short session"
description = "One trial of each task, small scenes."
participants = 4
seed = 5
[design]
trials = 1
training = 0
[abstract]
side = 50.0
objects = 60
target_share = [0.3, 0.4]
[walkthrough]
grid = 6
objects = 8
count = [1, 3]
types = ["chair", "table", "cat"]
"""

START = 60  # s for a cold start on a busy machine: not a bound on speed
TRIAL = 40  # s for one trial on a busy machine


@pytest.fixture
def study_file(tmp_path):
    path = tmp_path / "window.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture
def desktop():
    with Desktop() as screen:
        yield screen


def rows(folder):
    (path,) = Path(folder).glob("data/human/P01/*_trials_data.csv")
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file)), path.read_text(encoding="utf-8")


def open_session(desktop, study_file, data):
    program = Program(
        desktop, study_file.with_suffix(".log"),
        "run", study_file, "--participant", "P01", "--data", data,
    )  # fmt: skip
    try:
        wait_until(lambda: has_window(desktop) or not program.running(), START, "the window")
        assert program.running(), program.said()
    except AssertionError:
        program.close()
        raise
    desktop.do("mousemove", 400, 300)
    return program


def has_window(desktop):
    search = ["xdotool", "search", "--onlyvisible", "--name", "A short session"]
    found = subprocess.run(search, env=desktop.env, capture_output=True, timeout=20)
    return found.returncode == 0


# What answers each task by keyboard alone. Return also goes on from the instruction page, and does
# nothing in a trial that has no answer yet, so the keys can be repeated until the trial ends.
KEYS = {
    "count": ["Return", "1", "9", "Return"],
    "pattern": ["Return", "k", "Return"],
    "unique": ["Return", "Up", "space", "Left", "Left", "Return"],
    "count_in_building": ["Return", "3", "Return"],
}


def answer(desktop, program, task, count):
    """Play one trial by keyboard until the program reports it."""
    end = time.monotonic() + TRIAL
    while program.trials() < count:
        assert time.monotonic() < end and program.running(), program.said()
        desktop.keys(*KEYS[task])


def trials_of(study_file):
    factors = load(str(study_file)).design.factors()
    return [t for task_set in session_for(1, factors) for t in task_set.trials]


def test_a_whole_short_session_by_keyboard_and_mouse(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data) as program:
        for number, trial in enumerate(trials_of(study_file), start=1):
            if trial.scenario == "abstract":
                drag(desktop)
            answer(desktop, program, trial.task, number)
            desktop.screenshot(ARTEFACTS / f"window-after-trial-{number}.png")
        fill_in_questionnaire(desktop, program)
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
    table, _ = rows(data)
    played = [(r["transparency"], r["task"]) for r in table]
    assert played == [(t.transparency, t.task) for t in trials_of(study_file)]
    assert all(float(r["time"]) > 0 and r["answer"] for r in table)
    assert {r["source"] for r in table} == {"human"}
    (questions,) = Path(data).glob("data/human/P01/*_questionnaire_data.csv")
    with open(questions, encoding="utf-8", newline="") as file:
        items = [r["item"] for r in csv.DictReader(file)]
    assert items == ["efficiency", "ease", "enjoy"] * 4 + ["preference", "depth_self_report"]


def drag(desktop):
    """Turn the abstract scene; on the instruction page before it, a drag does nothing."""
    desktop.keys("Return")
    desktop.do("mousemove", 300, 300)
    desktop.do("mousedown", 1)
    for _ in range(5):
        desktop.do("mousemove_relative", 20, 5)
    desktop.do("mouseup", 1)


def fill_in_questionnaire(desktop, program):
    """Every page by keyboard: arrows move, space chooses, Return goes on."""
    end = time.monotonic() + 2 * TRIAL
    for number in itertools.count():
        if not program.running():
            return
        assert time.monotonic() < end, program.said()
        if number == 4:
            desktop.screenshot(ARTEFACTS / "window-questionnaire.png")
        desktop.keys("Tab", "space", "Return")


def test_a_killed_session_keeps_every_completed_trial(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data) as program:
        for number, trial in enumerate(trials_of(study_file)[:2], start=1):
            answer(desktop, program, trial.task, number)
        desktop.keys("Return")  # the next trial begins
        traces = data / "data/human/P01/traces/session-1_trial-003_events.csv"
        wait_until(traces.exists, START, "the third trial")
        os.kill(program.process.pid, signal.SIGKILL)
        program.process.wait(10)
    table, text = rows(data)
    assert [r["trial"] for r in table] == ["1", "2"]
    assert text.endswith("\n") and len(text.splitlines()) == 3


def test_escape_asks_saves_and_leaves(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data) as program:
        answer(desktop, program, trials_of(study_file)[0].task, 1)
        traces = data / "data/human/P01/traces/session-1_trial-002_events.csv"
        while not traces.exists():
            desktop.keys("Return")
        desktop.keys("Escape", pause=0.5)
        desktop.screenshot(ARTEFACTS / "window-leave.png")
        desktop.keys("Tab", "Tab", "Return", pause=0.3)
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 1, program.said()
    assert len(rows(data)[0]) == 1
    (end,) = Path(data).glob("data/human/P01/*_end.json")
    assert '"status": "left"' in end.read_text(encoding="utf-8")
