"""`seethrough replay` in a window, under a real X server: the views that were shown, read-only."""

import os
import subprocess
import sys

import pytest
from desktop import Desktop, Program, wait_until
from player import START, has_window
from recorded_session import play_recorded
from xserver import XServer

TITLE = "Replay of count"
MIDDLE = (160, 120)  # of the window, whose upper left corner is the screen's


@pytest.fixture
def data(tmp_path):
    folder = tmp_path / "data"
    play_recorded(folder)
    return folder


def words(data):
    return ["replay", data, "--participant", "P01", "--trial", "1", "--speed", "0.5"]


def test_the_window_shows_the_trial_and_closes_at_its_end(data, tmp_path):
    before = {p: p.read_bytes() for p in data.rglob("*") if p.is_file()}
    with Desktop() as desktop, Program(desktop, tmp_path / "log", *words(data)) as program:
        server = XServer(desktop.env["DISPLAY"])
        empty = server.pixel(*MIDDLE)
        server.seen(*MIDDLE, lambda pixel: pixel != empty, START)
        assert has_window(desktop, TITLE)
        server.close()
        wait_until(lambda: not program.running(), START, "the end")
        assert program.process.returncode == 0 and program.said() == ""
    assert {p: p.read_bytes() for p in data.rglob("*") if p.is_file()} == before


def test_escape_leaves_it(data, tmp_path):
    with Desktop() as desktop, Program(desktop, tmp_path / "log", *words(data)) as program:
        wait_until(lambda: has_window(desktop, TITLE), START, "the window")
        wait_until(lambda: desktop.keys("Escape") or not program.running(), START, "the end")
        assert program.process.returncode == 0
        assert program.said() in ("left\n", "")  # the trial may end before the key comes


def test_without_a_desktop_it_is_one_line(data):
    env = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    command = [sys.executable, "-m", "seethrough", *map(str, words(data))]
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert done.stderr.startswith("seethrough: display: no window can be opened")
