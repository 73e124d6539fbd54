"""`seethrough export`: a study's data in another form."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument(
        "--format",
        required=True,
        choices=("wide", "parquet", "bids", "psychds"),
        help="one row a participant; typed columns; BIDS; strictly named Psych-DS",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="a new folder")
    parser.add_argument("--source", help="human, simulated or pilot, where there are several")


def run(arguments: argparse.Namespace) -> int:
    """Write the export; 0."""
    from seethrough.experiment.export import formats
    from seethrough.experiment.export.dataset import check_out, read

    check_out(arguments.out)
    data = read(arguments.data, arguments.source)
    formats()[arguments.format](data, arguments.out)
    for path in sorted(arguments.data.glob(f"data/{data.source}/*/*_repair.json")):
        print(f"{path.parent.name}: played twice at once, repaired: see {path}")
    print(f"{len(data.participants)} participants, {arguments.format}, in {arguments.out}")
    return 0
