"""`seethrough calibrate`: a profile whose times come near the published ones."""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from pathlib import Path

from experiment.config import load
from experiment.errors import InputError
from experiment.participants.profile_file import find, write
from experiment.progress import Progress


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="profile to write")
    parser.add_argument("--profile", default="average", help="where to start; default: average")
    parser.add_argument("--participants", type=int, default=16, metavar="N")
    parser.add_argument("--evaluations", type=int, default=80, metavar="E", help="of the fit")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="default: 1")
    parser.add_argument("--tables", type=Path, required=True, metavar="FILE")
    parser.add_argument("--pool", type=int, default=200, metavar="K", help="scenes a task")


def run(arguments: argparse.Namespace) -> int:
    """Fit, print published beside simulated, write the profile with its provenance."""
    load(arguments.study)
    start = find(arguments.profile)
    for name, low in (("participants", 3), ("evaluations", 1), ("seed", 0), ("pool", 1)):
        if getattr(arguments, name) < low:
            raise InputError(f"--{name} = {getattr(arguments, name)}: expected at least {low}")
    from dataclasses import replace

    from experiment.participants import batch, calibration

    job = batch.Batch(arguments.study, arguments.seed, arguments.pool, arguments.tables, start)
    batch.prepare(job)
    slots = range(1, arguments.participants + 1)

    def play(profile):  # type: ignore[no-untyped-def]
        rows = batch.play_chunk(slots, profile)
        batch.keep_tables()  # an interrupted fit starts with what has been drawn
        return rows

    with Progress("calibrating", arguments.evaluations) as progress:
        best, misfit = calibration.calibrate(
            start,
            play,
            arguments.evaluations,
            lambda number, value: progress.step(f"misfit {value:.2f}"),
        )
    best = replace(best, name=arguments.out.stem)
    for line in calibration.table(calibration.measured(play(best))):
        print(line)
    write(arguments.out, best, _provenance(arguments, start.name, misfit))
    print(f"profile: {arguments.out}")
    return 0


def _provenance(arguments: argparse.Namespace, start: str, misfit: float) -> dict[str, object]:
    from experiment.participants.calibration import FITTED, HELD_OUT

    return {
        "command": f"seethrough calibrate {arguments.study} --participants "
        f"{arguments.participants} --evaluations {arguments.evaluations} --seed {arguments.seed} "
        f"--pool {arguments.pool}",
        "start": start,
        "fitted": list(FITTED),
        "held_out": list(HELD_OUT),
        "source": "paper 004, table 3: completion times, s.d., and the r that each F implies",
        "misfit": round(misfit, 4),
        "made": datetime.now(UTC).date().isoformat(),
    }
