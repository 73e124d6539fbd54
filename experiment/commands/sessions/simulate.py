"""`seethrough simulate`: simulated participants play a study."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.persons.profile_file import find, names
from seethrough.experiment.session.progress import Progress
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.design.design import SIMULATED, generator, session_for
from seethrough.tasks.kit.skills.effects import EFFECTS, checked
from seethrough.tasks.kit.skills.profile import AVERAGE, Profile

if TYPE_CHECKING:
    from seethrough.experiment.record.trial_record import TrialRecord

MOST_WORKERS = 256
POOL = 200  # scenes a task in data mode


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--participants", type=int, metavar="N", help="default: the study's number")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="default: 1")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="data folder")
    parser.add_argument(
        "--profile", default="average", help=f"{', '.join(names())}, or a profile file (TOML)"
    )
    parser.add_argument(
        "--without", default="", metavar="E,…", help=f"effects to leave out: {', '.join(EFFECTS)}"
    )
    parser.add_argument(
        "--explain", action="store_true", help="print which effects each trial used, and why"
    )
    parser.add_argument("--watch", action="store_true", help="play it in the window, at real speed")
    parser.add_argument(
        "--mode",
        choices=("visual", "data"),
        default="visual",
        help="visual: the real session, drawn and looked at; data: from visibility tables",
    )
    parser.add_argument("--workers", type=int, default=1, metavar="W", help="processes; default: 1")
    data = parser.add_argument_group("data mode")
    data.add_argument("--tables", type=Path, metavar="FILE", help="visibility tables, kept")
    data.add_argument("--pool", type=int, default=POOL, metavar="K", help="scenes a task")
    data.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, tcp://HOST:PORT")


def run(arguments: argparse.Namespace) -> int:
    """Play the study; 0 when every participant completed it."""
    from seethrough.experiment.people.runs.out_folder import check_folder, check_visual

    study = load(arguments.study)
    count = study.general.participants if arguments.participants is None else arguments.participants
    if count < 1:
        raise InputError(f"--participants = {count}: expected at least 1")
    if arguments.seed < 0:
        raise InputError(f"--seed = {arguments.seed}: expected a number that is not negative")
    try:
        without = checked(e for e in arguments.without.split(",") if e)
    except ValueError as error:
        raise InputError(str(error)) from None
    profile = find(arguments.profile)
    check_folder(arguments.out, study.general.name)
    if arguments.mode == "data":
        _data_mode(arguments, count, profile, without)
    else:
        if arguments.tables or arguments.scheduler:
            raise InputError("--scheduler and --tables: expected with --mode data only")
        workers = _workers(arguments)
        if workers > 1 and (arguments.explain or arguments.watch):
            raise InputError("--explain and --watch: expected with one worker")
        check_visual(arguments.out, [f"S{slot:02d}" for slot in study.plan.slots(count)])
        if arguments.watch:
            return _watch(study, count, arguments.seed, arguments.out, profile, without)
        simulate(
            study,
            count,
            arguments.seed,
            arguments.out,
            profile,
            without,
            arguments.explain,
            workers,
        )
    print(f"{count} simulated participants in {arguments.out}")
    return 0


def simulate(
    study: Study,
    count: int,
    seed: int,
    out: Path,
    profile: Profile = AVERAGE,
    without: frozenset[str] = frozenset(),
    explain: bool = False,
    workers: int = 1,
) -> None:
    """Play `count` sessions into the data folder `out`. Raises InputError if they are there."""
    from seethrough.experiment.people.runs import visual

    job = visual.Visual(study, seed, out, profile, without)
    slots = study.plan.slots(count)
    if workers > 1:
        with Progress("simulating", count) as progress:
            for slot in visual.play(job, slots, workers):
                progress.step(f"S{slot:02d}")
        return
    seat = visual.Seat(job)
    trials = sum(len(s.trials) for slot in slots for s in session_for(slot, study.plan))
    with Progress("simulating", trials) as progress:
        for slot in slots:

            def ended(record: TrialRecord, person: SimulatedParticipant, slot: int = slot) -> None:
                progress.step(f"S{slot:02d} {record.trial.task}")
                if explain:
                    _explain(f"S{slot:02d} trial {record.trial.number} {record.trial.task}", person)

            seat.play(slot, ended)


def _watch(
    study: Study, count: int, seed: int, out: Path, profile: Profile, without: frozenset[str]
) -> int:
    """Play the sessions in a window until somebody leaves one."""
    from seethrough.experiment.display.clock import RealClock
    from seethrough.experiment.session.live import play_in_window

    for slot in study.plan.slots(count):
        person = SimulatedParticipant(generator(seed, (SIMULATED, slot)), profile, without)
        name = f"S{slot:02d}"
        about = person.about(seed)
        status = play_in_window(
            study, name, slot, "simulated", out, RealClock(), watched=person, about=about
        )
        if status != "complete":
            break
    return 0


def _explain(trial: str, person: SimulatedParticipant) -> None:
    print(trial)
    for use in person.effects.values():
        print(f"  {'used    ' if use.used else 'not used'} {use.effect:13s} {use.reason}")


def _workers(a: argparse.Namespace) -> int:
    """How many processes. Raises InputError."""
    if not 1 <= a.workers <= MOST_WORKERS:
        raise InputError(f"--workers = {a.workers}: expected a number from 1 to {MOST_WORKERS}")
    return int(a.workers)


def _data_mode(
    arguments: argparse.Namespace, count: int, profile: Profile, without: frozenset[str]
) -> None:
    from seethrough.experiment.people.runs import data_run
    from seethrough.experiment.people.runs.batch import Batch

    a = arguments
    _workers(a)
    if a.scheduler is not None and a.workers != 1:
        raise InputError("--workers and --scheduler: expected one of them")
    if a.pool < 1:
        raise InputError(f"--pool = {a.pool}: expected at least 1 scene a task")
    if a.explain or a.watch:
        raise InputError("--explain and --watch: expected with --mode visual only")
    where = a.out.resolve()  # "." has no name
    tables = a.tables or where.parent / f"{where.name}-tables.db"
    job = Batch(a.study, a.seed, a.pool, tables, profile, without)
    data_run.run(job, a.out, count, a.workers, a.scheduler)
