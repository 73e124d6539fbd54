"""Stops sessions at random moments while keys are typed, and looks at what was made of the keys.

    python tests/support/stalled_sessions.py COUNT SEED FOLDER

Each session is a fork that plays `seethrough run` in a window of its own screen. Keys, clicks and
focus changes are real events of the X server, made throughout, also while the process is stopped
(SIGSTOP, .1 to 5 s); a client of its own watches the screen. What is recorded is held against what
was typed when, and against when each trial was seen:

- every key and click that a trial took was made while that trial was on the screen,
- and happened when the trace says: never before `time`, nor after `time + within`,
- the answer follows from these alone, and its time is right within its bound.
"""

import csv
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from desktop import Desktop, wait_until
from player import has_window
from small_study import small_study
from xserver import XServer

from seethrough.experiment import cli
from seethrough.experiment.session import live  # imported before the forks: a start costs them less
from seethrough.experiment.study.config import load
from seethrough.tasks.kit.entry import MOST_DIGITS, NumberEntry
from seethrough.tasks.kit.letters import LETTERS
from seethrough.tasks.pattern import pattern_task as pattern

TITLE = "Stalls"
SLACK = 0.003  # s: X11 counts whole milliseconds, and two processes read two clocks after another
PART = (300, 3, 200, 240)  # pixels of the view that no text is drawn on: x, y, width, height
PAPER, NOTHING = bytes((250, 247, 247)), bytes(3)  # of a page, and where there is no window
SHORTEST, LONGEST = 0.1, 5.0  # s of a stall
GAP = 0.03, 0.15  # s between keys
LIMIT = 300  # s for a session on a busy machine: not a bound on speed
KEYS = ["Return"] * 7 + ["1", "2", "3", "9", "k", "x"] * 2 + ["Escape"]
ASPECT, HEIGHT = 4 / 3, 600
NO_WINDOW = 0


@dataclass
class Seen:
    """A screen: what it showed, the bracket of when it came, the latest moment it was there."""

    page: bool
    picture: bytes
    earliest: float
    latest: float
    end: float = float("inf")


@dataclass
class Session:
    """What was done to a session, and what was seen of it."""

    typed: list = field(default_factory=list)  # (name, before, after)
    clicked: list = field(default_factory=list)
    focused: list = field(default_factory=list)  # (True or False, before, after)
    screens: list = field(default_factory=list)
    stalls: list = field(default_factory=list)  # their lengths


def started(study, data, display, log):
    """The process number of a fork that plays the session."""
    child = os.fork()
    if child:
        return child
    os.environ["DISPLAY"] = display
    os.environ["LP_NUM_THREADS"] = "1"
    file = os.open(log, os.O_WRONLY | os.O_CREAT)
    os.dup2(file, 1)
    os.dup2(file, 2)
    os._exit(cli.main(["run", str(study), "--participant", "P01", "--data", str(data)]))


def play(folder, seed, trials=2, stalls=6):
    """Play a session in `folder`; what was done and seen. Raises AssertionError if it fails."""
    assert live  # loaded above
    rng, done = np.random.default_rng(seed), Session()
    folder.mkdir(parents=True)
    study = folder / "stalls.toml"
    said = "Short trials, stopped again and again."
    study.write_text(small_study(TITLE, said, trials=trials, practice=1), encoding="utf-8")
    with Desktop() as desktop:
        server = XServer(desktop.env["DISPLAY"])
        server.move(400, 300)
        child = started(study, folder / "data", desktop.env["DISPLAY"], folder / "log")
        try:
            wait_until(lambda: has_window(desktop, TITLE), 60, "the window")
            search = ["xdotool", "search", "--onlyvisible", "--name", TITLE]
            found = subprocess.run(search, env=desktop.env, capture_output=True, check=True)
            server.focus(int(found.stdout.split()[0]))
            status = Hand(server, rng, done, child, stalls, int(found.stdout.split()[0])).play()
        except BaseException:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            raise
        server.close()
    assert status == 0, (folder / "log").read_text()
    return done


