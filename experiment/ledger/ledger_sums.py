"""A checksum for each row of the ledger: SQLite keeps none, and a flipped bit changes a slot."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import astuple

import sqlalchemy as sql
from sqlalchemy.engine import Connection

from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger import ledger_store as store
from seethrough.experiment.ledger.ledger_slots import Entry

STUDY = ""  # stands for the study's own row: no participant has this id


def keep(at: Connection, study: str, entry: Entry) -> None:
    """Note an entry's sum, new or changed."""
    *values, _ = astuple(entry)
    _keep(at, study, entry.participant, values)


def keep_study(at: Connection, study: str) -> None:
    """Note the sum of a study's own row."""
    _keep(at, study, STUDY, _study(at, study))


def forget(at: Connection, study: str, participant: str) -> None:
    """An entry is no more."""
    at.execute(store.SUMS.delete().where(_is(study, participant)))


def verify(at: Connection, study: str, where: str) -> None:
    """Raises InputError naming a row that is not as it was written.

    A ledger from before there were sums gets them.
    """
    c, s = store.ENTRIES.c, store.SUMS.c
    columns = (c.slot, c.participant, c.status, c.reserved, c.changed, c.why)
    entries = at.execute(sql.select(*columns).where(c.study == study)).all()
    rows = {STUDY: _study(at, study)} | {row.participant: list(row) for row in entries}
    kept = dict(at.execute(sql.select(s.participant, s.sum).where(s.study == study)).all())
    if not kept:
        for participant, values in rows.items():
            _keep(at, study, participant, values)
        return
    for participant in rows.keys() | kept.keys():
        if kept.get(participant) != _sum(rows.get(participant, ())):
            what = f"participant = {participant!r}" if participant else "the study's row"
            raise InputError(f"{where}: {store.DAMAGED}: {what}")


def _study(at: Connection, study: str) -> list[object]:
    row = at.execute(store.STUDIES.select().where(store.STUDIES.c.name == study)).one()
    return list(row)


def _keep(at: Connection, study: str, participant: str, values: Sequence[object]) -> None:
    new = {"study": study, "participant": participant, "sum": _sum(values)}
    changed = store.SUMS.update().where(_is(study, participant)).values(sum=new["sum"])
    if at.execute(changed).rowcount == 0:
        at.execute(store.SUMS.insert().values(new))


def _is(study: str, participant: str) -> sql.ColumnElement[bool]:
    return (store.SUMS.c.study == study) & (store.SUMS.c.participant == participant)


def _sum(values: Sequence[object]) -> str:
    return hashlib.sha256(json.dumps(list(values)).encode()).hexdigest()
