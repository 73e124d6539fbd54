"""Whether code that a study brings along may run: only once the experimenter has said so.

A yes holds for a file as it is: its hash is remembered in a file of the user's own. Processes that
this one starts are told by the environment.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.private import make_folder

TOLD = "SEETHROUGH_TRUSTS"  # hashes, for processes that this one starts
EVERYTHING = "everything"
TRUST = "run code that a study brings along, without being asked"
HOME = "SEETHROUGH_HOME"  # where the file lies, if not where such files do


def trust_everything() -> None:
    """What `--trust` says."""
    _tell(EVERYTHING)


def demand(what: str, file: str, sha256: str) -> None:
    """Raises InputError unless this code may run. `what` names the place that asks for it."""
    told = os.environ.get(TOLD, "").split(":")
    if EVERYTHING in told or sha256 in told or sha256 in _remembered():
        return
    if not (sys.stdin.isatty() and sys.stderr.isatty()):
        raise InputError(
            f"{what}: code that the study brings along: it runs only with --trust, or after a yes "
            "on a terminal"
        )
    print(
        f"{what}: the study brings code along ({file}, {sha256[:12]}). It can do whatever you can, "
        "with all your files. Only who has read it, or trusts who wrote it, should run it.",
        file=sys.stderr,
    )
    print("Run it, now and whenever it is as it is now? (yes/no) ", end="", file=sys.stderr)
    sys.stderr.flush()
    if sys.stdin.readline().strip().lower() != "yes":
        raise InputError(f"{what}: not run: the answer was no")
    _remember(sha256)
    _tell(sha256)


def _tell(word: str) -> None:
    told = os.environ.get(TOLD, "")
    os.environ[TOLD] = f"{told}:{word}" if told else word


def kept_file(name: str) -> Path:
    """A file in which the program remembers something for this user."""
    chosen = os.environ.get(HOME)
    if chosen:
        return Path(chosen) / name
    base = os.environ.get("APPDATA" if os.name == "nt" else "XDG_STATE_HOME")
    return (Path(base) if base else Path.home() / ".local" / "state") / "seethrough" / name


def _remembered() -> list[str]:
    return lines_of(kept_file("trusted"))


def _remember(sha256: str) -> None:
    add_line(kept_file("trusted"), sha256)


def lines_of(path: Path) -> list[str]:
    """What is remembered; nothing where it cannot be read, so that it is asked again."""
    try:
        return path.read_text("utf-8").split()
    except (OSError, ValueError):
        return []


def add_line(path: Path, line: str) -> None:
    """Remember a line more. Where that is impossible, it is asked again: said, not hidden."""
    try:
        make_folder(path.parent)
        with open(path, "a", encoding="utf-8") as file:
            file.write(f"{line}\n")
        path.chmod(0o600)
    except OSError as error:
        print(f"{path}: cannot be written ({error.strerror}): asked again", file=sys.stderr)
