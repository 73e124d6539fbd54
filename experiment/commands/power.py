"""`seethrough power`: how many participants does a study need?"""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.analysis.files.written import write_over
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import load

if TYPE_CHECKING:
    from seethrough.experiment.power.power import Effect

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
        default="published",
        metavar="published|DIR",
        help="the paper's effects, or a data folder of simulated participants",
    )
    parser.add_argument("--replications", type=int, default=2000, metavar="R")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="default: 1")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="HTML page")


def run(arguments: argparse.Namespace) -> int:
    """Work out the curve, print the sizes that are enough, write the page."""
    study = load(arguments.study)
    sizes = _sizes(arguments.participants)
    if not 10 <= arguments.replications <= 1_000_000:
        raise InputError(
            f"--replications = {arguments.replications}: expected a number from 10 to 1000000"
        )
    if arguments.seed < 0:
        raise InputError(f"--seed = {arguments.seed}: expected a number that is not negative")
    from seethrough.experiment.power import power  # scipy: only when the command runs
    from seethrough.experiment.power.power_page import page

    effects, what = _effects(arguments.effect)
    alpha = study.analysis.alpha
    points = power.curve(effects, sizes, arguments.replications, alpha, arguments.seed)
    least = power.enough(points)
    for name, n in least.items():
        print(f"{name:30s} {'more than ' + str(sizes[-1]) if n is None else n}")
    command = (
        f"seethrough power {arguments.study} --participants {arguments.participants} "
        f"--effect {arguments.effect} --replications {arguments.replications} "
        f"--seed {arguments.seed} --out {arguments.out.name}"
    )
    title = f"How many participants does “{study.study.title}” need?"
    text = f"{what} Two-sided tests at α = {alpha:g}, {arguments.replications} replications."
    try:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        write_over(arguments.out, page(title, text, points, least, command))
    except OSError as error:
        raise InputError(f"--out = {arguments.out}: cannot be written: {error.strerror}") from None
    print(f"page: {arguments.out}")
    return 0


def _sizes(text: str) -> list[int]:
    """Every size of the range; of a long one every tenth, and its end."""
    match = re.fullmatch(r"(\d{1,5})(?:\.\.(\d{1,5}))?", text)
    low, high = (int(match[1]), int(match[2] or match[1])) if match else (0, 0)
    if not 2 <= low <= high <= MOST:
        raise InputError(f"--participants = {text}: expected A..B with 2 ≤ A ≤ B ≤ {MOST}")
    return sorted({*range(low, high + 1, 1 if high - low <= LONG else 10), high})


def _effects(source: str) -> tuple[list[Effect], str]:
    from seethrough.experiment.power import power, power_ranks

    if source == "published":
        return [*power.published(), *power_ranks.published()], (
            "Participants are drawn from normal populations with the paper's printed means and "
            "s.d. and the correlation that its F implies (paper 004, tables 3 and 4); for the "
            "ratings, whose correlation is not printed, r = 0. Right answers and preference are "
            "drawn with replacement from the only 16 people that fit what is printed."
        )
    from seethrough.experiment.power.power_data import sampled

    folder = Path(source)
    if not folder.is_dir():
        raise InputError(f"--effect = {source}: expected published or a data folder")
    effects = sampled(folder)
    assert isinstance(effects[0], power.SampledEffect)  # times come first
    return list(effects), (
        f"Participants are drawn with replacement from the {len(effects[0].values)} simulated ones "
        f"of {folder.name}; simulated participants are a tool for planning, never evidence."
    )
