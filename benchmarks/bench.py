"""`seethrough bench`: measure accuracy and time, and say whether the figures are met."""

from __future__ import annotations

import argparse
import importlib
import json
from pathlib import Path

from seethrough.benchmarks.rows import Row
from seethrough.experiment.errors import InputError

HELP = "measure accuracy against time"

# Each module has figures(), which gives {figure, scene, value, unit, must, aim, met} one by one.
BENCHES = {
    "accuracy": "drawing.accuracy",
    "design": "sessions.design",
    "effects": "sessions.effects",
    "looks": "drawing.looks",
    "ordering": "orderings.ordering",
    "ordering_accuracy": "orderings.ordering_accuracy",
    "paths": "drawing.paths",
    "predictions": "sessions.predictions",
    "session": "sessions.session",
    "simulate": "sessions.simulate",
    "speed": "drawing.speed",
    "statistics": "inference.statistics",
    "studies": "sessions.studies",
    "techniques": "drawing.techniques",
    "worlds": "drawing.worlds",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("bench", choices=BENCHES, help="what to measure")
    parser.add_argument(
        "--only", metavar="PART,…", help="some parts of its table alone, where it has parts"
    )
    parser.add_argument(
        "--full", action="store_true", help="what takes long as well, where there is such a part"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the table to a file")
    parser.add_argument(
        "--markdown", type=Path, metavar="FILE", help="put the table into a page, as Markdown"
    )
    parser.add_argument(
        "--figure",
        type=Path,
        metavar="FILE",
        help="draw it, as .svg or .png, where it has a figure",
    )


def run(args: argparse.Namespace) -> int:
    """Print each row as it is measured; write them all at the end."""
    for option in ("json", "markdown", "figure"):
        path = getattr(args, option)
        if path is not None and not path.parent.is_dir():
            raise InputError(f"--{option} = {path}: expected an existing folder")
    if args.figure is not None and args.figure.suffix not in (".svg", ".png"):
        raise InputError(f"--figure = {args.figure}: expected a name that ends in .svg or .png")
    try:
        module = importlib.import_module(f"seethrough.benchmarks.{BENCHES[args.bench]}")
    except ModuleNotFoundError as error:
        raise InputError(f"bench {args.bench}: {error}; expected it to be installed") from error
    if args.figure is not None and not hasattr(module, "chart"):
        raise InputError(f"--figure = {args.figure}: bench {args.bench} draws none")
    if args.full and not hasattr(module, "thorough"):
        raise InputError(f"--full: bench {args.bench} has nothing that takes longer: expected none")
    tables = (
        importlib.import_module("seethrough.benchmarks.tables")
        if args.markdown is not None
        else None
    )
    if tables is not None:
        try:
            tables.around(args.markdown, args.bench)  # before anything is measured
        except ValueError as error:
            raise InputError(str(error)) from None
    rows = []
    measure = module.thorough if args.full else module.figures
    for row in measure(*_only(args.only, module)):
        rows.append(row)
        print(line(row), flush=True)
    if hasattr(module, "summary"):
        print(f"\n{module.summary(rows)}")
    if args.json is not None:
        args.json.write_text(json.dumps(rows, indent=1, ensure_ascii=False) + "\n", "utf-8")
    if tables is not None:
        tables.put(args.markdown, args.bench, rows)
    if args.figure is not None:
        module.chart(rows, args.figure)
    return 0


def _only(text: str | None, module: object) -> list[list[str]]:
    """The parts asked for, as arguments of `figures`."""
    if text is None:
        return []
    known, parts = getattr(module, "PARTS", ()), text.split(",")
    if not set(parts) <= set(known):
        raise InputError(f"--only = {text}: expected some of {', '.join(known) or 'no parts'}")
    return [parts]


def line(row: Row) -> str:
    """A row in words."""
    text = f"{row['figure']:40s} {row['scene']:26s} {row['value']:10.4g} {row['unit']}"
    if row["must"] is not None:
        at_most = (row["value"] <= row["must"]) == bool(row["met"])
        text += f"   must {'≤' if at_most else '≥'} {row['must']:g}: "
        text += "met" if row["met"] else "NOT MET"
    if row["aim"] is not None:
        text += f", aim {row['aim']:g}"
    return text
