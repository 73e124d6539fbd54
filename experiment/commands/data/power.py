"""`seethrough power`: how many participants do a study's own predictions need?"""

from __future__ import annotations

import argparse
import re
from math import isinf
from pathlib import Path

from seethrough.analysis.files.written import write_over
from seethrough.experiment.commands.data.power_scenes import describe
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output
from seethrough.experiment.study.config import load

MOST = 10_000
LONG = 200


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument(
        "--participants", default="8..48", metavar="A..B", help="sizes; default: 8..48"
    )
    parser.add_argument(
        "--effect",
        metavar='"NAME=0.2 UNIT"|published|DIR',
        help="an effect of a prediction or factor (UNIT: sd, %%, or the measure's), the printed "
        "ones of the published study, or a data folder of this study",
    )
    parser.add_argument(
        "--spread", type=float, metavar="S", help="s.d. of a person's differences, in UNIT"
    )
    parser.add_argument("--source", choices=("human", "pilot", "simulated"), help="of a folder")
    parser.add_argument("--replications", type=int, default=2000, metavar="R")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="default: 1")
    parser.add_argument("--out", type=Path, metavar="FILE", help="HTML page, with --effect")
    parser.add_argument(
        "--scenes",
        type=Path,
        metavar="FILE.csv",
        help="describe how much each condition shows in each scene; alone, or with --effect",
    )


def run(arguments: argparse.Namespace) -> int:
    """Describe scenes; work out the curves, print the sizes that are enough, write the page."""
    if arguments.scenes is not None:
        check_output("--scenes", arguments.scenes, ".csv")
        if arguments.scenes.exists():
            raise InputError(f"{arguments.scenes}: exists already; expected a new file")
        if arguments.effect is None and arguments.out is None:
            return describe(load(arguments.study), arguments.scenes)
    if arguments.out is None:
        raise InputError("--out: expected the name of the page that --effect makes")
    if arguments.out.suffix.lower() != ".html":  # it is written over: no study file, by a slip
        raise InputError(f"--out = {arguments.out}: expected a name that ends in .html")
    study = load(arguments.study)
    sizes = _sizes(arguments.participants)
    if not 10 <= arguments.replications <= 1_000_000:
        raise InputError(
            f"--replications = {arguments.replications}: expected a number from 10 to 1000000"
        )
    if arguments.seed < 0:
        raise InputError(f"--seed = {arguments.seed}: expected a number that is not negative")
    if arguments.effect is None:
        raise InputError('--effect: expected "PREDICTION=0.2 sd", published, or a data folder')
    from seethrough.experiment.power import effects, power  # scipy: only when the command runs
    from seethrough.experiment.power.power_page import page

    alpha = study.analysis.alpha
    effect = effects.effect_of(study, arguments.effect, arguments.spread, arguments.source)
    points, tests = power.curve(
        effect.planned, effect.source, sizes, arguments.replications, alpha, arguments.seed,
        effect.truth,
    )  # fmt: skip
    least = power.enough(points)
    print(f"drawn: {effect.drawn}")
    print(f"assumed: {effect.assumed}")
    for line in effect.alone:
        print(f"not asked: {line}")
    for name, n in least.items():
        print(f"{name:30s} {'more than ' + str(sizes[-1]) if n is None else n}")
    for put in effect.put:
        if put.interval is not None:
            low, high = ("∞" if isinf(n) else f"{n:.0f}" for n in put.interval)
            print(f"  {put.test.name:40s} {put.said:16s} n {low} to {high}")
    title = f"How many participants does “{study.general.title}” need?"
    settings = f"α = {alpha:g}, {arguments.replications} replications, seed {arguments.seed}."
    planned = study.general.participants
    smallest = (planned, effects.smallest(effect, planned, alpha))
    command = _command(arguments)
    text = page(title, effect, points, tests, least, smallest, settings, command)
    try:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        write_over(arguments.out, text)
    except OSError as error:
        raise InputError(f"--out = {arguments.out}: cannot be written: {error.strerror}") from None
    print(f"page: {arguments.out}")
    return 0 if arguments.scenes is None else describe(study, arguments.scenes)


def _command(a: argparse.Namespace) -> str:
    effect = f'"{a.effect}"' if " " in a.effect else a.effect
    more = "" if a.spread is None else f" --spread {a.spread:g}"
    more += "" if a.source is None else f" --source {a.source}"
    return (
        f"seethrough power {a.study} --participants {a.participants} --effect {effect}{more} "
        f"--replications {a.replications} --seed {a.seed} --out {a.out.name}"
    )


def _sizes(text: str) -> list[int]:
    """Every size of the range; of a long one every tenth, and its end."""
    match = re.fullmatch(r"(\d{1,5})(?:\.\.(\d{1,5}))?", text)
    low, high = (int(match[1]), int(match[2] or match[1])) if match else (0, 0)
    if not 2 <= low <= high <= MOST:
        raise InputError(f"--participants = {text}: expected A..B with 2 ≤ A ≤ B ≤ {MOST}")
    return sorted({*range(low, high + 1, 1 if high - low <= LONG else 10), high})
