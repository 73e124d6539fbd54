"""`seethrough repair`: one participant's folder that two sessions wrote at once, made one again."""

from __future__ import annotations

import argparse
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import check_participant, folder_of, taken

if TYPE_CHECKING:
    from seethrough.experiment.ledger.ledger_lock import Locks


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument("--participant", metavar="ID", help="default: all that were played twice")
    parser.add_argument("--keep", type=int, metavar="N", help="the last session of what counts")
    parser.add_argument("--ledger", default="", metavar="URL", help="where it is, if not noted")


def run(arguments: argparse.Namespace) -> int:
    """Repair, or say what there is to choose from: 0, or 1 where a choice is needed."""
    from seethrough.experiment.ledger.ledger_lock import playing
    from seethrough.experiment.record.repair import (
        branches,
        described,
        finished,
        repair,
        sessions_of,
    )

    data, wanted = arguments.data, arguments.participant
    for name in finished(data, "human"):
        print(f"{name}: a repair was broken off: it is done now")
    if wanted is not None and not folder_of(data, "human", check_participant(wanted)).is_dir():
        raise InputError(f"{data}: --participant = {wanted}: no such participant")
    if arguments.keep is not None and wanted is None:
        raise InputError(f"--keep = {arguments.keep}: expected --participant with it")
    twice = {}
    for name in [wanted] if wanted else sorted(taken(data, "human")):
        found = branches(sessions_of(folder_of(data, "human", name)))
        if len(found) > 1:
            twice[name] = found
    if not twice:
        print("nobody was played twice at once: nothing was changed")
        return 0
    if arguments.keep is None:
        for name, found in twice.items():
            print(f"{name}: played twice at once; which counts?")
            print("\n".join(f"  {described(number, branch)}" for number, branch in found.items()))
        print(f"seethrough repair {data} --participant ID --keep N", file=sys.stderr)
        return 1
    found = twice[wanted]
    if arguments.keep not in found:
        raise InputError(f"--keep = {arguments.keep}: expected one of {', '.join(map(str, found))}")
    with playing(_locks(data, arguments.ledger), wanted):
        place = repair(data, "human", wanted, arguments.keep, _now())
    print(f"{wanted}: {described(arguments.keep, found[arguments.keep])}: counts")
    print(f"{wanted}: the folder as it was is in {place}")
    return 0


def _locks(data: Path, url: str) -> Locks:
    from seethrough.experiment.ledger import ledger_place as place
    from seethrough.experiment.ledger import ledger_store as store
    from seethrough.experiment.ledger.ledger import Ledger
    from seethrough.experiment.ledger.ledger_lock import Locks

    if place.exists(data, url):
        with Ledger.existing(data, url) as ledger:
            return ledger.locks()
    return Locks(store.connect(store.sqlite_url(data / place.LOCKS)), "")


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
