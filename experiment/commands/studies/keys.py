"""`seethrough keys`: what a study file may say, as the code declares it."""

from __future__ import annotations

import argparse
import re

from seethrough.experiment.errors import InputError, short, unknown


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("table", nargs="?", help="of one table only, as it stands in the file")


def run(arguments: argparse.Namespace) -> int:
    """Print the reference (docs/keys.md), or one table's part of it."""
    from seethrough.experiment.study.tables.keys import reference

    text = reference()
    if arguments.table is None:
        print(text, end="")
        return 0
    parts = re.split(r"(?m)^(?=## )", text)
    of = {name: part for part in parts for name in re.findall(r"^## `\[+([^\]]+)\]+`", part)}
    wanted = arguments.table.strip("[]")
    if wanted not in of:
        raise InputError(f"{short(arguments.table)}: {unknown(wanted, of, 'table')}")
    print(of[wanted], end="")
    return 0
