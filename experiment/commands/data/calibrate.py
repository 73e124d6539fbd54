"""`seethrough calibrate`: a profile whose times and errors come near the published ones; which rows
can be reached at all; how far each constant may move."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.persons.profile_file import add, find, provenance_of, read, write
from seethrough.experiment.session.progress import Progress
from seethrough.experiment.study.config import load

if TYPE_CHECKING:
    from seethrough.experiment.people.fitted.crowds import Crowds
    from seethrough.experiment.people.fitted.fitting import Crowd
    from seethrough.tasks.kit.skills.profile import Profile

FIT, SEARCH, INTERVALS = "fit", "search", "intervals"
LEAST = {"participants": 3, "evaluations": 1, "last": 3, "seed": 0, "pool": 1, "check": 3,
         "check_seed": 0, "tries": 3, "workers": 1}  # fmt: skip


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument(
        "--out", type=Path, required=True, metavar="FILE",
        help="profile to write; search and intervals add their tables to what a fit wrote",
    )  # fmt: skip
    parser.add_argument(
        "--part",
        choices=(FIT, SEARCH, INTERVALS),
        default=FIT,
        help="fit; search: which rows any constants within their intervals reach; intervals: how "
        "far each fitted constant may move, in 40 to 92 evaluations. One takes about a second of "
        "processor time a person, and more while tables are being drawn",
    )
    parser.add_argument("--profile", default="average", help="where to start; default: average")
    parser.add_argument(
        "--at", metavar="NAME=VALUE,…",
        help="fitted constants with which the fit begins, in place of the profile's; where each "
        "may lie follows from the profile",
    )  # fmt: skip
    parser.add_argument("--participants", type=int, default=48, metavar="N", help="each evaluation")
    parser.add_argument("--evaluations", type=int, default=40, metavar="E", help="of the fit")
    parser.add_argument("--tries", type=int, default=64, metavar="T", help="spread by the search")
    parser.add_argument(
        "--last", type=int, default=192, metavar="N", help="participants of the last corrections"
    )
    parser.add_argument("--seed", type=int, default=11, metavar="S", help="default: 11")
    parser.add_argument(
        "--check", type=int, default=256, metavar="N", help="other participants, for the table"
    )
    parser.add_argument("--check-seed", type=int, default=1, metavar="S", help="theirs; default: 1")
    parser.add_argument("--tables", type=Path, required=True, metavar="FILE")
    parser.add_argument("--pool", type=int, default=200, metavar="K", help="scenes a task")
    parser.add_argument("--workers", type=int, default=1, metavar="W", help="processes; default: 1")


def run(arguments: argparse.Namespace) -> int:
    """Do a part, print its table, write it into the profile with its provenance."""
    study = load(arguments.study)
    start = find(arguments.profile)
    for name, low in LEAST.items():
        if (value := getattr(arguments, name)) < low:
            raise InputError(f"--{name.replace('_', '-')} = {value}: expected at least {low}")
    from seethrough.experiment.people.fitted.priors import begun

    begin = begun(start, arguments.at or "")
    fitted = None if arguments.part == FIT else _fitted(arguments.out)
    _check_out(arguments.out)
    code_sha256()  # of the files as they are now: it is kept, and work of minutes follows
    from seethrough.experiment.people.fitted.crowds import Crowds

    with Crowds(study, arguments.pool, arguments.tables, arguments.workers) as crowds:
        if fitted is None:
            _fit(arguments, start, begin, crowds)
            return 0
        own = crowds.crowd(arguments.seed, arguments.participants)
        if arguments.part == SEARCH:
            others = crowds.crowd(arguments.check_seed, arguments.check)
            table = _search(arguments, start, own, others, crowds)
        else:
            table = _intervals(start, fitted, own, crowds)
    for line in table:
        print(line)
    add(arguments.out, arguments.part, {"command": _command(arguments), "code": _code(),
                                        "table": table})  # fmt: skip
    print(f"profile: {arguments.out}")
    return 0


def _fit(a: argparse.Namespace, start: Profile, begin: Profile, crowds: Crowds) -> None:
    from dataclasses import replace

    from seethrough.experiment.people.fitted import calibration, fitting

    own, last = crowds.crowd(a.seed, a.participants), crowds.crowd(a.seed, a.last)
    with Progress("calibrating", a.evaluations + fitting.LAST) as progress:
        best, misfit = fitting.calibrate(
            start,
            lambda p: own.play(p, calibration.FITTED),
            a.evaluations,
            lambda squares: progress.step(f"squares {squares:.1f}"),
            lambda p: last.play(p, calibration.FITTED),
            begin,
        )
    best = replace(best, name=a.out.stem)
    write(a.out, best, _provenance(a, start.name, misfit, []))  # before a check of minutes
    others = crowds.crowd(a.check_seed, a.check)
    every = calibration.FITTED + calibration.SEEN
    before, after = (calibration.measured(others.play(p, every)) for p in (start, best))
    table, gained = calibration.table(after, before), calibration.gained(after, before)
    print(f"{a.check} other participants, seed {a.check_seed}:")
    for line in (*table, "differences, fitted beside these rows and not counted among them:"):
        print(line)
    for line in gained[1:]:
        print(line)
    said = _provenance(a, start.name, misfit, table)
    write(a.out, best, {**said, "differences": {"command": _command(a), "table": gained}})
    print(f"profile: {a.out}, {crowds.seconds():.0f} s of processor time")


def _search(
    a: argparse.Namespace, start: Profile, own: Crowd, others: Crowd, crowds: Crowds
) -> list[str]:
    from seethrough.experiment.people.fitted import search
    from seethrough.experiment.people.fitted.calibration import FITTED, PEOPLE
    from seethrough.experiment.study.design.design import SIMULATED, generator

    with Progress("searching", a.tries + PEOPLE) as progress:
        found = search.search(
            start,
            lambda p: own.play(p, FITTED),
            lambda p: others.play(p, FITTED),
            a.tries,
            generator(a.seed, (SIMULATED, 0)),  # no person has that number
            progress.step,
        )
    return search.report(found, crowds.seconds())


def _intervals(start: Profile, fitted: Profile, own: Crowd, crowds: Crowds) -> list[str]:
    from seethrough.experiment.people.fitted import fitting, profiled
    from seethrough.experiment.people.fitted.calibration import FITTED
    from seethrough.experiment.people.fitted.priors import FREE, moved

    most = 1 + len(FREE) * (1 + 2 * profiled.PLAYS)
    with Progress("profiling", most) as progress:
        evaluations = fitting.Evaluations(
            start, lambda p: own.play(p, FITTED), lambda value: progress.step()
        )
        x = moved(start, fitted)
        here = evaluations.residuals(x)
        slopes = fitting.slopes_of(evaluations.residuals, x, here)
        found = profiled.profile_intervals(
            evaluations.residuals, slopes, here, x, len(here) - len(x)
        )
    return profiled.report(start, fitted, found, crowds.seconds())


def _fitted(out: Path) -> Profile:
    """The profile that a fit wrote. Raises InputError."""
    if not out.is_file() or not provenance_of(out):
        raise InputError(f"--out = {out}: expected a profile that a fit wrote")
    return read(out)


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


def _command(a: argparse.Namespace) -> str:
    """What was typed, but for where files lie on this machine."""
    own = {
        FIT: f"{f'--at {a.at} ' if a.at else ''}--evaluations {a.evaluations} --last {a.last} ",
        SEARCH: f"--part {SEARCH} --tries {a.tries} ",
        INTERVALS: f"--part {INTERVALS} ",
    }
    return (
        f"seethrough calibrate {a.study} --profile {a.profile} --participants {a.participants} "
        f"{own[a.part]}--seed {a.seed} --pool {a.pool} --check {a.check} "
        f"--check-seed {a.check_seed}"
    )


def _provenance(
    a: argparse.Namespace, start: str, misfit: float, table: Sequence[str]
) -> dict[str, object]:
    from seethrough.experiment.people.fitted.calibration import FITTED, SEEN

    checked = {"checked": f"{a.check} other participants, seed {a.check_seed}", "table": [*table]}
    return {
        "command": _command(a),
        "code": _code(),
        "participants": a.participants,
        "last": a.last,
        "seed": a.seed,
        "start": start,
        "fitted": list(FITTED),
        "seen": list(SEEN),
        "source": "Elmqvist2009, tables 3 and 4: means, s.d., and the r that each F implies",
        "misfit": round(misfit, 4),
        **(checked if table else {"checked": "not yet"}),
        "made": datetime.now(UTC).date().isoformat(),
    }


def _code() -> str:
    """The program's version, and what tells the participants' own code from any other."""
    version = metadata.version("seethrough")
    return f"seethrough {version}, experiment/people sha256 {code_sha256()}"
