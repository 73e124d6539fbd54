"""A data folder as a whole: every file of a source read and verified, in one place for all.

The report, every export, replays, power from a folder, the seal and `status` go through here, so
what one of them refuses no other takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from seethrough.analysis.errors import DataError
from seethrough.analysis.load import schema
from seethrough.analysis.load.files import is_there, named, names_in, read_json
from seethrough.analysis.load.ledger import (
    NO_LEDGER,
    Ledger,
    come_back,
    differences,
    read_ledger,
)
from seethrough.analysis.load.person import TRACES, Folder, Person, Session, table_name

DESCRIPTION = "dataset_description.json"


@dataclass(slots=True)
class Whole:
    """Everything of one source; `problems` are lines, [] where all is as it was written."""

    folder: Path
    about: Mapping[str, object]
    source: str
    others: tuple[str, ...]
    people: list[Person] = field(default_factory=list)
    ledger: Ledger = NO_LEDGER
    problems: list[str] = field(default_factory=list)

    @property
    def sessions(self) -> list[Session]:
        """Every session that has a trial table, by participant and number."""
        return [s for person in self.people for s in person.sessions if s.table is not None]


def verified(folder: Path, source: str | None = None) -> Whole:
    """The folder's one source, or the one asked for, all of it as it was written.

    Raises DataError with a line for each file that is not, or that is missing.
    """
    whole = examined(folder, source)
    if whole.problems:
        raise DataError(whole.problems)
    return whole


def examined(
    folder: Path, source: str | None = None, entries: Mapping[str, str] | None = None
) -> Whole:
    """The same, with its problems; `entries` (participant → status): of a ledger elsewhere.

    Raises DataError where there is no data folder, or not the source.
    """
    about = _description(folder)
    chosen, others = _source(folder, source)
    whole = Whole(folder, about, chosen, others)
    for name in _participants(folder, chosen):
        whole.people.append(Folder(folder / "data" / chosen / name, folder).read())
    whole.problems = [line for p in whole.people for line in (*p.problems, *p.half)]
    whole.problems += _unchained(whole)
    if chosen == "human":  # nobody else takes a slot
        try:
            whole.ledger = read_ledger(folder)
        except DataError as error:
            whole.problems += error.lines
        try:
            whole.problems += come_back(folder, whole.people)
        except DataError as error:
            whole.problems += error.lines
        known = entries if entries is not None else whole.ledger.entries
        if known is not None:
            whole.problems += differences(known, whole.people)
    return whole


def verified_person(folder: Path, source: str, participant: str) -> Person:
    """One participant's files. Raises DataError."""
    person = Folder(folder / "data" / source / participant, folder).read()
    if lines := [*person.problems, *person.half]:
        raise DataError(lines)
    return person


def _description(folder: Path) -> dict[str, object]:
    """The dataset's description; its presence is what makes a folder a dataset."""
    if not is_there(folder):
        raise DataError(f"{folder}: no such folder")
    names = names_in(folder, folder)
    if DESCRIPTION not in names:
        what = "no dataset" if names else "an empty folder"
        raise DataError(f"{folder}: {what}: expected {DESCRIPTION} in it")
    return read_json(folder / DESCRIPTION, folder)


def _source(folder: Path, wanted: str | None) -> tuple[str, tuple[str, ...]]:
    """Which of data/human, data/simulated, data/pilot to read; they are never mixed."""
    sources = names_in(folder / "data", Path("data"))
    there = [s for s in schema.SOURCES if s in sources and _begun(folder, s)]
    if wanted is not None and wanted not in there:
        have = ", ".join(there) or "none"
        raise DataError(f"{folder}: source = {wanted}: expected one that has data ({have})")
    if not there:
        raise DataError(f"{folder}: no participants yet: expected data/SOURCE/PARTICIPANT/*.csv")
    if wanted is None and len(there) > 1:
        have = ", ".join(there)
        raise DataError(f"{folder}: source = {have}: sources are never mixed: choose with --source")
    chosen = wanted or there[0]
    return chosen, tuple(s for s in there if s != chosen)


def _participants(folder: Path, source: str) -> list[str]:
    """Folders of participants: whatever has no ending, as an id never has."""
    base = folder / "data" / source
    names = names_in(base, Path(named(base, folder)))
    return [name for name in names if "." not in name or (base / name).is_dir()]


def _begun(folder: Path, source: str) -> bool:
    """Whether anybody of a source left more than the empty folder of a session killed at once."""
    base = folder / "data" / source
    return any(
        set(names_in(base / name, Path(named(base / name, folder)))) - {TRACES}
        for name in _participants(folder, source)
    )


def _unchained(whole: Whole) -> Iterator[str]:
    """Tables without a chain beside others that have one, or of the recorder's own: it was cut off.

    Tables that another program made have none, and the report says that changes would not show.
    """
    chained = any(session.chained for session in whole.sessions)
    for session in whole.sessions:
        provenance = (session.sidecar or {}).get("provenance")
        recorded = isinstance(provenance, Mapping) and "program_sha256" in provenance
        if not session.chained and (chained or recorded):
            yield (
                f"{table_name(session)}: no chain in table and sidecar, though Seethrough recorded "
                "this study with one: put the originals back"
            )
