"""`seethrough report`: from a data folder to the statistics report."""

from __future__ import annotations

import argparse
from pathlib import Path

HELP = "make the statistics report from a data folder"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    parser.add_argument(
        "data", metavar="DATA", type=Path, nargs="?", help="the study's data folder"
    )
    parser.add_argument(
        "--published", action="store_true", help="the paper's printed numbers instead of DATA"
    )
    parser.add_argument("--out", type=Path, required=True, help="folder for the report")
    parser.add_argument(
        "--replace", action="store_true", help="put it in the place of the report that is there"
    )
    parser.add_argument(
        "--format",
        action="append",
        choices=("html", "pdf"),
        default=["html"],
        help="pdf prints report.html to report.pdf with an installed Chromium",
    )
    parser.add_argument("--source", help="human, simulated or pilot, where there are several")
    parser.add_argument("--alpha", type=float, help="instead of the study's own (a deviation)")
    parser.add_argument(
        "--exclude",
        action="append",
        metavar="RULE",
        help="instead of the study's own rules (a deviation): timed_out, focus_lost, "
        "frames_missed, too_fast, participant:ID; may be repeated",
    )
    parser.add_argument(
        "--pairwise",
        action="append",
        metavar="FACTOR",
        help="compare every pair of this factor's levels, too; may be repeated",
    )
    parser.add_argument(
        "--aligned-ranks",
        action="store_true",
        help="test interactions of ordinal measures by aligned ranks, too, with a warning",
    )


def run(args: argparse.Namespace) -> int:
    """Make the report; returns 0. Raises DataError with a line for each thing that is wrong."""
    # analysis imports pandas and scipy, which takes a second: only when the command runs
    from seethrough.analysis.errors import DataError
    from seethrough.analysis.report import Options, make_published, make_report, write

    options = Options(
        args.source, args.alpha, args.exclude, tuple(args.pairwise or ()), args.aligned_ranks
    )
    if args.published == (args.data is not None):
        raise DataError("report: expected either DATA or --published")
    make = make_published if args.published else lambda: make_report(args.data, options)
    print(write(args.out, make, args.format, args.replace))
    return 0
