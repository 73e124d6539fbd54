"""`seethrough technique`: what techniques there are, and whether one keeps to what all must."""

from __future__ import annotations

import argparse
from itertools import chain
from pathlib import Path

from seethrough import registry
from seethrough.experiment.errors import InputError, short, unknown
from seethrough.experiment.files.trust import TRUST
from seethrough.experiment.study.beside.plugin_files import from_path

HELP = "list techniques, or try one on all that it must keep to"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    inner = parser.add_subparsers(dest="what", required=True, metavar="WHAT")
    inner.add_parser("list", help="name all techniques, with what participants read about them")
    tried = inner.add_parser("check", help="run the suite that every technique has to pass")
    tried.add_argument("name", metavar="NAME", help="a technique, as `list` names it, or a file")
    tried.add_argument("--trust", action="store_true", help=TRUST)
    tried.add_argument(
        "--all", action="store_true", help="exactness as well on every scene and option: minutes"
    )


def run(args: argparse.Namespace) -> int:
    """Print a line a technique, or a line a finding; 1 if something does not hold."""
    names = registry.known("technique")
    if args.what == "list":
        for name in names:
            found = registry.get("technique", name)
            print(f"{name} ({found.version}): {found.instruction}")
        return 0
    if args.name.endswith(".py"):
        args.name = from_path("technique", Path(args.name))
    elif args.name not in names:
        raise InputError(
            f"technique check {short(args.name)}: {unknown(args.name, names, 'technique')}"
        )
    from seethrough.experiment.suites.requirements import asked
    from seethrough.experiment.suites.technique_suite import check, check_all
    from seethrough.renderer.gpu.device.context import standalone

    try:
        context = standalone()
    except RuntimeError as error:
        raise InputError(str(error)) from error
    holds = True
    technique = registry.get("technique", args.name)
    more = check_all(technique, context) if args.all else ()
    for finding in chain(check(technique, context), [asked(technique)], more):
        print(finding, flush=True)
        holds &= finding.holds
    return 0 if holds else 1
