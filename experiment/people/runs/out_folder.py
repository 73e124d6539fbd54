"""The folder that simulated people are to be put into: new, empty, or a study's data folder."""

from __future__ import annotations

from pathlib import Path

from seethrough.experiment.errors import InputError, short
from seethrough.experiment.files.folders import taken
from seethrough.experiment.people.runs.batch_files import NAME
from seethrough.experiment.record.dataset import FILE, check_name

# What a data folder may have before anybody was recorded there (CONVENTIONS.md).
BEFORE = ("certificate.csv", "ledger.", "locks.", "study.path", "data", "models", "plugins")
MOST_NAMES = 3


def check_folder(out: Path, study: str) -> None:
    """Raises InputError for what is no folder, holds other things, or another study's data."""
    if not out.exists():
        return
    if not out.is_dir():
        raise InputError(f"--out = {out}: expected a folder, it is a file")
    if (out / FILE).exists():
        check_name(out / FILE, study)
        return
    names = sorted(p.name for p in out.iterdir() if not p.name.startswith((".", *BEFORE)))
    if names:
        raise InputError(
            f"--out = {out}: holds {_listed(names)}, which no study recorded: expected a new or "
            "empty folder, or a study's data"
        )


def check_visual(out: Path, people: list[str]) -> None:
    """Raises InputError where people whom visual mode is to play, or data mode's, are there."""
    there = taken(out, "simulated")
    chunks = sorted(name for name in there if NAME.fullmatch(name))
    if chunks:
        raise InputError(
            f"--out = {out}: holds {_listed(chunks)} of data mode: visual mode expects a folder of "
            "its own"
        )
    again = [name for name in people if name in there]
    if again:
        raise InputError(
            f"--out = {out}: holds {_listed(again)} already, who are never played twice: expected "
            "a folder without them"
        )


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{', '.join(map(short, names[:MOST_NAMES]))}{more}"
