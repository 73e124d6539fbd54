"""`seethrough seal`: one hash over all that was recorded, for a preregistration or a paper."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from seethrough.experiment.errors import InputError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument("--source", help="human, simulated or pilot, where there are several")
    parser.add_argument("--verify", metavar="HASH", help="compare with a seal printed before")


def run(arguments: argparse.Namespace) -> int:
    """Verify the folder and print its seal; 0, or 1 where --verify names another one."""
    from seethrough.analysis.load.seal import seal
    from seethrough.analysis.load.whole import verified

    wanted = arguments.verify
    if wanted is not None and not re.fullmatch(r"[0-9a-fA-F]{64}", wanted):
        raise InputError(f"--verify = {wanted[:80]}: expected 64 hexadecimal digits")
    whole = verified(arguments.data, arguments.source)
    digest, files = seal(arguments.data, whole.source)
    if wanted is None:
        print(digest)
        print(f"covers {files} files of the source {whole.source}", file=sys.stderr)
        return 0
    if digest == wanted.lower():
        print(f"the same: {files} files of the source {whole.source}")
        return 0
    print(
        f"{arguments.data}: seal = {digest}: expected {wanted.lower()}: a file was changed, added "
        "or removed since that one was made",
        file=sys.stderr,
    )
    return 1
