"""Who plays a participant now: a lock in the ledger's database that lives by its heartbeat.

No station's clock decides whether a lock lives: on PostgreSQL the database's does; on SQLite who
wants it watches for longer than heartbeats may take. A process of this machine that ended frees its
lock at once. A session that stood still for long asks before its next write whether it still has
its lock (`Guard.check`), and stops if somebody took over.
"""

from __future__ import annotations

import os
import platform
import secrets
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import sqlalchemy as sql
from sqlalchemy.engine import Connection, Engine

from seethrough.experiment.display.interrupt import check
from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger import ledger_store as store
from seethrough.experiment.ledger.ledger_slots import stamp

BEAT = 2.0  # s between heartbeats
LEASE = 6.0  # s after its last heartbeat that a session writes without asking
DEAD = 15.0  # s without one after which a lock is free; well over the lease
POLL = 0.5  # s between looks at another's heartbeat


class LockLost(InputError):
    """Another station took the participant over while this one stood still."""


@dataclass(frozen=True)
class Holder:
    """Who has a lock; `age`: s since the last heartbeat by the database's clock, if it has one."""

    token: str
    station: str
    place: str
    since: str
    beats: int = 0
    age: float | None = None

    @classmethod
    def here(cls) -> Holder:
        """This process."""
        station = f"{platform.node() or 'unnamed station'}, process {os.getpid()}"
        return cls(secrets.token_hex(8), station, _place(), stamp(datetime.now(UTC)))

    def ended(self) -> bool:
        """Whether it was a process of this machine, and is no more. False where nobody knows."""
        machine, _, process = self.place.rpartition("/")
        return machine != "" and machine == _machine() and _process(process) != process


def _machine() -> str:
    """The running system and its space of process numbers: containers have one each."""
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text("ascii").strip()
        return f"{boot}/{os.readlink('/proc/self/ns/pid')}"
    except OSError:
        return ""  # no Linux: heartbeats alone count


def _process(name: str) -> str:
    """A process by its number and when it began, from `number:…`; "" if it has ended."""
    number = name.partition(":")[0]
    try:
        # After the program's name in brackets: its state, … and as the 20th when it began.
        values = Path(f"/proc/{number}/stat").read_text("utf-8", "replace").rpartition(")")[2]
    except OSError:
        return ""
    state, *rest = values.split()
    return "" if state in "ZX" else f"{number}:{rest[18]}"


def _place() -> str:
    machine = _machine()
    return f"{machine}/{_process(str(os.getpid()))}" if machine else ""


class Locks:
    """The locks of a study in a database. Every method is one transaction; raises InputError."""

    def __init__(self, engine: Engine, study: str) -> None:
        self._engine, self._study = engine, study

    def close(self) -> None:
        """Give the database back."""
        self._engine.dispose()

    def take(self, participant: str, me: Holder) -> Holder | None:
        """None if the lock was free and is mine now, else who has it."""
        with store.exclusive(self._engine) as at:
            holder = self._holder(at, participant)
            if holder is None:
                self._insert(at, participant, me)
            return holder

    def look(self, participant: str) -> Holder | None:
        """Who has it."""
        with store.exclusive(self._engine) as at:
            return self._holder(at, participant)

    def replace(self, participant: str, dead: Holder, me: Holder) -> bool:
        """Take it from a holder that gave no heartbeat since; whether it was still the same."""
        with store.exclusive(self._engine) as at:
            holder = self._holder(at, participant)
            if holder is None or (holder.token, holder.beats) != (dead.token, dead.beats):
                return False
            at.execute(store.LOCKS.delete().where(self._is(participant)))
            self._insert(at, participant, me)
            return True

    def beat(self, participant: str, token: str) -> bool:
        """A heartbeat; False if the lock is somebody else's by now."""
        c = store.LOCKS.c
        with store.exclusive(self._engine) as at:
            mine = store.LOCKS.update().where(self._is(participant), c.token == token)
            return at.execute(mine.values(beats=c.beats + 1, heard=self._clock())).rowcount == 1

    def release(self, participant: str, token: str) -> None:
        """Free it, if it is still mine."""
        with store.exclusive(self._engine) as at:
            mine = self._is(participant) & (store.LOCKS.c.token == token)
            at.execute(store.LOCKS.delete().where(mine))

    def _holder(self, at: Connection, participant: str) -> Holder | None:
        c = store.LOCKS.c
        silent = self._clock() - c.heard
        query = sql.select(c.token, c.station, c.place, c.since, c.beats, silent)
        row = at.execute(query.where(self._is(participant))).first()
        if row is None:
            return None
        token, station, place, since, beats, heard = row
        age = float(heard) if self._has_clock else None
        return Holder(token, station, place, since, beats, age)

    def _insert(self, at: Connection, participant: str, me: Holder) -> None:
        values = {
            "study": self._study, "participant": participant, "token": me.token,
            "station": me.station, "place": me.place, "since": me.since, "beats": 0,
            "heard": self._clock(),
        }  # fmt: skip
        at.execute(store.LOCKS.insert().values(values))

    @property
    def _has_clock(self) -> bool:
        return self._engine.dialect.name == "postgresql"

    def _clock(self) -> sql.ColumnElement[float]:
        if not self._has_clock:
            return sql.literal(0.0)
        now = sql.func.extract("epoch", sql.func.clock_timestamp())
        return sql.cast(now, sql.Double)

    def _is(self, participant: str) -> sql.ColumnElement[bool]:
        c = store.LOCKS.c
        lower = sql.func.lower(c.participant) == participant.lower()
        return (c.study == self._study) & lower


