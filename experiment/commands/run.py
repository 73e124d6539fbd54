"""`seethrough run`: a participant's session in a window."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from experiment.clock import RealClock
from experiment.config import load
from experiment.errors import InputError
from experiment.live import play_in_window
from experiment.recorder import check_participant, next_free, taken


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    who = parser.add_mutually_exclusive_group(required=True)
    who.add_argument("--participant", metavar="ID", help="letters, digits, - and _; never a name")
    who.add_argument("--next", action="store_true", help="the next free id: P01, P02, …")
    parser.add_argument("--data", type=Path, metavar="DIR", help="default: data/STUDY")
    parser.add_argument("--slot", type=int, metavar="N", help="row of the design; default: in turn")


def run(arguments: argparse.Namespace) -> int:
    """Run the session; 0 when it was completed, 1 when it was left."""
    study = load(arguments.study)
    data = arguments.data or Path("data") / study.study.name
    participant = next_free(data, "human") if arguments.next else arguments.participant
    check_participant(participant)
    slot = _slot(arguments.slot, data)
    print(f"participant {participant}, slot {slot}, data in {data}", file=sys.stderr)
    status = play_in_window(study, participant, slot, "human", data, RealClock())
    print(f"session {status}: {participant} in {data}")
    return 0 if status == "complete" else 1


def _slot(wanted: int | None, data: Path) -> int:
    """The row asked for, else one more than sessions there are."""
    if wanted is not None and wanted < 1:
        raise InputError(f"--slot = {wanted}: expected at least 1")
    return wanted or len(taken(data, "human")) + 1
