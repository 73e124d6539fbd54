"""The window under a real X server, driven by real key and mouse events."""

import csv
import os
import re
import signal
import sys
from pathlib import Path

import pytest
from desktop import Desktop, Program, wait_until
from player import ARTEFACTS, PAGE, START, answer, drag, fill_in, open_session, trials_of

from seethrough.experiment import cli

TITLE = "A short session"
STUDY = f"""
[study]
name = "window"
title = "{TITLE}"
description = "One trial of each task, small scenes."
participants = 4
seed = 5
[design]
trials = 1
[factors.transparency]
levels.standard = {{ technique.use = "standard" }}
levels.dynamic = {{ technique.use = "dynamic" }}
[factors.scenario]
levels.abstract = {{ world.use = "abstract", design.tasks = ["count", "pattern"] }}
levels.walkthrough = {{ world.use = "building", design.tasks = ["unique", "count_in_building"] }}
[world.abstract]
side = 50.0
objects = 60
target_share = [0.3, 0.4]
[world.building]
grid = 6
objects = 8
count = [1, 3]
types = ["chair", "table", "cat"]
[practice]
trials = 0
[questions] # in this order
ratings = {{ when = "end", each = ["transparency", "scenario"] }}
comparison = {{ when = "end", of = "transparency" }}
remarks = {{ when = "end" }}
"""


# Enter is pressed and released while the page's first frame is drawn, and again in its tenth.
# Python's garbage is not searched for in a trial, where it would cost a frame, but on pages.
HASTY = """
import gc
from pyglet.window import key
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.study.config import load
from seethrough.experiment.pages.pages import Page
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.display.window import Window

window = Window(load("demo").display, Texts("en"), RealClock(), "hasty")
frames = 0

def frame():
    global frames
    frames += 1
    if frames in (1, 10):
        window.on_key_press(key.RETURN, 0)
    if frames in (2, 11):
        window.on_key_release(key.RETURN, 0)

window.begin_trial("count", False)
paused = not gc.isenabled()
window.on_frame = frame
window.ask(Page("welcome", "welcome.title"))
print("answered after", frames, paused and gc.isenabled())
window.close()
"""


@pytest.fixture
def study_file(tmp_path):
    path = tmp_path / "window.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture
def desktop():
    with Desktop() as screen:
        yield screen


def rows(folder, name="trials"):
    """Every row of P01's tables of a name, in the order of the sessions."""
    found = []
    for path in sorted(Path(folder).glob(f"data/human/P01/*_{name}_data.csv")):
        text = path.read_text(encoding="utf-8")
        assert text.endswith("\n")
        found += list(csv.DictReader(text.splitlines()))
    return found


def answers(folder):
    """Every row of P01's questionnaires."""
    return rows(folder, "questionnaire")


def test_a_whole_short_session_by_keyboard_and_mouse(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data, TITLE) as program:
        for number, trial in enumerate(trials_of(study_file), start=1):
            if trial.world == "abstract":
                drag(desktop)
            answer(desktop, program, trial.task, number)
            desktop.screenshot(ARTEFACTS / f"window-after-trial-{number}.png")
        fill_in(desktop, program, screenshot=ARTEFACTS / "window-questionnaire.png")
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
    table = rows(data)
    played = [(r["transparency"], r["task"]) for r in table]
    assert played == [(t.levels["transparency"], t.task) for t in trials_of(study_file)]
    assert all(float(r["time"]) > 0 and r["answer"] for r in table)
    assert {r["source"] for r in table} == {"human"}
    (questions,) = Path(data).glob("data/human/P01/*_questionnaire_data.csv")
    with open(questions, encoding="utf-8", newline="") as file:
        items = [r["item"] for r in csv.DictReader(file)]
    assert items[:14] == ["efficiency", "ease", "enjoy"] * 4 + ["preference", "depth_self_report"]


def test_killed_three_times_gone_on_with_verified_and_reported(
    desktop, study_file, tmp_path, capsys
):
    data = tmp_path / "data"
    trials = trials_of(study_file)
    for kept in (3, 5):
        with open_session(desktop, study_file, data, TITLE) as program:
            # The session goes on at its block's start: two trials make a block here.
            begin = {3: 0, 5: 2}[kept]
            for number, trial in enumerate(trials[begin:kept], start=1):
                answer(desktop, program, trial.task, number)
            session = {3: 1, 5: 2}[kept]
            name = f"session-{session}_trial-{kept + 1:03d}_events.csv"
            traces = data / "data/human/P01/traces" / name
            begun = lambda: desktop.keys("Return") or traces.exists()  # noqa: B023, E731
            wait_until(begun, START, "the next trial")
            os.kill(program.process.pid, signal.SIGKILL)
            program.process.wait(10)
        assert [int(r["trial"]) for r in rows(data)][-1] == kept
    with open_session(desktop, study_file, data, TITLE) as program:
        for number, trial in enumerate(trials[4:], start=1):
            answer(desktop, program, trial.task, number)
        rate = lambda: desktop.keys(*PAGE) or len(answers(data)) >= 6  # noqa: E731
        wait_until(rate, START, "two pages of answers")
        os.kill(program.process.pid, signal.SIGKILL)
        program.process.wait(10)
    before = answers(data)
    with open_session(desktop, study_file, data, TITLE) as program:
        fill_in(desktop, program)
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0, program.said()
    # What was answered when it was killed stands, and the rest is asked once.
    given = answers(data)
    assert given[: len(before)] == before and len(before) < len(given)
    items = [(r["item"], r["transparency"], r["scenario"]) for r in given]
    assert len(items) == len(set(items)) and items.count(("preference", "", "")) == 1
    table = rows(data)
    assert [int(r["trial"]) for r in table] == [1, 2, 3, 3, 4, 5, 5, 6, 7, 8]
    assert [r["attempt"] for r in table] == ["1", "1", "1", "2", "1", "1", "2", "1", "1", "1"]
    for number in range(1, 9):
        words = ["replay", str(data), "--participant", "P01", "--trial", str(number), "--verify"]
        assert cli.main(words) == 0, capsys.readouterr().out
    assert cli.main(["report", str(data), "--out", str(tmp_path / "report")]) == 0
    assert (tmp_path / "report" / "report.html").exists()


def test_keys_from_before_a_page_is_seen_do_not_answer_it(desktop, tmp_path):
    with Program(desktop, tmp_path / "log", start=(sys.executable, "-c", HASTY)) as program:
        wait_until(lambda: not program.running(), START, "the end")
        assert re.fullmatch(r"answered after 1[1-9] True\n", program.said()), program.said()


def test_escape_asks_saves_and_leaves(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data, TITLE) as program:
        answer(desktop, program, trials_of(study_file)[0].task, 1)
        traces = data / "data/human/P01/traces/session-1_trial-002_events.csv"
        while not traces.exists():
            desktop.keys("Return")
        desktop.keys("Escape", pause=0.5)
        desktop.screenshot(ARTEFACTS / "window-leave.png")
        desktop.keys("Tab", "Tab", "Return", pause=0.3)
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 1, program.said()
    assert len(rows(data)) == 1
    (end,) = Path(data).glob("data/human/P01/*_end.json")
    assert '"status": "left"' in end.read_text(encoding="utf-8")


def test_a_window_closed_by_the_desktop_saves_and_leaves(desktop, study_file, tmp_path):
    data = tmp_path / "data"
    with open_session(desktop, study_file, data, TITLE) as program:
        answer(desktop, program, trials_of(study_file)[0].task, 1)
        desktop.close_window(TITLE)
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 1, program.said()
    assert len(rows(data)) == 1
    assert "Traceback" not in program.said()
