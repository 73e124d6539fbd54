"""Plays a whole session in the window by real key and mouse events."""

import itertools
import subprocess
import time
from pathlib import Path

from desktop import Program, wait_until

from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import session_for

ARTEFACTS = Path(__file__).parents[2] / "out" / "ci"
START = 60  # s for a cold start on a busy machine: not a bound on speed
TRIAL = 60  # s for one trial on a busy machine

# What answers each task by keyboard alone. Return also goes on from a page, and does nothing in a
# trial that has no answer yet, so the keys can be repeated until the trial ends.
KEYS = {
    "count": ["Return", "1", "9", "Return"],
    "pattern": ["Return", "k", "Return"],
    "unique": ["Return", "Up", "space", "Left", "Left", "Return"],
    "count_in_building": ["Return", "3", "Return"],
}
# What fills in a page of scales: arrows and Tab move, space chooses, Return goes on.
PAGE = [*["Down", "space"] * 3, "Tab", "Return"]


def trials_of(study_file, slot=1):
    """The slot's trials, training left out."""
    factors = load(str(study_file)).plan
    return [t for task_set in session_for(slot, factors) for t in task_set.trials]


def has_window(desktop, title):
    """Whether a window with that title is on the screen."""
    search = ["xdotool", "search", "--onlyvisible", "--name", title]
    return subprocess.run(search, env=desktop.env, capture_output=True, timeout=20).returncode == 0


def open_session(desktop, study_file, data, title, *words, **how):
    """Start participant P01's session and wait for its window; `how` as Program takes it."""
    log = data.with_suffix(f".{len(list(data.parent.glob('*.log')))}.log")
    command = ["run", study_file, "--participant", "P01", "--data", data, *words]
    program = Program(desktop, log, *command, **how)
    try:
        shown = lambda: has_window(desktop, title) or not program.running()  # noqa: E731
        wait_until(shown, START, "the window")
        assert program.running(), program.said()
    except AssertionError:
        program.close()
        raise
    desktop.do("mousemove", 400, 300)
    return program


def answer(desktop, program, task, count):
    """Play one trial by keyboard until the program has reported `count` of them."""
    end = time.monotonic() + TRIAL
    while program.trials() < count:
        assert time.monotonic() < end and program.running(), program.said()
        desktop.keys(*KEYS[task])


def drag(desktop):
    """Turn the abstract scene; on a page, a drag does nothing."""
    desktop.keys("Return")
    desktop.do("mousemove", 300, 300)
    desktop.do("mousedown", 1)
    for _ in range(5):
        desktop.do("mousemove_relative", 20, 5)
    desktop.do("mouseup", 1)


def fill_in(desktop, program, seconds=2 * TRIAL, screenshot=None):
    """Pages to the end by keyboard."""
    end = time.monotonic() + seconds
    for number in itertools.count():
        if not program.running():
            return
        if time.monotonic() > end:
            desktop.screenshot(ARTEFACTS / "window-stuck.png")
            raise AssertionError(program.said())
        if number == 1 and screenshot is not None:
            desktop.screenshot(screenshot)
        desktop.keys(*PAGE)
