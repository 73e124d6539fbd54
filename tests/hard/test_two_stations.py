"""Two stations want one participant: the second is refused, or takes over from what is dead.

Two real processes run the command; only the window is a script that writes rows until it may end.
"""

import csv
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from desktop import wait_until
from postgres import Postgres

from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger import ledger_lock
from seethrough.experiment.ledger import ledger_store as store
from seethrough.experiment.ledger.ledger_lock import Guard, Holder, LockLost, Locks, acquire
from seethrough.experiment.record.chain import verify

BEAT, LEASE, DEAD = 0.2, 0.6, 2.5  # s, in place of 2, 6, 15: heartbeats are as they are, but faster

STATION = f"""
import os, signal, sys, time
from pathlib import Path
from seethrough.experiment import cli
from seethrough.experiment.ledger import ledger_lock
from seethrough.experiment.commands.sessions import run
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.record.recorder import FileRecorder, Who
from seethrough.experiment.session.resume import starting_point
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.tasks.kit.base import Outcome

ledger_lock.BEAT, ledger_lock.LEASE, ledger_lock.DEAD = {BEAT}, {LEASE}, {DEAD}
end, stand = Path(sys.argv[2]), int(sys.argv[4])

def play(study, participant, slot, source, data, guard):
    asked, begun = [], []

    def asks():
        guard()
        asked.append(None)
        if begun and len(asked) - begun[0] == stand:  # just after it was told that all is well
            os.kill(os.getpid(), signal.SIGSTOP)

    start = starting_point(study, data, source, participant, slot)
    made = {{"study_sha256": study.digest()}}
    who = Who(study.general.name, participant, source, slot, made, start.session,
              design_entry(study))
    recorder = FileRecorder(data, who, attempts=start.attempts, guard=asks)
    number, status = max(start.done, default=0), "left"
    try:
        while not end.exists():
            number += 1
            trial = Trial(number, 1, 1, number, {{}}, "count", "s", (1, 1))
            recorder.trial_begins(trial)
            time.sleep(0.05)
            answer = Outcome("1", "1", True)
            recorder.trial_ends(TrialRecord(trial, answer, 1, 0, 2, 0, False, 9, 0, 0.1, 0, 0))
            print("trial", number, flush=True)
            begun.append(len(asked))
        status = "complete"
    finally:
        recorder.close(status)
    return status

run._play = play
words = ["run", "demo", "--participant", "P01", "--data", sys.argv[1]]
sys.exit(cli.main(words + (["--ledger", sys.argv[3]] if sys.argv[3] else [])))
"""


class Station:
    """A process that plays P01 until it is told to end."""

    def __init__(self, tmp_path, url, stand=0):
        self.end = tmp_path / "end"
        command = [sys.executable, "-c", STATION, tmp_path / "data", self.end, url, stand]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(list(map(str, command)), **pipes)

    def played(self):
        """Wait for a trial."""
        line = self.process.stdout.readline()
        while line and not line.startswith("trial"):
            line = self.process.stdout.readline()
        assert line, self.process.stderr.read()
        return self

    def said(self):
        """(status, standard error) once it has ended."""
        _, err = self.process.communicate(timeout=60)
        return self.process.returncode, err

    def send(self, number):
        os.kill(self.process.pid, number)


@pytest.fixture(params=["sqlite", "postgresql"])
def stations(request, tmp_path):
    began = []

    def begin(url):
        began.append(Station(tmp_path, url))
        return began[-1]

    try:
        if request.param == "sqlite":
            yield lambda: begin("")
        else:
            with Postgres() as server:
                yield lambda: begin(server.url)
    finally:
        for station in began:
            station.process.kill()
            station.process.communicate()


def files(tmp_path):
    """What was recorded: a trace in which nothing is yet may be taken away by who began it."""
    paths = [p for p in (tmp_path / "data" / "data").rglob("*") if p.is_file()]
    return {p: p.read_bytes() for p in paths if p.parent.name != "traces" or p.stat().st_size}


def once(tmp_path):
    """Whether no trial was recorded twice as the same attempt: a broken block is played again."""
    rows = []
    for table in (tmp_path / "data").rglob("*_trials_data.csv"):
        rows += csv.DictReader(table.read_text().splitlines())
    played = [(row["trial"], row["attempt"]) for row in rows]
    return len(set(played)) == len(played) > 1


def test_a_second_station_is_refused_in_one_line_with_who_where_and_since_when(stations, tmp_path):
    first = stations().played()
    status, said = stations().said()
    assert status == 2
    line = said.splitlines()[-1]
    assert re.fullmatch(
        r"seethrough: --participant = P01: being played at \S+, process "
        rf"{first.process.pid} since 20\d\d-\S+Z: expected another participant, or .*",
        line,
    ), said
    first.end.touch()
    assert first.said()[0] == 0
    home = tmp_path / "data/data/human/P01"
    assert verify(home) == [] and len(list(home.glob("*_trials_data.json"))) == 1


