"""`seethrough prereg`: a study's preregistration, from its file alone."""

from __future__ import annotations

import argparse
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import load
from seethrough.experiment.study.shown.prereg import preregistration


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument("--out", type=Path, metavar="FILE.md", help="default: print it")


def run(arguments: argparse.Namespace) -> int:
    """Print the preregistration, or write it into a new file."""
    if arguments.out is not None and arguments.out.exists():
        raise InputError(f"{arguments.out}: exists already; expected a new file")
    text = preregistration(load(arguments.study))
    if arguments.out is None:
        print(text, end="")
        return 0
    arguments.out.write_text(text, "utf-8")
    print(f"preregistration: {arguments.out}")
    return 0
