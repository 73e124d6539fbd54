"""The ledger held against the files: what a crash kept from it is entered from them."""

from __future__ import annotations

import os
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.files import is_there
from seethrough.analysis.load.ledger import WITHDRAWN, withdrawn_rows
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import PARTICIPANT, check_participant, folder_of, taken
from seethrough.experiment.files.json_files import number_in, read_object
from seethrough.experiment.files.private import write, write_new
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_slots import (
    COMPLETE,
    LIVE,
    SURPLUS,
    VOID,
    Entry,
    moment,
    stamp,
)

SOURCE = "human"


def withdrawn(data: Path) -> dict[str, tuple[int, str]]:
    """{id: (slot, when)} of who was withdrawn: kept beside the ledger, which may be lost."""
    try:
        return {
            check_participant(name): (int(slot), stamp(moment(when)))
            for name, slot, when in withdrawn_rows(data)
        }
    except (DataError, ValueError, InputError) as error:
        raise InputError(
            f"{data / WITHDRAWN}: expected participant, slot and date in each row: {error}"
        ) from None


def mark_withdrawn(data: Path, participant: str, slot: int, now: datetime) -> None:
    """Note it for good: neither the id nor the files come back. Raises OSError."""
    path = data / WITHDRAWN
    if participant in withdrawn(data):
        return
    if not is_there(path):
        with suppress(FileExistsError):  # another station withdraws somebody too
            write_new(path, "participant,slot,withdrawn\n")
    file = os.open(path, os.O_WRONLY | os.O_APPEND)
    try:
        write(file, f"{participant},{slot},{stamp(now)}\n".encode())
        os.fsync(file)
    finally:
        os.close(file)


def reconcile(ledger: Ledger, data: Path, now: datetime) -> tuple[str, ...]:
    """Enter participants who have files but no entry; complete those whose files are complete.

    So a ledger that was lost is made again from its data folder. Returns a line for each change.
    """
    entries = {entry.participant: entry for entry in ledger.entries()}
    held = {e.slot for e in entries.values() if e.status in (LIVE, COMPLETE)}
    said = []
    for name, (slot, when) in withdrawn(data).items():
        if name not in entries:
            void = Entry(slot, name, VOID, when, when, "withdrawn")
            ledger.add([void])
            entries[name] = void
            said.append(f"{name}: withdrawn, not in the ledger: entered as void")
    for name in sorted(taken(data, SOURCE)):
        entry = entries.get(name)
        if entry is not None and entry.status not in (LIVE, VOID):
            continue
        found = _found(data, name, now)
        if entry is None and found is not None:
            if found.slot in held:
                found = _without_slot(found)
            held.add(found.slot)
            ledger.add([found])
            said.append(f"{name}: not in the ledger: entered as {found.status}, slot {found.slot}")
        elif entry is not None and entry.status == LIVE and found and found.status == COMPLETE:
            ledger.complete(name, now)
            said.append(f"{name}: complete on disk, live in the ledger: completed")
    return tuple(said)


def _without_slot(entry: Entry) -> Entry:
    """A participant whose slot somebody else holds: complete ones are kept apart."""
    status = SURPLUS if entry.status == COMPLETE else VOID
    why = "" if status == SURPLUS else "the slot was somebody else's already"
    return Entry(entry.slot, entry.participant, status, entry.reserved, entry.changed, why)


def _found(data: Path, name: str, now: datetime) -> Entry | None:
    """The entry that a participant's files make; None where no session began."""
    folder = folder_of(data, SOURCE, name)
    sidecars = sorted(folder.glob("*_trials_data.json"))
    if not PARTICIPANT.fullmatch(name) or not sidecars:
        return None
    first = read_object(sidecars[0])
    complete = any(ends_complete(folder))
    try:
        began = stamp(min(now, moment(str(first["started"]))))
    except (KeyError, TypeError, ValueError):
        raise InputError(f"{sidecars[0]}: started: expected when it started") from None
    slot = number_in(first, "slot", sidecars[0])
    return Entry(slot, name, COMPLETE if complete else LIVE, began, began)


def ends_complete(folder: Path) -> list[bool]:
    """Of each session in a participant's folder that ended: whether it was complete."""
    ends = [read_object(path) for path in sorted(folder.glob("*_end.json"))]
    return [end.get("status") == "complete" for end in ends]
