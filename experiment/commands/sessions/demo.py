"""`seethrough demo`: the short study, by a person or a simulated participant, and its report."""

from __future__ import annotations

import argparse
import sys
import webbrowser
from pathlib import Path

from seethrough.experiment import cli
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import SIMULATED, generator

SPEED = 8.0  # watched, the simulated participant would take minutes at real speed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument(
        "--simulated", action="store_true", help="watch a simulated participant in the window"
    )
    parser.add_argument(
        "--speed", type=float, default=SPEED, metavar="X", help=f"of watching; default: {SPEED:g}"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="default: out/demo-1, -2, …")
    parser.add_argument("--no-open", action="store_true", help="do not open the report")


def run(arguments: argparse.Namespace) -> int:
    """Play the demo study, make its report, print where it is."""
    out = arguments.out or _next_folder(Path("out"))
    if _desktop():
        status = _in_window(out / "data", arguments.simulated, arguments.speed)
    else:
        print("no display: a simulated participant plays offscreen", file=sys.stderr)
        status = _offscreen(out / "data")
    made = cli.main(["report", str(out / "data"), "--out", str(out / "report")])
    if made != 0:
        return made
    report = (out / "report" / "report.html").resolve()
    print(f"session {status}; report: {report}")
    if _desktop() and not arguments.no_open:
        webbrowser.open(report.as_uri())
    return 0


def _desktop() -> bool:
    from seethrough.experiment.display.system_window import (
        available,
    )  # only here: needs no display, but costs time

    return available()


def _next_folder(parent: Path) -> Path:
    number = 1
    while (parent / f"demo-{number}").exists():
        number += 1
    return parent / f"demo-{number}"


def _in_window(data: Path, simulated: bool, speed: float) -> str:
    from seethrough.experiment.display.clock import RealClock, WatchClock
    from seethrough.experiment.session.live import play_in_window

    study = load("demo")
    if not simulated:
        return play_in_window(study, "P01", 1, "human", data, RealClock())
    from seethrough.experiment.people.participant import SimulatedParticipant

    seed, clock = 1, WatchClock(speed)
    person = SimulatedParticipant(generator(seed, (SIMULATED, 1)))
    about = person.about(seed)
    return play_in_window(study, "S01", 1, "simulated", data, clock, watched=person, about=about)


def _offscreen(data: Path) -> str:
    from seethrough.experiment.commands.sessions.simulate import simulate

    simulate(load("demo"), 1, 1, data)
    return "complete"