class Hand:
    """Types, clicks, stops the process, and watches, all in one loop."""

    def __init__(self, server, rng, done, child, stalls, window):
        self.server, self.rng, self.done, self.child = server, rng, done, child
        self.left, self.window = stalls, window
        self.stop_at = self.go_at = None
        self.places = list(dict(NumberEntry(ASPECT).buttons()).values())
        self.places += list(pattern.buttons(ASPECT).values())

    def play(self):
        """Until the process ends: its exit status."""
        begin = time.monotonic()
        due, stall, focus = begin, begin + self.rng.exponential(2.0), begin + 6.0
        while True:
            now = time.monotonic()
            assert now < begin + LIMIT, "the session does not end"
            gone, status = os.waitpid(self.child, os.WNOHANG)
            if gone:
                return os.waitstatus_to_exitcode(status)
            self.look()
            if self.go_at is not None and now >= self.go_at:
                os.kill(self.child, signal.SIGCONT)
                self.go_at, stall = None, now + self.rng.exponential(2.0)
            if self.go_at is None and self.left and now >= min(stall, self.stop_at or stall):
                self.stop(now)
            if now >= focus:
                self.away()
                focus = now + self.rng.uniform(8, 20)
            if now >= due:
                self.act(now)
                due = now + self.rng.uniform(*GAP)
            time.sleep(0.001)

    def stop(self, now):
        """SIGSTOP; how long is drawn so that short ones are as frequent as long ones."""
        os.kill(self.child, signal.SIGSTOP)
        took = float(np.exp(self.rng.uniform(np.log(SHORTEST), np.log(LONGEST))))
        self.go_at, self.stop_at, self.left = now + took, None, self.left - 1
        self.done.stalls.append(took)

    def act(self, now):
        """A key or a click; half of the returns are followed by a stall within a few frames."""
        if self.rng.random() < 0.1:
            rect = self.places[self.rng.integers(len(self.places))]
            x, y = rect.x + rect.width / 2, rect.y + rect.height / 2
            self.server.move(x * HEIGHT, y * HEIGHT)
            self.done.clicked.append(("PointerPress", *self.server.click()))
            return
        name = KEYS[self.rng.integers(len(KEYS))]
        self.done.typed.append((name, *self.server.key(name)))
        if name == "Return" and self.rng.random() < 0.5:
            self.stop_at = now + self.rng.uniform(0, 0.06)

    def away(self):
        """Another window has the focus for a moment."""
        self.done.focused.append((False, *self.server.focus(NO_WINDOW)))
        end = time.monotonic() + self.rng.uniform(0.05, 0.3)
        while time.monotonic() < end:
            self.look()
            time.sleep(0.001)
        self.done.focused.append((True, *self.server.focus(self.window)))

    def look(self):
        """Note what is on the screen if it is something else than before."""
        before = time.monotonic()
        picture = self.server.part(*PART)
        page = picture[:3] == NOTHING or all(
            abs(a - b) < 3 for a, b in zip(picture[:3], PAPER, strict=True)
        )
        after, screens = time.monotonic(), self.done.screens
        same = screens and screens[-1].page == page and (page or screens[-1].picture == picture)
        if not same:
            if screens:
                screens[-1].end = after
            screens.append(Seen(page, picture, getattr(self, "last", before), after))
        self.last = before


def half_copied(screens, number):
    """Whether a screen was seen while one picture took another's place: rows of both, no others."""
    if not 0 < number < len(screens) - 1:
        return False
    width = len(screens[number].picture) // PART[3]
    rows = (
        [s.picture[k : k + width] for k in range(0, len(s.picture), width)]
        for s in screens[number - 1 : number + 2]
    )
    return all(own in (before, after) for before, own, after in zip(*rows, strict=True))


def views(screens):
    """The screens of each trial in turn: a page may lie over it for a while."""
    found = []
    for number, screen in enumerate(screens):
        if screen.page or half_copied(screens, number):
            continue
        if not found or found[-1][0].picture != screen.picture:
            found.append([])
        found[-1].append(screen)
    return found


