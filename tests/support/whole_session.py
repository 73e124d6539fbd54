"""Plays the whole published session in the window, by real key and mouse events, as a person would.

    python tests/support/whole_session.py FOLDER

The session is killed (SIGKILL) in the middle of two trials and gone on with. Then every trial is
verified by replay, and the report is made. FOLDER/pictures keeps each page and trial as it was.
"""

import contextlib
import csv
import io
import os
import signal
import sys
import time
from collections import Counter
from itertools import pairwise
from pathlib import Path

import numpy as np
from desktop import Desktop, wait_until
from PIL import Image, ImageGrab
from player import START, open_session, trials_of

from seethrough.experiment import cli
from seethrough.experiment.study.config import load
from seethrough.tasks.kit.entry import NumberEntry
from seethrough.tasks.pattern import pattern_task as pattern
from seethrough.tasks.worlds.building.plan_mark import PlanMark

STUDY = "published"
KILLED = (8, 16)  # after so many trials of the design, in the middle of the next one
PAPER = (247, 247, 250)  # what pages are drawn on
TURNED = 0.004  # part of the pixels that another page changes at least
FIELD = 160  # pixels: a text field is at least so wide, a button that is not filled less
BUTTON, LINE = (41, 102, 179), 590  # a button's blue; below this row lies the progress line
HEIGHT, ASPECT = 600, 4 / 3


class Person:
    """Eyes on the screen, hands on mouse and keyboard; mouse and keyboard answer in turn."""

    def __init__(self, desktop, program, pictures):
        self.desktop, self.program, self.pictures = desktop, program, pictures
        self.kept = np.zeros((1, 1, 3))
        self.answers = 0

    def look(self):
        """(600, 800, 3) the window's pixels: without a window manager it lies in the corner."""
        screen = ImageGrab.grab(xdisplay=self.desktop.env["DISPLAY"])
        return np.asarray(screen.convert("RGB"))[:600, :800]

    def still(self):
        """What is on the screen once nothing moves: dots move while the next scene is made."""
        last = self.look()
        while True:
            time.sleep(0.5)
            now = self.look()
            if (now == last).all() or not is_page(now):
                return now
            last = now

    def keep(self, name, picture=None):
        """The window as a picture, numbered in the order of the session."""
        self.kept = self.look() if picture is None else picture
        number = len(list(self.pictures.glob("*.png"))) + 1
        Image.fromarray(self.kept).save(self.pictures / f"{number:03d}-{name}.png")

    def play(self, trials):
        """Everything until so many trials are reported; `trials` are those of the design."""
        for number, trial in enumerate(trials, start=1):
            end = time.monotonic() + 120
            while self.program.trials() < number:
                assert self.program.running() and time.monotonic() < end, self.program.said()
                if is_page(self.look()):
                    self.page()
                else:
                    self.answer(trial.task)

    def page(self):
        """Keep a page once, write where there is room for it, answer it and go on."""
        before = self.still()
        if not is_page(before):
            return
        if differ(before, self.kept):
            self.keep("page", before)
            if self.write(before):
                return
        self.desktop.keys("Return")
        if not self.turned(before):
            self.desktop.keys(*["Down", "space"] * 3, "Tab", "Return")
            self.turned(before)

    def turned(self, before, seconds=1.5):
        """Whether another page or a trial comes in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.program.running():
            if differ(self.look(), before):
                return True
            time.sleep(0.1)
        return not self.program.running()

    def write(self, picture):
        """Type into the page's text field, if it has one, and press the button; whether it had."""
        white = (picture == 255).all(axis=2)
        beside = np.lib.stride_tricks.sliding_window_view(white, FIELD, axis=1).all(axis=2)
        rows, columns = np.nonzero(beside)
        if not len(rows):
            return False
        self.click_at(np.median(rows), np.median(columns) + FIELD / 2)
        remark = len(np.unique(rows)) > 60
        text = 'Nice, but <b>the car</b> was hidden, "quite"' if remark else "34"
        self.desktop.do("type", "--delay", "60", text)
        self.keep("written")
        # By mouse: in a field of several lines Return begins a new one.
        blue = (np.abs(self.kept.astype(int) - BUTTON) < 8).all(axis=2)
        blue[: int(rows.max()) + 1] = blue[LINE:] = False
        rows, columns = np.nonzero(blue)
        self.click_at(np.median(rows), np.median(columns))
        assert self.turned(self.kept, 20), "the page with a text field stays"
        return True

    def click_at(self, row, column):
        """A click on a pixel."""
        self.desktop.do("mousemove", int(column), int(row))
        self.desktop.do("click", 1)

    def answer(self, task):
        """Look about, keep a picture, answer by mouse or by keyboard."""
        done, self.answers = self.program.trials(), self.answers + 1
        mouse = self.answers % 2 == 1
        getattr(self, f"_{task}")(mouse)
        end = time.monotonic() + 3
        while self.program.trials() == done and not is_page(self.look()):
            if time.monotonic() > end:
                return
            time.sleep(0.05)

    def about(self, task, mouse):
        """Turn the scene, or walk through the building."""
        if task in ("unique", "count_in_building"):
            self.hold("Up", 0.8)
            if mouse:
                for _ in range(6):
                    self.desktop.do("mousemove_relative", 25, 0)
            else:
                self.hold("Left", 0.5)
        elif mouse:
            self.move((0.5, 0.5))
            self.desktop.do("mousedown", 1)
            for _ in range(8):
                self.desktop.do("mousemove_relative", 20, 4)
            self.desktop.do("mouseup", 1)
        else:
            self.hold("Right", 0.6)
        self.keep(task)

    def hold(self, key, seconds):
        """A key that stays down for a while."""
        self.desktop.do("keydown", key)
        time.sleep(seconds)
        self.desktop.do("keyup", key)

    def move(self, at):
        """The pointer to a place in view units."""
        self.desktop.do("mousemove", round(at[0] * HEIGHT), round(at[1] * HEIGHT))

    def click(self, rect):
        """The pointer into a rectangle of the view, and a click."""
        self.move((rect.x + rect.width / 2, rect.y + rect.height / 2))
        self.desktop.do("click", 1)

    def _count(self, mouse):
        self.about("count", mouse)
        places = dict(NumberEntry(ASPECT).buttons())
        for key, name in (("2", "2"), ("9", "9"), ("enter", "Return")):
            self.click(places[key]) if mouse else self.desktop.keys(name)

    def _pattern(self, mouse):
        self.about("pattern", mouse)
        places = pattern.buttons(ASPECT)
        letter = next(iter(places))
        for key, name in ((letter, letter.lower()), ("enter", "Return")):
            self.click(places[key]) if mouse else self.desktop.keys(name)

    def _unique(self, mouse):
        self.about("unique", mouse)
        self.desktop.keys("space", pause=0.4)
        plan = PlanMark(ASPECT, 80.0)
        if mouse:
            self.click(plan.rect)
        else:
            self.desktop.keys("Up", "Up", "Right", "Right", "Right")
        self.keep("unique-mark")
        self.click(plan.button) if mouse else self.desktop.keys("Return")

    def _count_in_building(self, mouse):
        self.about("count_in_building", mouse)
        self.desktop.keys("7", "Return")


