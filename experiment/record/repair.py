"""A participant's folder that two sessions wrote at once, made one again: both are kept.

Each session follows what it found when it began: its sidecar names the chain's value there. Where
two went on at once, the sessions form a tree; one branch is chosen to count. The folder as it was
is set aside whole, and a new one holds the branch: its last session as it is, those before it up
to where the next one began. So the chain holds again, and a mark says what was done.
"""

from __future__ import annotations

import csv
import hashlib
import itertools
import json
import os
import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from seethrough.analysis.load.files import is_there, table_in
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import folder_of
from seethrough.experiment.files.json_files import number_in, read_object
from seethrough.experiment.files.private import make_folder, sync_folder, write_new
from seethrough.experiment.record.chain import END, SIDECAR, TRIALS_TABLE

ASIDE = "aside"  # beside `data`: what no report and no export reads
MARK = "_repair.json"


@dataclass(frozen=True)
class Session:
    """A session's files in a folder, and where it goes on: `values` are its chain, start first."""

    number: int
    stem: str
    began: str
    ended: str
    follows: str
    values: tuple[str, ...]
    holds: Mapping[str, str]

    @property
    def trials(self) -> int:
        """Rows of its table."""
        return len(self.values) - 1


def sessions_of(folder: Path) -> tuple[Session, ...]:
    """A participant's sessions in their order. Raises InputError."""
    found = [_session(folder, path) for path in folder.glob(f"*{SIDECAR}")]
    return tuple(sorted(found, key=lambda s: s.number))


def _session(folder: Path, sidecar: Path) -> Session:
    stem = sidecar.name.removesuffix(SIDECAR)
    about, end = read_object(sidecar), folder / f"{stem}{END}"
    try:
        chain, number = table_in(about, "chain"), number_in(about, "session", sidecar)
        text = (folder / f"{stem}{TRIALS_TABLE}").read_text("utf-8")
        values = (
            str(chain["start"]),
            *(line.rpartition(",")[2] for line in text.split("\n")[1:-1]),
        )
        ended = str(read_object(end).get("status", "")) if is_there(end) else "broken off"
        follows = str(chain.get("follows", ""))
        holds = {k: str(v) for k, v in table_in({"holds": {}, **chain}, "holds").items()}
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{sidecar}: expected a session's sidecar and table: {error}") from None
    return Session(number, stem, str(about.get("started", "")), ended, follows, values, holds)


def branches(sessions: tuple[Session, ...]) -> dict[int, tuple[Session, ...]]:
    """{last session's number: its branch, first to last} where sessions went on at once.

    One branch where all is as it should be. Raises InputError for one that follows nothing.
    """
    found = {}
    for last in sessions:
        branch = [last]
        while branch[0].follows:
            before = [s for s in sessions if branch[0].follows in s.values and s not in branch]
            if not before:
                raise InputError(f"{branch[0].stem}: follows a session that is not here")
            branch.insert(0, before[0])
        found[last.number] = tuple(branch)
    ends = {
        b[-2].number for b in found.values() if len(b) > 1 and b[-1].follows == b[-2].values[-1]
    }
    return {number: branch for number, branch in found.items() if number not in ends}


def described(number: int, branch: tuple[Session, ...]) -> str:
    """A branch for the experimenter who has to choose."""
    parts = []
    for session, coming in zip(branch, (*branch[1:], None), strict=True):
        upto = session.trials if coming is None else session.values.index(coming.follows)
        parts.append(f"session {session.number} (began {session.began}, {upto} trials)")
    return f"--keep {number}: {', then '.join(parts)}, {branch[-1].ended}"


def set_aside(data: Path, source: str, participant: str) -> list[Path]:
    """A participant's folders as they were before each repair, and one that was broken off."""
    aside = data / ASIDE / source
    own = re.compile(rf"{re.escape(participant)}-[0-9]+|new\.{re.escape(participant)}")
    return sorted(path for path in aside.glob("*") if own.fullmatch(path.name))


def finished(data: Path, source: str) -> list[str]:
    """Who lacked a folder since a repair was broken off between its two renamings: they have the
    new one now, which its mark says to be whole."""
    found = []
    for new in sorted((data / ASIDE / source).glob("new.*")):
        name = new.name.removeprefix("new.")
        if any(new.glob(f"*{MARK}")) and not is_there(folder_of(data, source, name)):
            os.rename(new, folder_of(data, source, name))
            sync_folder(folder_of(data, source, name).parent)
            found.append(name)
    return found


def repair(data: Path, source: str, participant: str, keep: int, when: str) -> Path:
    """Let one branch count; the folder as it was is at the returned place. Raises InputError."""
    folder = folder_of(data, source, participant)
    sessions = sessions_of(folder)
    branch = branches(sessions)[keep]
    aside = data / ASIDE / source
    places = (aside / f"{participant}-{number}" for number in itertools.count(1))
    place = next(p for p in places if not is_there(p))
    new = aside / f"new.{participant}"
    if new.exists():  # of a repair that was broken off: it is made again
        shutil.rmtree(new)
    make_folder(new / "traces")
    try:
        for session, coming in zip(branch, (*branch[1:], None), strict=True):
            _whole(folder, new, session) if coming is None else _part(folder, new, session, coming)
    except BaseException:
        shutil.rmtree(new)
        raise
    left_out = [s.number for s in sessions if s not in branch]
    mark = {
        "repaired": when,
        "counts": [{"session": s.number, "trials": _rows(new, s)} for s in branch],
        "left_out": left_out,
        "as_it_was": place.relative_to(data).as_posix(),
    }
    write_new(new / f"{branch[-1].stem}{MARK}", json.dumps(mark, indent=2) + "\n")
    os.rename(folder, place)
    os.rename(new, folder)
    sync_folder(folder.parent)
    sync_folder(aside)
    return place


def _rows(folder: Path, session: Session) -> int:
    return (folder / f"{session.stem}{TRIALS_TABLE}").read_text("utf-8").count("\n") - 1


def _whole(folder: Path, new: Path, session: Session) -> None:
    """Every file of a session."""
    for path in (
        *folder.glob(f"{session.stem}_*"),
        *(folder / "traces").glob(f"session-{session.number}_*"),
    ):
        write_new(new / path.relative_to(folder), path.read_bytes())


def _part(folder: Path, new: Path, session: Session, coming: Session) -> None:
    """A session up to where another began: its rows, their traces, and its other files as then."""
    table = f"{session.stem}{TRIALS_TABLE}"
    if coming.follows == session.values[-1] and not coming.holds:
        return _whole(folder, new, session)
    lines = (folder / table).read_text("utf-8").split("\n")
    kept = lines[: session.values.index(coming.follows) + 1]
    write_new(new / table, "\n".join(kept) + "\n")
    write_new(new / f"{session.stem}{SIDECAR}", (folder / f"{session.stem}{SIDECAR}").read_bytes())
    for row in csv.DictReader(kept):
        for trace in (row["events_file"], row["camera_file"]):
            write_new(new / trace, (folder / trace).read_bytes())
    for name, digest in coming.holds.items():
        write_new(new / name, _as_it_was(folder / name, digest))
    return None


def _as_it_was(path: Path, digest: str) -> bytes:
    """The beginning of a file that grew by whole lines since it had this hash."""
    data, hashed, size = path.read_bytes(), hashlib.sha256(), 0
    if hashed.hexdigest() == digest:
        return b""
    for line in data.splitlines(keepends=True):
        hashed.update(line)
        size += len(line)
        if hashed.hexdigest() == digest:
            return data[:size]
    raise InputError(f"{path}: was changed since the session that follows began: cannot be cut")
