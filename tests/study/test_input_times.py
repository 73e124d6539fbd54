"""Answers at known times in a real window: what is recorded is when they were given.

Keys are real events of the X server (XTest), and the first frame is seen on its screen, by a client
of its own. Both are known to within the two readings of the clock around them, which a busy machine
sets apart; what is recorded must lie between those, give or take what is stated below.
"""

import csv
import json
import subprocess
import time

import pytest
from desktop import Desktop, wait_until
from player import START, TRIAL, open_session, trials_of
from small_study import small_study
from xserver import XServer

TITLE = "Known times"
STUDY = small_study(TITLE, "Four short trials.")
PERIOD = 1 / 60  # s: "right to one frame"
STAMP = 0.002  # s: X11 counts whole milliseconds, and ours is rounded to one
PAPER = bytes((250, 247, 247))  # a page's, as blue, green, red: 0.98, 0.97, 0.97
CORNER = (3, 3)  # a page's paper or a view's background
# From the frame that is seen to the first key, in s: incommensurable with the frames.
THINKING = (0.3137, 0.7619, 1.2391, 0.5273)
NO_WINDOW = 0  # X11's None: nobody has the focus
AWAY = 0.4391  # s without it
APART = 0.0713  # s between an answer's keys: not a whole number of frames either


def is_page(pixel):
    return all(abs(a - b) < 3 for a, b in zip(pixel, PAPER, strict=True))


def play(server, trials, window):
    """Answer every trial; for each the brackets of its first frame, focus lost and had, two keys.

    In the last, another window has the focus for a while.
    """
    brackets = []
    server.focus(window)
    for trial, thinking in zip(trials, THINKING, strict=True):
        server.seen(*CORNER, is_page, TRIAL)
        first = begin(server)
        time.sleep(thinking)
        away = None
        if trial is trials[-1]:
            lost = server.focus(NO_WINDOW)
            time.sleep(AWAY)
            away = lost, server.focus(window)
            time.sleep(APART)
        answer = server.key("3" if trial.task == "count" else "k")
        time.sleep(APART)
        brackets.append((first, away, answer, server.key("Return")))
    return brackets


def begin(server):
    """Go on from pages until a view is on the screen: when its first frame was seen."""
    end = time.monotonic() + TRIAL
    while time.monotonic() < end:
        # A key that comes before a page is seen is not meant for it, and does nothing.
        server.key("Return")
        try:
            return server.seen(*CORNER, lambda pixel: not is_page(pixel), 0.7)
        except AssertionError:
            continue
    raise AssertionError("no trial began")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("times")


@pytest.fixture(scope="module")
def played(folder):
    """(brackets, row, events) of each trial: what was done, and what was recorded of it."""
    study = folder / "times.toml"
    study.write_text(STUDY, encoding="utf-8")
    with Desktop() as desktop, open_session(desktop, study, folder / "data", TITLE) as program:
        server = XServer(desktop.env["DISPLAY"])
        search = ["xdotool", "search", "--onlyvisible", "--name", TITLE]
        found = subprocess.run(search, env=desktop.env, capture_output=True, check=True)
        brackets = play(server, trials_of(study), int(found.stdout.split()[0]))
        wait_until(lambda: server.key("Return") and not program.running(), START, "the end")
        server.close()
        assert program.process.returncode == 0, program.said()
    (table,) = folder.rglob("*_trials_data.csv")
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    traces = [(table.parent / row["events_file"]).read_text().splitlines() for row in rows]
    return list(zip(brackets, rows, [list(csv.DictReader(t)) for t in traces], strict=True))


def test_the_completion_time_is_right_to_one_frame(played):
    for (first, *_, answer), row, _ in played:
        shortest, longest = answer[0] - first[1], answer[1] - first[0]
        assert shortest - PERIOD <= float(row["time"]) <= longest + PERIOD


def test_keys_carry_the_systems_time_and_not_a_frames(played):
    for (_, _, *sent), _, events in played:
        pressed = [float(e["time"]) for e in events if e["event"] == "KeyPress"]
        for (before, after), found in zip(sent, pressed[-2:], strict=True):
            assert before - STAMP <= found <= after + STAMP


def test_the_sidecar_says_how_far_times_can_be_trusted(played, folder):
    (sidecar,) = folder.rglob("*_trials_data.json")
    display = json.loads(sidecar.read_text(encoding="utf-8"))["provenance"]["display"]
    assert display["input_time"] == "X11 event time, 1 ms"
    assert display["focus_time"] == "within the frame before its dispatch, each with its bound"
    assert display["refresh_declared"] == "60"
    assert display["refresh_measured"] == "does not wait"  # a virtual screen has no retrace


def test_time_without_the_windows_focus_is_subtracted_from_the_clean_time(played):
    *undisturbed, ((_, (lost, had), *_), row, _) = played
    assert all(row["time"] == row["time_clean"] for _, row, _ in undisturbed)
    away = float(row["time"]) - float(row["time_clean"])
    # X11 does not say when the focus changed: each change counts from when it was dispatched,
    # which is up to a frame later.
    late = float(row["worst_frame"]) + PERIOD
    assert had[0] - lost[1] - late <= away <= had[1] - lost[0] + late
