"""`seethrough design`: what a study's factors make: cells, orders, items, trials, minutes."""

from __future__ import annotations

import argparse
import csv
import io
import sys
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.shown.design_table import columns_of, lines_of, rows_of


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file or name of a shipped study")
    parser.add_argument(
        "--slots", type=int, metavar="N", help="people in the tables; default: all who are wanted"
    )
    parser.add_argument("--csv", type=Path, metavar="FILE", help="every trial; -: print it")
    parser.add_argument("--html", type=Path, metavar="FILE", help="a page: slots × positions")


def run(arguments: argparse.Namespace) -> int:
    """Print the design, or write it."""
    for path in (arguments.csv, arguments.html):
        if path is not None and str(path) != "-" and path.exists():
            raise InputError(f"{path}: exists already; expected a new file")
    study = load(arguments.study)
    count = study.general.participants if arguments.slots is None else arguments.slots
    if not 1 <= count <= 100_000:
        raise InputError(f"--slots = {count}: expected a number from 1 to 100000")
    if arguments.csv is not None:
        _csv(study, count, arguments.csv)
    if arguments.html is not None:
        from seethrough.experiment.study.shown.design_page import page

        arguments.html.write_text(page(study, count), "utf-8")
        print(f"design: {arguments.html}")
    if arguments.csv is None and arguments.html is None:
        print("\n".join(lines_of(study, count)))
    return 0


def _csv(study: Study, count: int, path: Path) -> None:
    """A row for each trial of each slot."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(columns_of(study))
    table.writerows(rows_of(study, count))
    if str(path) == "-":
        sys.stdout.write(text.getvalue())
        return
    path.write_text(text.getvalue(), "utf-8")
    print(f"design: {path}")
