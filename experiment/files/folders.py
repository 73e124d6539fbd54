"""Where a participant's files lie, and which ids a participant may have."""

from __future__ import annotations

import re
from pathlib import Path

from seethrough.experiment.errors import InputError

PARTICIPANT = re.compile(r"[A-Za-z0-9_-]{1,32}")


def check_participant(participant: str) -> str:
    """The id, if it may be one. Raises InputError."""
    if not PARTICIPANT.fullmatch(participant):
        raise InputError(
            f"--participant = {participant!r}: expected 1 to 32 letters, digits, - or _"
        )
    return participant


def folder_of(data: Path, source: str, participant: str) -> Path:
    """Where a participant's files lie."""
    return data / "data" / source / participant


def stem_of(study: str, participant: str, session: int = 1) -> str:
    """Start of a participant's file names. Psych-DS values are letters and digits only."""
    subject = re.sub(r"[^A-Za-z0-9]", "", participant) or "x"
    return f"study-{study}_subject-{subject}_session-{session}"


def plain(participant: str) -> str:
    """What file names keep of an id, upper and lower case alike as some disks have them."""
    return re.sub(r"[^A-Za-z0-9]", "", participant).lower()


def taken(data: Path, source: str) -> frozenset[str]:
    """Ids of the participants of a source that have files."""
    found = (p.name for p in (data / "data" / source).glob("*"))
    return frozenset(name for name in found if PARTICIPANT.fullmatch(name))


def next_free(data: Path, source: str) -> str:
    """The lowest P01, P02, … that no participant of this source has (S01, … for simulated)."""
    letter = "S" if source == "simulated" else "P"
    names = taken(data, source)
    number = 1
    while f"{letter}{number:02d}" in names:
        number += 1
    return f"{letter}{number:02d}"
