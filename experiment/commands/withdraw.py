"""`seethrough withdraw`: remove a participant's data, leave a dated mark in the ledger."""

from __future__ import annotations

import argparse
import shutil
import sys
from datetime import UTC, datetime
from pathlib import Path

from experiment.errors import InputError
from experiment.folders import check_participant, folder_of
from experiment.repair import set_aside

WITHDRAWN = "withdrawn"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument("--participant", metavar="ID", required=True)
    parser.add_argument("--why", default="", metavar="TEXT", help="goes into the ledger; no names")
    parser.add_argument("--keep-files", action="store_true", help="only free the slot")
    parser.add_argument("--yes", action="store_true", help="do not ask")
    parser.add_argument("--ledger", default="", metavar="URL", help="where it is, if not noted")


def run(arguments: argparse.Namespace) -> int:
    """Remove and mark; 0 when done, 1 when the answer was no."""
    from experiment.ledger import Ledger
    from experiment.ledger_files import mark_withdrawn, reconcile
    from experiment.ledger_lock import playing

    data, participant = arguments.data, check_participant(arguments.participant)
    folder = folder_of(data, "human", participant)
    if folder.is_symlink():
        raise InputError(f"{folder}: a link: expected a folder")
    now = datetime.now(UTC)
    with Ledger.existing(data, arguments.ledger) as ledger:
        reconcile(ledger, data, now)
        if participant not in {e.participant for e in ledger.entries()}:
            raise InputError(f"{ledger.where}: participant = {participant}: not in the ledger")
        # Also what `repair` set aside.
        aside = set_aside(data, "human", participant)
        files = [p for place in (folder, *aside) for p in place.rglob("*") if not p.is_dir()]
        if not arguments.yes and not _sure(participant, len(files), arguments.keep_files):
            print("nothing was changed")
            return 1
        # The mark first: were this to stop halfway, it says what is to be done again.
        why = WITHDRAWN + (f": {arguments.why}" if arguments.why else "")
        with playing(ledger.locks(), participant):  # refused while a session runs
            slot = ledger.void(participant, why, now).slot
            mark_withdrawn(data, participant, slot, now)
    if not arguments.keep_files and files:
        for place in (folder, *aside):
            if place.exists():
                _remove(place)
        print(
            f"{len(files)} files removed; reports and exports made before still hold {participant}"
        )
    print(f"{participant}: withdrawn; slot {slot} is free")
    return 0


def _sure(participant: str, files: int, keep: bool) -> bool:
    what = "free the slot" if keep else f"remove {files} files for good and free the slot"
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
