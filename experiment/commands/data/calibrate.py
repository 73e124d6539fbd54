"""`seethrough calibrate`: a profile whose times and errors come near the published ones."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryFile

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.persons.profile_file import find, write
from seethrough.experiment.session.progress import Progress
from seethrough.experiment.study.config import load


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="profile to write")
    parser.add_argument("--profile", default="average", help="where to start; default: average")
    parser.add_argument("--participants", type=int, default=48, metavar="N", help="of the fit")
    parser.add_argument("--evaluations", type=int, default=40, metavar="E", help="of the fit")
    parser.add_argument(
        "--last", type=int, default=192, metavar="N", help="participants of the last corrections"
    )
    parser.add_argument("--seed", type=int, default=11, metavar="S", help="of the fit; default: 11")
    parser.add_argument(
        "--check", type=int, default=256, metavar="N", help="other participants, for the table"
    )
    parser.add_argument("--check-seed", type=int, default=1, metavar="S", help="theirs; default: 1")
    parser.add_argument("--tables", type=Path, required=True, metavar="FILE")
    parser.add_argument("--pool", type=int, default=200, metavar="K", help="scenes a task")


def run(arguments: argparse.Namespace) -> int:
    """Fit, print published beside simulated, write the profile with its provenance."""
    study = load(arguments.study)
    start = find(arguments.profile)
    least = {"participants": 3, "evaluations": 1, "last": 3, "seed": 0, "pool": 1, "check": 3,
             "check_seed": 0}  # fmt: skip
    for name, low in least.items():
        if (value := getattr(arguments, name)) < low:
            raise InputError(f"--{name.replace('_', '-')} = {value}: expected at least {low}")
    _check_out(arguments.out)
    from dataclasses import replace

    from seethrough.experiment.people.fitted import calibration, fitting
    from seethrough.experiment.people.runs.looks import KeptLooks
    from seethrough.experiment.people.runs.pool import drawing

    pool = drawing(study, arguments.pool, KeptLooks(arguments.tables))
    crowd = fitting.Crowd(arguments.seed, arguments.participants, pool)
    last = fitting.Crowd(arguments.seed, arguments.last, pool)
    with Progress("calibrating", arguments.evaluations + fitting.LAST) as progress:
        best, misfit = fitting.calibrate(
            start,
            lambda p: crowd.play(p, calibration.FITTED),
            arguments.evaluations,
            lambda value: progress.step(f"misfit {value:.2f}"),
            lambda p: last.play(p, calibration.FITTED),
        )
    best = replace(best, name=arguments.out.stem)
    others = fitting.Crowd(arguments.check_seed, arguments.check, pool)
    every = calibration.FITTED + calibration.SEEN
    before, after = (calibration.measured(others.play(p, every)) for p in (start, best))
    table = calibration.table(after, before)
    print(f"{arguments.check} other participants, seed {arguments.check_seed}:")
    for line in table:
        print(line)
    write(arguments.out, best, _provenance(arguments, start.name, misfit, table))
    print(f"profile: {arguments.out}")
    return 0


def _check_out(out: Path) -> None:
    """Ask before a fit of minutes whether its profile can be written. Raises InputError."""
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=out.parent):
            pass
    except OSError as error:
        raise InputError(f"--out = {out}: cannot be written: {error.strerror}") from None
    if out.is_dir():
        raise InputError(f"--out = {out}: expected a file's name, not a folder's")


def _provenance(
    arguments: argparse.Namespace, start: str, misfit: float, table: Sequence[str]
) -> dict[str, object]:
    from seethrough.experiment.people.fitted.calibration import FITTED, SEEN

    return {
        "command": f"seethrough calibrate {arguments.study} --profile {arguments.profile} "
        f"--participants {arguments.participants} --evaluations {arguments.evaluations} "
        f"--last {arguments.last} --seed {arguments.seed} --pool {arguments.pool} "
        f"--check {arguments.check} --check-seed {arguments.check_seed}",
        "code": _code(),
        "participants": arguments.participants,
        "last": arguments.last,
        "seed": arguments.seed,
        "start": start,
        "fitted": list(FITTED),
        "seen": list(SEEN),
        "source": "Elmqvist2009, tables 3 and 4: means, s.d., and the r that each F implies",
        "misfit": round(misfit, 4),
        "checked": f"{arguments.check} other participants, seed {arguments.check_seed}",
        "table": list(table),
        "made": datetime.now(UTC).date().isoformat(),
    }


def _code() -> str:
    """The program's version, and what tells the participants' own code from any other."""
    version = metadata.version("seethrough")
    return f"seethrough {version}, experiment/people sha256 {code_sha256()}"