def awake() -> float:
    """Seconds that also pass while the machine sleeps, where the system counts those."""
    clock = getattr(time, "CLOCK_BOOTTIME", None)
    return time.monotonic() if clock is None else time.clock_gettime(clock)


def acquire(locks: Locks, participant: str, me: Holder, say: Callable[[str], None]) -> None:
    """Take the lock, if need be after its holder gave no sign for long. Raises InputError."""
    while (seen := locks.take(participant, me)) is not None:
        if not seen.ended():
            _dead(locks, participant, seen, say)
        if locks.replace(participant, seen, me):
            say(f"{participant}: the session at {seen.station} ended without a word: taken over")
            return


def _dead(locks: Locks, participant: str, seen: Holder, say: Callable[[str], None]) -> None:
    """Return once the holder is known to give no heartbeat; raises InputError when it does."""
    if seen.age is not None and seen.age > DEAD:
        return
    if seen.age is None:
        say(
            f"{participant} may be in play at {seen.station} (since {seen.since}): "
            f"waiting up to {DEAD:g} s for a sign of it"
        )
        end = awake() + DEAD
        while awake() < end:
            time.sleep(POLL)
            check()
            now = locks.look(participant)
            if now is None or now.token != seen.token:
                return
            if now.beats != seen.beats:
                break
        else:
            return
    raise InputError(
        f"--participant = {participant}: being played at {seen.station} since {seen.since}: "
        "expected another participant, or the end of that session"
    )


class Guard:
    """Keeps a lock alive from a thread of its own; `check` before each write."""

    def __init__(
        self, locks: Locks, participant: str, me: Holder, say: Callable[[str], None]
    ) -> None:
        self._locks, self._participant, self._me, self._say = locks, participant, me, say
        self._heard = awake()
        self._taken: Holder | None = None
        self._lost = self._troubled = False
        self._end, self._one = threading.Event(), threading.Lock()
        self._thread = threading.Thread(target=self._beats, daemon=True)
        self._thread.start()

    def check(self) -> None:
        """Raises LockLost if another station plays the participant now."""
        if not self._lost and awake() - self._heard > LEASE:
            self._beat()
        if self._lost:
            by = f" by {self._taken.station} at {self._taken.since}" if self._taken else ""
            raise LockLost(
                f"{self._participant}: this session stood still for too long and was taken over"
                f"{by}; what it completed before is saved"
            )

    def stop(self) -> None:
        """The last heartbeat; the lock is freed."""
        self._end.set()
        self._thread.join()
        with suppress(InputError):  # a database that is gone: the lock ends by its heartbeat
            self._locks.release(self._participant, self._me.token)

    def _beats(self) -> None:
        while not self._end.wait(BEAT):
            self._beat()

    def _beat(self) -> None:
        with self._one:
            began = awake()
            try:
                if self._locks.beat(self._participant, self._me.token):
                    self._heard, self._troubled = began, False
                else:
                    self._lost, self._taken = True, self._locks.look(self._participant)
            except InputError as error:
                # Completed trials are the dearest: the session goes on, and the experimenter knows.
                if not self._troubled:
                    self._say(f"{error}; until it can, {self._participant} is not locked")
                self._troubled = True


@contextmanager
def playing(locks: Locks, participant: str) -> Iterator[Callable[[], None]]:
    """Hold the participant's lock; gives the check before each write. Raises InputError."""
    me = Holder.here()
    try:
        acquire(locks, participant, me, _say)
        guard = Guard(locks, participant, me, _say)
        try:
            yield guard.check
        finally:
            guard.stop()
    finally:
        locks.close()


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
