"""`seethrough run`: a participant's session in a window."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

from seethrough.experiment.display.interrupt import check, deferred
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import check_participant, folder_of, next_free, taken
from seethrough.experiment.files.private import make_folder
from seethrough.experiment.study.config import Study, find, load, shipped
from seethrough.experiment.study.design.factors import is_measured
from seethrough.renderer.meant import one_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    who = parser.add_mutually_exclusive_group(required=True)
    who.add_argument("--participant", metavar="ID", help="letters, digits, - and _; never a name")
    who.add_argument("--next", action="store_true", help="the next free id: P01, P02, …")
    parser.add_argument("--data", type=Path, metavar="DIR", help="default: data/STUDY")
    parser.add_argument(
        "--slot", type=int, metavar="N", help="row of the design; default: the ledger's next"
    )
    parser.add_argument(
        "--set", metavar="FACTOR=LEVEL", action="append", default=[], dest="brings",
        help="what the participant brings along: the level of a measured factor",
    )  # fmt: skip
    parser.add_argument(
        "--pilot", action="store_true", help="a try: other folder, no slot, never in a report"
    )
    parser.add_argument(
        "--ledger", default="", metavar="URL", help="postgresql://USER@HOST/DATABASE, for stations"
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the session; 0 when it was completed, 1 when it was left."""
    with deferred():
        return _run(arguments)


def _run(arguments: argparse.Namespace) -> int:
    study = load(arguments.study)
    data = arguments.data or Path("data") / study.general.name
    if arguments.participant is not None:
        check_participant(arguments.participant)
    if arguments.slot is not None and arguments.slot < 1:
        raise InputError(f"--slot = {arguments.slot}: expected at least 1")
    participant, status = (_pilot if arguments.pilot else _human)(study, data, arguments)
    print(f"session {status}: {participant} in {data}")
    return 0 if status == "complete" else 1


def _brought(study: Study, said: Sequence[str], ask: bool) -> dict[str, str]:
    """The level of every measured factor, from the command line or asked on the terminal, before a
    slot is taken. Raises InputError."""
    measured = {f.name: f for f in study.factors if is_measured(f)}
    brings: dict[str, str] = {}
    for text in said:
        name, _, level = text.partition("=")
        if name not in measured or level not in measured[name].names:
            known = [f"{f.name}={level}" for f in measured.values() for level in f.names]
            none = "none: the study has no measured factor"
            expected = one_of(text, known) if known else none
            raise InputError(f"--set = {text}: expected {expected}")
        brings[name] = level
    for factor in (f for name, f in measured.items() if ask and name not in brings):
        levels = ", ".join(factor.names)
        if not sys.stdin.isatty():
            raise InputError(f"--set: missing, expected {factor.name}=LEVEL, one of {levels}")
        level = input(f"{factor.text or factor.name} ({levels}): ").strip()
        if level not in factor.names:
            raise InputError(f"{factor.name} = {level}: expected {one_of(level, factor.names)}")
        brings[factor.name] = level
    return brings


def _check_brought(study: Study, slot: int, brings: Mapping[str, str]) -> None:
    """The slot that a participant has or asks for is one of their group. Raises InputError."""
    group = study.plan.groups[study.plan.group_of(slot)[0]]
    for name, level in group.measured.items():
        if brings.get(name, level) != level:
            raise InputError(f"--set = {name}={brings[name]}: slot {slot} is of {name}={level}")


def _pilot(study: Study, data: Path, arguments: argparse.Namespace) -> tuple[str, str]:
    """A pilot run takes no slot from anybody."""
    from seethrough.experiment.ledger import ledger_place as place
    from seethrough.experiment.ledger import ledger_store as store
    from seethrough.experiment.ledger.ledger_lock import Locks, playing

    participant = arguments.participant or next_free(data, "pilot")
    slot = arguments.slot or len(taken(data, "pilot")) + 1
    make_folder(data)
    locks = Locks(
        store.connect(store.sqlite_url(data / place.LOCKS)), f"{study.general.name} pilot"
    )
    with playing(locks, participant) as guard:
        return participant, _play(study, participant, slot, "pilot", data, guard)


def _human(study: Study, data: Path, arguments: argparse.Namespace) -> tuple[str, str]:
    """A participant's session in the slot that the ledger gives."""
    from seethrough.experiment.files.network_drive import network_drive
    from seethrough.experiment.ledger import ledger_place as place
    from seethrough.experiment.ledger.ledger import (
        Ledger,  # SQLAlchemy: only where a ledger is needed
    )
    from seethrough.experiment.ledger.ledger_files import reconcile
    from seethrough.experiment.ledger.ledger_lock import playing
    from seethrough.experiment.ledger.ledger_place import note_study
    from seethrough.experiment.ledger.ledger_plan import plan_of

    url, plan = arguments.ledger or study.session.ledger, plan_of(study)
    begun = arguments.participant and folder_of(data, "human", arguments.participant).exists()
    # Who goes on, or has a slot by number, has their group.
    brings = _brought(study, arguments.brings, ask=not begun and arguments.slot is None)
    if not place.exists_elsewhere(data, url) and (kind := network_drive(data)):
        print(
            f"{data}: a network drive ({kind}): the ledger's locks may not hold between stations; "
            "expected --ledger postgresql://… where there are several",
            file=sys.stderr,
        )
    with Ledger.open(data, url, plan, _now()) as ledger:
        for line in reconcile(ledger, data, _now()):
            print(line, file=sys.stderr)
        path = find(arguments.study)
        note_study(data, path, path.stem if path in shipped().values() else "")
        used = taken(data, "human")
        entry = ledger.reserve(arguments.participant, _now(), arguments.slot, used, brings)
        _check_brought(study, entry.slot, brings)
        locks = ledger.locks()
    # The session takes an hour, in which a connection may be lost: the ledger is opened again.
    try:
        check()
        with playing(locks, entry.participant) as guard:
            status = _play(study, entry.participant, entry.slot, "human", data, guard)
    except (InputError, KeyboardInterrupt):
        if entry.new and not folder_of(data, "human", entry.participant).exists():
            with Ledger.open(data, url, plan, _now()) as ledger:
                ledger.cancel(entry.participant)
        raise
    try:
        if status != "left":
            with Ledger.open(data, url, plan, _now()) as ledger:
                if status == "complete":
                    ledger.complete(entry.participant, _now())
                else:
                    # Nobody goes on after the study's own limit: the row is somebody else's.
                    ledger.void(entry.participant, status, _now())
    except InputError as error:
        later = ": `seethrough status` enters it" if status == "complete" else ""
        raise InputError(
            f"{error}; the session of {entry.participant} is {status} on disk{later}"
        ) from None
    return entry.participant, status


def _play(
    study: Study, participant: str, slot: int, source: str, data: Path, guard: Callable[[], None]
) -> str:
    from seethrough.experiment.display.clock import RealClock
    from seethrough.experiment.session.live import (
        play_in_window,  # OpenGL and the window: not for --help
    )

    check()
    what = "pilot run, " if source == "pilot" else ""
    print(f"{what}participant {participant}, slot {slot}, data in {data}", file=sys.stderr)
    return play_in_window(study, participant, slot, source, data, RealClock(), guard=guard)


def _now() -> datetime:
    return datetime.now(UTC)
