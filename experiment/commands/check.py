"""`seethrough check`: config, design and machine, before anybody is invited."""

from __future__ import annotations

import argparse
import shutil
from collections import Counter
from pathlib import Path

from experiment.config import Study, load
from experiment.design import order_of, session_for
from experiment.texts import Texts


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")


def run(arguments: argparse.Namespace) -> int:
    """Print what was checked; 2 with one line if the study is not valid (InputError)."""
    study = load(arguments.study)
    Texts(study.study.language, study.texts)
    for line in (*_config(study), *_design(study), *_machine()):
        print(line)
    return 0


def _config(study: Study) -> list[str]:
    return [f"config    {study.study.name}: valid, {study.digest()[:12]}"]


def _design(study: Study) -> list[str]:
    factors = study.design.factors()
    count = study.study.participants
    per_session = sum(len(s.trials) for s in session_for(1, factors))
    rows = Counter(order_of(slot, len(factors.conditions)) for slot in range(1, count + 1))
    lines = [
        f"design    {count} participants × {per_session} trials = {count * per_session} trials",
        *(
            f"          {number} × " + " → ".join("/".join(factors.conditions[c]) for c in order)
            for order, number in sorted(rows.items())
        ),
    ]
    uneven = max(rows.values()) - min(rows.values())
    word = "balanced" if uneven == 0 else f"rows differ by {uneven}"
    return [*lines, f"          {word}"]


def _machine() -> list[str]:
    from experiment.driver import describe
    from renderer.gpu.context import standalone

    driver = describe(standalone())
    free = shutil.disk_usage(Path.cwd()).free
    return [
        *(f"machine   {name}: {value}" for name, value in driver.items()),
        f"machine   free disk: {free / 2**30:.1f} GiB",
    ]