def traces(folder):
    """[(row or None for a training trial, events, first frame)] in the order of the session."""
    home = folder / "data" / "data" / "human" / "P01"
    (table,) = home.glob("*_trials_data.csv")
    rows = {r["events_file"]: r for r in csv.DictReader(table.read_text().splitlines())}
    found = []
    for path in home.glob("traces/*_events.csv"):
        camera = path.with_name(path.name.replace("_events", "_camera")).read_text().splitlines()
        events = list(csv.DictReader(path.read_text().splitlines()))
        first = float(next(csv.DictReader(camera))["time"])
        found.append((rows.pop(f"traces/{path.name}", None), events, first))
    assert not rows
    return sorted(found, key=lambda trace: trace[2])


def check(folder, done):
    """Raise AssertionError unless the promises were kept; (presses taken, presses made)."""
    shown, recorded = views(done.screens), traces(folder)
    assert len(shown) == len(recorded), f"{len(shown)} trials seen, {len(recorded)} recorded"
    taken = 0
    for view, (row, events, first) in zip(shown, recorded, strict=True):
        if covered(view[0], events):
            view[0].earliest = view[0].latest = first
        assert view[0].earliest - SLACK <= first, "a first frame from before it was there"
        times = [float(e["time"]) for e in events if e["key"] not in ("escape", "f1")]
        last = None
        for event in events:
            if event["event"] == "KeyPress":
                name = {"enter": "Return", "escape": "Escape"}.get(event["key"], event["key"])
                last = matched(event, name, done.typed)
            elif event["event"] == "PointerPress":
                last = matched(event, "PointerPress", done.clicked)
            elif event["event"] == "FocusChange":
                matched(event, None, list(done.focused))  # once more in the trial that follows
                continue
            else:
                continue
            taken += 1
            if event["key"] != "escape":
                on_screen = any(
                    s.earliest - SLACK <= last[2] and last[1] <= s.end + SLACK for s in view
                )
                assert on_screen, f"{last[0]} was typed when this trial was not to be seen"
        back = max((a - b for a, b in pairwise(times)), default=0.0)
        assert back <= SLACK, f"time runs back by {back} s"
        if row is not None:
            check_row(row, events, last, view[0])
    return taken, len(done.typed) + len(done.clicked)


def covered(screen, events):
    """Whether Esc, pressed before it, laid a page over the first frame before anybody looked."""
    escapes = [float(e["time"]) for e in events if e["key"] == "escape"]
    return any(moment < screen.earliest for moment in escapes)


def matched(event, name, made):
    """What was made of that name at the event's time; each counts once."""
    time_, within = float(event["time"]), float(event["within"] or 0)
    for one in made:
        same = name is None or one[0] == name
        if same and one[1] - SLACK <= time_ + within and time_ <= one[2] + SLACK:
            made.remove(one)
            return one
    raise AssertionError(f"{event}: nothing of the kind was made at that time")


def check_row(row, events, last, screen):
    """The answer comes from the keys that were taken; its time is right within its bound."""
    if not any(e["event"] == "PointerPress" for e in events):
        assert row["answer"] == answer_of(row["task"], events)
    shortest, longest = last[1] - screen.latest, last[2] - screen.earliest
    found, within = float(row["time"]), float(row["time_within"])
    assert found <= longest + SLACK and shortest - SLACK <= found + within, (
        f"time {found} + {within}: expected {shortest} to {longest}"
    )


def answer_of(task, events):
    """What the keys of a trial answer."""
    text = ""
    for event in events:
        key = event["key"] if event["event"] == "KeyPress" else ""
        if task == "count" and key.isdigit() and len(text) < MOST_DIGITS:
            text = (text + key).lstrip("0") or "0"
        elif task == "pattern" and key.upper() in LETTERS and len(key) == 1:
            text = key.upper()
    return text


def main(count, seed, folder):
    """Play, check, and print what was found."""
    assert load  # the study is read in the forks
    totals, failed = np.zeros(4), 0
    for number in range(count):
        place = folder / f"{number:03d}"
        try:
            done = play(place, [seed, number])
            totals += [len(done.stalls), sum(done.stalls), *check(place, done)]
        except AssertionError as error:
            failed += 1
            print(f"{place}: {error}", flush=True)
    stalls, seconds, taken, made = totals
    print(
        f"{count} sessions, {stalls:.0f} stalls of {seconds:.0f} s in all, {made:.0f} keys and "
        f"clicks made, {taken:.0f} taken by a trial: {failed} sessions with one that was not its"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])))
