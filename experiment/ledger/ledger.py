"""The ledger of slots: who has which row of the design, and what became of it.

    reserve → complete
            ↘ void (stale, withdrawn, given up) → the slot is handed out again

One ledger serves one study, from one or many stations (ledger_store.py); which slot comes next is
decided in ledger_slots.py.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import sqlalchemy as sql
from sqlalchemy import Row
from sqlalchemy.engine import Connection, Engine

from seethrough.analysis.load.files import is_there
from seethrough.experiment.errors import InputError, shown
from seethrough.experiment.files.folders import check_participant
from seethrough.experiment.files.json_files import read_object
from seethrough.experiment.files.private import make_folder
from seethrough.experiment.ledger import ledger_place as place
from seethrough.experiment.ledger import ledger_store as store
from seethrough.experiment.ledger import ledger_sums as sums
from seethrough.experiment.ledger.ledger_lock import Locks
from seethrough.experiment.ledger.ledger_plan import Plan, difference
from seethrough.experiment.ledger.ledger_slots import (
    COMPLETE,
    LIVE,
    STALE,
    SURPLUS,
    VOID,
    Entry,
    Held,
    free_name,
    judged,
    next_slot,
    stale_before,
    stamp,
)


class Ledger:
    """Reservations of one study. Every method raises InputError in one line where it must refuse.

    Times are arguments (aware datetimes). Close it, or use it as a context manager.
    """

    def __init__(self, engine: Engine, plan: Plan, where: str) -> None:
        self._engine = engine
        self.plan = plan
        self.where = where

    @classmethod
    def open(cls, data: Path, url: str, plan: Plan, now: datetime) -> Ledger:
        """The study's ledger, made if there is none; `url` "" for the data folder's own."""
        address = place.find(data, url)
        try:
            make_folder(data)
        except OSError as error:
            raise InputError(f"{error.filename}: cannot be written: {error.strerror}") from None
        engine = store.connect(address)
        try:
            place.settle(data, address, engine)
            ledger = cls(engine, plan, _where(engine))
            with store.exclusive(engine) as at:
                ledger._check_study(at, now)
        except BaseException:
            engine.dispose()
            raise
        return ledger

    @classmethod
    def existing(cls, data: Path, url: str = "") -> Ledger:
        """The ledger of a data folder, whose plan it knows itself."""
        if not place.exists(data, url):
            raise InputError(f"{data}: no ledger: expected {place.FILE}, made by `seethrough run`")
        engine = store.connect(place.find(data, url))
        name = study_in(data)
        with store.exclusive(engine) as at:
            query = store.STUDIES.select()
            rows = at.execute(query.where(store.STUDIES.c.name == name) if name else query).all()
        if len(rows) != 1:
            engine.dispose()
            what = "no study" if not rows else "several studies"
            raise InputError(f"{_where(engine)}: {what}: expected {name or 'one'}")
        try:
            with store.exclusive(engine) as at:
                sums.verify(at, rows[0].name, _where(engine))
            return cls(engine, _plan(rows[0]), _where(engine))
        except BaseException:
            engine.dispose()
            raise

    def close(self) -> None:
        """Give the database back."""
        self._engine.dispose()

    def __enter__(self) -> Ledger:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def locks(self) -> Locks:
        """Who plays whom now, on a connection of its own: a session outlives this ledger's."""
        return Locks(store.connect(self._engine.url), self.plan.study)

    def entries(self) -> tuple[Entry, ...]:
        """Every entry, in the order in which they were reserved."""
        with store.exclusive(self._engine) as at:
            return self._select(at)

    def reserve(
        self,
        participant: str | None,
        now: datetime,
        slot: int | None = None,
        taken: Collection[str] = (),
        brings: Mapping[str, str] | None = None,
    ) -> Entry:
        """A slot for the participant: the next one, or the one they have already (`new` False).

        Without a participant, the lowest P01, P02, … that is neither in the ledger nor in `taken`
        gets it. `slot` asks for one by number. `brings` are the levels of measured factors that the
        participant brings along.
        """
        with store.exclusive(self._engine) as at:
            if slot is not None and slot < 1:
                raise InputError(f"--slot = {slot}: expected at least 1")
            held = self._held(at)
            now = self._now(at, now, held)
            name = participant or self._free_name(at, taken)
            mine = self._find(at, check_participant(name))
            if mine is not None:
                return self._go_on(at, mine, now, slot)
            chosen = self._choose(at, held, now, brings) if slot is None else slot
            if chosen in held.slots:
                self._free(at, chosen, now, name)
            entry = Entry(chosen, name, LIVE, stamp(now), stamp(now), new=True)
            self._insert(at, entry)
            return entry

    def complete(self, participant: str, now: datetime) -> Entry:
        """The participant's session is complete; doing so twice changes nothing."""
        with store.exclusive(self._engine) as at:
            mine, now = self._known(at, participant), self._now(at, now)
            if mine.status in (COMPLETE, SURPLUS):
                return mine
            if mine.status == VOID:
                if not mine.why.startswith(STALE):
                    raise InputError(f"{self.where}: participant = {participant}: {_said(mine)}")
                # The slot was given away: what was completed is kept, and so is the mark.
                return self._change(at, mine, SURPLUS, now, mine.why)
            return self._change(at, mine, COMPLETE, now, "")

    def void(self, participant: str, why: str, now: datetime) -> Entry:
        """The participant's slot is free again; the entry stays, with its date and reason."""
        with store.exclusive(self._engine) as at:
            mine = self._known(at, participant)
            return self._change(at, mine, VOID, self._now(at, now), why)

    def cancel(self, participant: str) -> None:
        """Forget a reservation whose session never began, as if it had not been made."""
        with store.exclusive(self._engine) as at:
            mine = self._known(at, participant)
            if mine.status == LIVE:
                at.execute(store.ENTRIES.delete().where(self._is(mine.participant)))
                sums.forget(at, self.plan.study, mine.participant)

    def add(self, entries: Collection[Entry]) -> None:
        """Enter what is known from elsewhere, as it is (a ledger made again from its data)."""
        with store.exclusive(self._engine) as at:
            for entry in entries:
                self._insert(at, entry)

    def upcoming(self, now: datetime) -> int | None:
        """The slot that the next new participant would get; None if all are live or complete."""
        with store.exclusive(self._engine) as at:
            held = self._held(at)
            return self._next(held, self._now(at, now, held))

    def stale(self, now: datetime) -> tuple[Entry, ...]:
        """Live entries whose slots would be given out again."""
        with store.exclusive(self._engine) as at:
            before = stale_before(self._now(at, now), self.plan.stale_after)
            return tuple(e for e in self._select(at) if e.status == LIVE and e.changed < before)

    # Inside a transaction

    def _select(self, at: Connection, *where: sql.ColumnElement[bool]) -> tuple[Entry, ...]:
        c = store.ENTRIES.c
        query = sql.select(c.slot, c.participant, c.status, c.reserved, c.changed, c.why)
        query = query.where(c.study == self.plan.study, *where).order_by(c.id)
        return tuple(Entry(*row) for row in at.execute(query).all())

    def _held(self, at: Connection) -> Held:
        """Who is live or complete, as columns: a ledger may be long, and others wait."""
        c = store.ENTRIES.c
        query = sql.select(c.slot, c.status, c.changed).where(c.study == self.plan.study)
        rows = at.execute(query.where(c.status.in_((LIVE, COMPLETE)))).all()
        return Held(*zip(*rows, strict=True)) if rows else Held((), (), ())

    def _now(self, at: Connection, now: datetime, held: Held | None = None) -> datetime:
        """Now as most of the ledger has it; what is live and stamped far ahead was heard of now."""
        c = store.ENTRIES.c
        begun = sql.select(store.STUDIES.c.begun).where(store.STUDIES.c.name == self.plan.study)
        held = self._held(at) if held is None else held
        now = judged(now, [at.execute(begun).scalar_one(), *held.changed])
        ahead = stamp(now + timedelta(seconds=self.plan.stale_after))
        if self.plan.stale_after and held.changed and max(held.changed) > ahead:
            for entry in self._select(at, c.status == LIVE, c.changed > ahead):
                self._change(at, entry, LIVE, now, entry.why)
        return now

    def _holder(self, at: Connection, slot: int) -> Entry | None:
        c = store.ENTRIES.c
        found = self._select(at, c.slot == slot, c.status.in_((LIVE, COMPLETE)))
        return found[0] if found else None

    def _next(
        self, held: Held, now: datetime, brings: Mapping[str, str] | None = None
    ) -> int | None:
        plan = self.plan
        live = held.live(stale_before(now, plan.stale_after))
        return next_slot(live, held.complete(), plan.groups, brings)

    def _free_name(self, at: Connection, taken: Collection[str]) -> str:
        c = store.ENTRIES.c
        names = at.execute(sql.select(c.participant).where(c.study == self.plan.study)).scalars()
        return free_name({*names, *taken})

    def _choose(
        self, at: Connection, held: Held, now: datetime, brings: Mapping[str, str] | None
    ) -> int:
        chosen = self._next(held, now, brings)
        if chosen is None:
            if brings and self._next(held, now) is not None:
                said = ", ".join(f"{name} = {level}" for name, level in brings.items())
                raise InputError(
                    f"{self.where}: {said}: every slot of that group is complete or live: expected "
                    "somebody of another one"
                )
            live = [e.participant for e in self._select(at, store.ENTRIES.c.status == LIVE)]
            names = ", ".join(live[:5]) + (" …" if len(live) > 5 else "")
            raise InputError(
                f"{self.where}: every slot is complete or live ({len(live)} live: {names}): "
                "expected them to end, or `seethrough withdraw` for who will not come back"
            )
        return chosen

    def _free(self, at: Connection, slot: int, now: datetime, by: str) -> None:
        """Take a held slot from a stale holder; refuse if somebody else has it."""
        holder = self._holder(at, slot)
        assert holder is not None
        stale = holder.changed < stale_before(now, self.plan.stale_after)
        if holder.status != LIVE or not stale:
            raise InputError(
                f"--slot = {slot}: {holder.participant} has it ({holder.status} since "
                f"{holder.changed}): expected a free one"
            )
        self._change(at, holder, VOID, now, f"{STALE}; slot given to {by}")

    def _go_on(self, at: Connection, mine: Entry, now: datetime, slot: int | None) -> Entry:
        """The entry of a participant who is known: live goes on, stale too while it can."""
        if slot not in (None, mine.slot):
            raise InputError(f"--slot = {slot}: {mine.participant} has slot {mine.slot}")
        stale = mine.status == VOID and mine.why.startswith(STALE)
        if mine.status == LIVE or (stale and self._holder(at, mine.slot) is None):
            return self._change(at, mine, LIVE, now, "")
        raise InputError(
            f"--participant = {mine.participant}: {_said(mine)}; the next free one is "
            f"{self._free_name(at, ())}"
        )

    def _find(self, at: Connection, participant: str) -> Entry | None:
        """The participant's entry. Ids that differ in case only share a folder on some disks."""
        lower = sql.func.lower(store.ENTRIES.c.participant)
        found = self._select(at, lower == participant.lower())
        if not found:
            return None
        same = next((e for e in found if e.participant == participant), None)
        if same is None:
            raise InputError(
                f"--participant = {participant}: expected an id that differs from "
                f"{found[0].participant} in more than upper and lower case"
            )
        return same

    def _known(self, at: Connection, participant: str) -> Entry:
        entry = self._find(at, participant)
        if entry is None:
            raise InputError(f"{self.where}: participant = {participant}: not in the ledger")
        return entry

    def _change(self, at: Connection, entry: Entry, status: str, now: datetime, why: str) -> Entry:
        changed = replace(entry, status=status, changed=stamp(now), why=why)
        values = {"status": status, "changed": changed.changed, "why": why}
        at.execute(store.ENTRIES.update().where(self._is(entry.participant)).values(values))
        sums.keep(at, self.plan.study, changed)
        return changed

    def _insert(self, at: Connection, entry: Entry) -> None:
        values = {
            "study": self.plan.study, "slot": entry.slot, "participant": entry.participant,
            "status": entry.status, "reserved": entry.reserved, "changed": entry.changed,
            "why": entry.why,
        }  # fmt: skip
        at.execute(store.ENTRIES.insert().values(values))
        sums.keep(at, self.plan.study, entry)

    def _is(self, participant: str) -> sql.ColumnElement[bool]:
        c = store.ENTRIES.c
        return (c.study == self.plan.study) & (c.participant == participant)

    def _check_study(self, at: Connection, now: datetime) -> None:
        """Enter the study, or check that it is the one the ledger began with."""
        plan, c = self.plan, store.STUDIES.c
        rows = at.execute(store.STUDIES.select()).all()
        if any(row.name == plan.study for row in rows):
            sums.verify(at, plan.study, self.where)
        known = [_plan(row) for row in rows]
        same = next((p for p in known if p.study == plan.study), None)
        if same is not None and same.digest != plan.digest:
            raise InputError(f"{self.where}: {difference(same, plan)}")
        if same is None and known and self._engine.dialect.name == "sqlite":
            raise InputError(
                f"{self.where}: study.name = {plan.study!r}: expected {known[0].study!r}, whose "
                "data folder this is; choose another one with --data"
            )
        if same is None:
            values = {
                c.name: plan.study, c.digest: plan.digest, c.rows: plan.rows,
                c.participants: plan.participants, c.stale_after: plan.stale_after,
                c.resolved: json.dumps(plan.resolved), c.begun: stamp(now),
            }  # fmt: skip
            at.execute(store.STUDIES.insert().values(values))
            sums.keep_study(at, plan.study)


def study_in(data: Path) -> str:
    """The name of the study whose data the folder holds, "" where none does yet. Raises
    InputError for a description that cannot be read, or does not say it."""
    path = data / "dataset_description.json"
    if not is_there(path):
        return ""
    name = read_object(path).get("name")
    if not isinstance(name, str):
        raise InputError(f"{path}: name = {shown(name)}: expected a text")
    return name


def _where(engine: Engine) -> str:
    url = engine.url
    return str(url.database) if url.get_backend_name() == "sqlite" else store.shown(url)


def _said(entry: Entry) -> str:
    return f"{entry.status} since {entry.changed}" + (f" ({entry.why})" if entry.why else "")


def _plan(row: Row[Any]) -> Plan:
    return Plan(
        row.name, row.digest, row.rows, row.participants, row.stale_after, json.loads(row.resolved)
    )