def test_a_killed_stations_lock_frees_itself(stations, tmp_path):
    first = stations().played()
    first.send(signal.SIGKILL)
    first.process.communicate()
    second = stations().played()
    second.end.touch()
    status, said = second.said()
    assert status == 0 and "ended without a word: taken over" in said
    assert verify(tmp_path / "data/data/human/P01") == []
    assert once(tmp_path)


def test_a_stopped_station_writes_nothing_after_another_took_over(stations, tmp_path):
    first = stations().played()
    first.send(signal.SIGSTOP)
    # PostgreSQL's clock has it as dead, SQLite's stations will watch. A beat that was under way may
    # be written some seconds after the stop, by a server on a busy machine.
    time.sleep(DEAD + 5.0)
    second = stations().played()
    second.end.touch()
    assert second.said()[0] == 0
    before = files(tmp_path)
    first.send(signal.SIGCONT)
    status, said = first.said()
    assert status == 2 and "stood still for too long and was taken over" in said, said
    assert "Traceback" not in said
    assert files(tmp_path) == before
    assert verify(tmp_path / "data/data/human/P01") == []
    assert once(tmp_path)


# Once the first of its traces is made; before they are written; before the row is.
@pytest.mark.parametrize("stand", [2, 4, 8])
def test_what_it_wrote_between_being_asked_and_stopped_is_taken_back(stand, tmp_path):
    """It stands still after it was told that the participant is still its own."""
    first = Station(tmp_path, "", stand)
    second = None
    try:
        first.played()
        wait_until(lambda: state_of(first.process.pid) == "T", 20, "the stop")
        second = Station(tmp_path, "").played()
        second.end.touch()
        assert second.said()[0] == 0
        before = files(tmp_path)
        first.send(signal.SIGCONT)
        status, said = first.said()
    finally:
        for station in filter(None, (first, second)):
            station.process.kill()
            station.process.communicate()
    assert status == 2 and "stood still for too long and was taken over" in said, said
    assert files(tmp_path) == before
    assert verify(tmp_path / "data/data/human/P01") == []
    assert once(tmp_path)


def state_of(process):
    """The letter of what a process does, T when it is stopped."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]


@pytest.fixture
def locks(tmp_path, monkeypatch):
    for name, value in (("BEAT", 0.1), ("LEASE", 0.3), ("DEAD", 0.8), ("POLL", 0.05)):
        monkeypatch.setattr(ledger_lock, name, value)
    found = Locks(store.connect(store.sqlite_url(tmp_path / "locks.sqlite")), "test")
    yield found
    found.close()


ELSEWHERE = Holder("t", "lab2, process 7", "", "2036-01-01T00:00:00.000Z")


def test_a_lock_from_2036_of_another_machine_lives_no_longer_than_its_heartbeat(locks):
    assert locks.take("P01", ELSEWHERE) is None
    said, me = [], Holder.here()
    acquire(locks, "P01", me, said.append)
    assert locks.look("P01").token == me.token
    assert "may be in play at lab2, process 7 (since 2036-" in said[0]


def test_a_lock_from_2036_that_beats_is_respected_also_by_an_id_in_other_case(locks):
    guard = Guard(locks, "P01", ELSEWHERE, print)
    assert locks.take("P01", ELSEWHERE) is None
    try:
        with pytest.raises(InputError, match=r"= p01: being played at lab2, process 7 since 2036"):
            acquire(locks, "p01", Holder.here(), lambda _: None)
    finally:
        guard.stop()
    assert locks.look("P01") is None


def test_of_two_that_take_over_one_gets_it(locks):
    locks.take("P01", ELSEWHERE)
    seen = locks.look("P01")
    one, other = Holder.here(), Holder.here()
    assert locks.replace("P01", seen, one) and not locks.replace("P01", seen, other)
    assert not locks.beat("P01", ELSEWHERE.token) and locks.beat("P01", one.token)
    assert not locks.replace("P01", replace(seen, token=one.token), other)  # it gave a heartbeat


def test_a_guard_whose_lock_was_taken_refuses_every_write(locks):
    me = Holder.here()
    acquire(locks, "P01", me, print)
    guard = Guard(locks, "P01", me, print)
    guard.check()
    assert locks.replace("P01", locks.look("P01"), ELSEWHERE)
    wait_until(lambda: guard._lost, 10, "the heartbeat that finds out")
    with pytest.raises(LockLost, match="taken over by lab2, process 7 at 2036-"):
        guard.check()
    guard.stop()
    assert locks.look("P01").token == ELSEWHERE.token  # it is not freed by who lost it