def is_page(picture):
    """Whether a page is on the screen: its paper is in both upper corners."""
    corners = picture[2, 2], picture[2, -3]
    return all((np.abs(c.astype(int) - PAPER) < 3).all() for c in corners)


def differ(a, b):
    """Whether two pictures are of different pages: ticks and cursors change less."""
    return a.shape != b.shape or (plain(a) != plain(b)).any(axis=2).mean() > TURNED


def plain(picture):
    """The picture with its buttons in one blue, whether a pointer lies on them or not."""
    red, _, blue = np.moveaxis(picture.astype(int), 2, 0)
    return np.where((blue > red + 60)[..., None], BUTTON, picture)


def killed_twice(desktop, data, pictures, title):
    """Play the session to its end in three sittings; how many trials each sitting completed."""
    trials, played = trials_of(STUDY), []
    each = sum(t.block == 1 for t in trials)
    for kept in (*KILLED, len(trials)):
        begin = 0 if not played else KILLED[len(played) - 1] // each * each
        with open_session(desktop, STUDY, data, title) as program:
            person = Person(desktop, program, pictures)
            wait_until(lambda: is_page(person.look()), START, "the first page")  # noqa: B023
            person.play(trials[begin:kept])
            if kept in KILLED:
                kill(person, trials[kept], data, len(played) + 1)
            else:
                finish(person)
            played.append(kept - begin)
    return played


def kill(person, trial, data, session):
    """SIGKILL in the middle of a trial, while the view moves."""
    name = f"session-{session}_trial-{trial.number:03d}_events.csv"
    began = data / "data" / "human" / "P01" / "traces" / name
    wait_until(began.exists, START, "the next trial")
    person.about(trial.task, mouse=True)
    os.kill(person.program.process.pid, signal.SIGKILL)
    person.program.process.wait(10)


def finish(person):
    """The questionnaire, and thanks."""
    end = time.monotonic() + 120
    while person.program.running():
        assert time.monotonic() < end, person.program.said()
        person.page()
    wait_until(lambda: not person.program.running(), START, "the end")
    assert person.program.process.returncode == 0, person.program.said()


def rows_of(data, name):
    """Every row of P01's tables of that name, in the order of the sessions."""
    found = []
    for path in sorted(data.glob(f"data/human/P01/*_{name}_data.csv")):
        with open(path, encoding="utf-8", newline="") as file:
            found += list(csv.DictReader(file))
    return found


def command(*words):
    """(status, what it said) of a command of seethrough."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        status = cli.main([str(w) for w in words])
    return status, said.getvalue()


def verified(data, rows):
    """Replay every attempt of every trial; how many frames were compared. All must be equal."""
    frames = 0
    for row in rows:
        which = ("--trial", row["trial"], "--attempt", row["attempt"])
        status, said = command("replay", data, "--participant", "P01", *which, "--verify")
        assert status == 0 and " 0 different" in said, (row["trial"], said)
        frames += int(said.split()[0])
    return frames


def main(folder):
    """Play, verify, report; print what was done."""
    pictures, data = folder / "pictures", folder / "data"
    pictures.mkdir(parents=True)
    began = time.monotonic()
    with Desktop() as desktop:
        played = killed_twice(desktop, data, pictures, load(STUDY).general.title)
    minutes = (time.monotonic() - began) / 60
    rows = rows_of(data, "trials")
    attempts = Counter(int(r["trial"]) for r in rows)
    assert sorted(attempts) == list(range(1, len(trials_of(STUDY)) + 1))
    assert all(int(a["session"]) <= int(b["session"]) for a, b in pairwise(rows))
    print(
        f"{len(attempts)} trials in 3 sittings ({', '.join(map(str, played))}), {minutes:.1f} min"
    )
    print(
        f"{len(rows_of(data, 'questionnaire'))} answers, {len(list(pictures.iterdir()))} pictures"
    )
    frames = verified(data, rows)
    print(f"{len(rows)} rows replayed: {frames} frames compared, 0 different")
    for words in (["status", data], ["report", data, "--out", folder / "report"]):
        status, said = command(*words)
        print(said.strip())
        assert status == 0, said


if __name__ == "__main__":
    main(Path(sys.argv[1]))
