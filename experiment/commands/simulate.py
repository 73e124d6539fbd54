"""`seethrough simulate`: simulated participants play a study through the real session code."""

from __future__ import annotations

import argparse
from pathlib import Path

from experiment.clock import SimulatedClock
from experiment.config import Study, load
from experiment.design import SIMULATED, generator
from experiment.errors import InputError
from experiment.offscreen import OffscreenDisplay
from experiment.participants.participant import SimulatedParticipant
from experiment.progress import Progress
from experiment.provenance import provenance
from experiment.recorder import FileRecorder, Who
from experiment.session import World, run_session
from experiment.simulated_input import SimulatedInput
from renderer.gpu.context import standalone
from tasks.catalog import TASKS


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--participants", type=int, metavar="N", help="default: the study's number")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="default: 1")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="data folder")


def run(arguments: argparse.Namespace) -> int:
    """Play the study; 0 when every participant completed it."""
    study = load(arguments.study)
    count = study.study.participants if arguments.participants is None else arguments.participants
    if count < 1:
        raise InputError(f"--participants = {count}: expected at least 1")
    if arguments.seed < 0:
        raise InputError(f"--seed = {arguments.seed}: expected a number that is not negative")
    simulate(study, count, arguments.seed, arguments.out)
    print(f"{count} simulated participants in {arguments.out}")
    return 0


def simulate(study: Study, count: int, seed: int, out: Path) -> None:
    """Play `count` sessions into the data folder `out`. Raises InputError if they are there."""
    context = standalone()
    trials = sum(len(s.trials) for s in _sets(study)) * count
    with Progress("simulating", trials) as progress:
        for slot in range(1, count + 1):
            _one(study, slot, seed, out, context, progress)


def _sets(study: Study):  # type: ignore[no-untyped-def]
    from experiment.design import session_for

    return session_for(1, study.design.factors())


def _one(study: Study, slot: int, seed: int, out: Path, context, progress: Progress) -> None:  # type: ignore[no-untyped-def]
    clock = SimulatedClock()
    display = OffscreenDisplay(context, (study.display.width, study.display.height), clock)
    participant = SimulatedParticipant(generator(seed, (SIMULATED, slot)))
    who = Who(
        study.study.name,
        f"S{slot:02d}",
        "simulated",
        slot,
        provenance(study, display.describe(), simulation_seed=seed),
    )
    world = World(
        display,
        SimulatedInput(participant, display, clock),
        clock,
        FileRecorder(out, who),
        TASKS,
        lambda record: progress.step(f"S{slot:02d} {record.trial.task}"),
    )
    run_session(study, slot, world)
