"""`seethrough withdraw`: remove a participant's data, leave a dated mark in the ledger."""

from __future__ import annotations

import argparse
import shutil
import sys
from datetime import UTC, datetime
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import check_participant, folder_of
from seethrough.experiment.record.repair import set_aside

WITHDRAWN, FREED = "withdrawn", "the slot was freed, the data stay"
SOURCES = ("human", "pilot", "simulated")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument("--participant", metavar="ID", required=True)
    parser.add_argument(
        "--source", choices=SOURCES, help="whose, where several have a participant of that id"
    )
    parser.add_argument("--why", default="", metavar="TEXT", help="goes into the ledger; no names")
    parser.add_argument(
        "--keep-files", action="store_true", help="only free the slot: the data stay and count"
    )
    parser.add_argument("--yes", action="store_true", help="do not ask")
    parser.add_argument("--ledger", default="", metavar="URL", help="where it is, if not noted")


def run(arguments: argparse.Namespace) -> int:
    """Remove and mark; 0 when done, 1 when the answer was no."""
    data, participant = arguments.data, check_participant(arguments.participant)
    source = arguments.source or _source(data, participant)
    folder = folder_of(data, source, participant)
    if folder.is_symlink():
        raise InputError(f"{folder}: a link: expected a folder")
    if source != "human":
        return _without_slot(arguments, source, folder)
    return _human(arguments, data, participant, folder)


def _source(data: Path, participant: str) -> str:
    """Whose files there are: a person's, unless only a pilot or a simulated participant has any."""
    there = [s for s in SOURCES if folder_of(data, s, participant).exists()]
    if len(there) > 1:
        raise InputError(
            f"--source: expected one of {', '.join(there)}, which all have {participant}"
        )
    return there[0] if there else "human"


def _without_slot(arguments: argparse.Namespace, source: str, folder: Path) -> int:
    """Pilots and simulated participants take nobody's slot: no ledger knows them."""
    participant = arguments.participant
    if not folder.is_dir():
        raise InputError(f"{folder}: no such {source} participant: expected one with files")
    if arguments.keep_files:
        raise InputError(f"--keep-files: a {source} participant has no slot to free")
    files = [p for p in folder.rglob("*") if not p.is_dir()]
    if not arguments.yes and not _sure(participant, f"remove {len(files)} files for good"):
        print("nothing was changed")
        return 1
    _remove(folder)
    print(f"{participant}: {len(files)} files of a {source} participant removed")
    return 0


def _human(arguments: argparse.Namespace, data: Path, participant: str, folder: Path) -> int:
    from seethrough.experiment.ledger.ledger import Ledger
    from seethrough.experiment.ledger.ledger_files import mark_withdrawn, reconcile
    from seethrough.experiment.ledger.ledger_lock import playing

    now = datetime.now(UTC)
    with Ledger.existing(data, arguments.ledger) as ledger:
        reconcile(ledger, data, now)
        if participant not in {e.participant for e in ledger.entries()}:
            raise InputError(f"{ledger.where}: participant = {participant}: not in the ledger")
        # Also what `repair` set aside.
        aside = set_aside(data, "human", participant)
        files = [p for place in (folder, *aside) for p in place.rglob("*") if not p.is_dir()]
        freed = "free the slot"
        what = freed if arguments.keep_files else f"remove {len(files)} files for good and {freed}"
        if not arguments.yes and not _sure(participant, what):
            print("nothing was changed")
            return 1
        # The mark first: were this to stop halfway, it says what is to be done again.
        # Who keeps their files has not withdrawn their data, which still count.
        mark = FREED if arguments.keep_files else WITHDRAWN
        why = mark + (f": {arguments.why}" if arguments.why else "")
        with playing(ledger.locks(), participant):  # refused while a session runs
            slot = ledger.void(participant, why, now).slot
            if not arguments.keep_files:
                mark_withdrawn(data, participant, slot, now)
    if not arguments.keep_files and files:
        for place in (folder, *aside):
            if place.exists():
                _remove(place)
        print(
            f"{len(files)} files removed; reports and exports made before still hold {participant}"
        )
    print(f"{participant}: {mark}; slot {slot} is free")
    return 0


def _sure(participant: str, what: str) -> bool:
    if not sys.stdin.isatty():
        raise InputError("--yes: expected, where nobody can be asked")
    try:
        said = input(f"{what} of {participant}? Type {participant} to confirm: ")
    except EOFError:
        return False
    return said.strip() == participant


def _remove(folder: Path) -> None:
    try:
        shutil.rmtree(folder)
    except OSError as error:
        raise InputError(
            f"{error.filename}: cannot be removed: {error.strerror}; expected to be withdrawn again"
        ) from None
