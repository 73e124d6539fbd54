"""Where an interrupted session goes on, read from the participant's files; those stay as is."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from seethrough.analysis.load.chain import LONGEST_CELL
from seethrough.experiment.errors import InputError, shown
from seethrough.experiment.files.folders import folder_of, next_free
from seethrough.experiment.files.json_files import number_in, part_of, read_object
from seethrough.experiment.record.chain import ANSWERS_TABLE
from seethrough.experiment.record.record_files import whole_rows
from seethrough.experiment.session.questionnaire import Given, Item, Said, item_of, said_in
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.design.design import TaskSet, session_for


@dataclass(frozen=True)
class Past:
    """What a participant's folder says: sessions begun, how often each trial was completed, and
    what was answered on the pages around them."""

    sessions: int
    complete: bool
    attempts: Mapping[int, int]
    given: Given
    slot: int
    digest: str
    made: Mapping[str, object]  # the latest session's provenance


def past(data: Path, source: str, participant: str) -> Past | None:
    """The participant's past in this study, or None if there is none. Raises InputError."""
    folder = folder_of(data, source, participant)
    if not folder.exists():
        return None
    sidecars = sorted(folder.glob("*_trials_data.json"))
    if not sidecars and not list(folder.glob("*_trials_data.csv")):
        return None  # killed before anything was recorded: as if it had not begun
    if not sidecars:
        raise InputError(f"{folder}: expected a file …_trials_data.json, found none")
    said = [read_object(path) for path in sidecars]
    numbers = [number_in(s, "session", path) for s, path in zip(said, sidecars, strict=True)]
    last = numbers.index(max(numbers))
    ends = [read_object(path) for path in folder.glob("*_end.json")]
    attempts: Counter[int] = Counter()
    for table in sorted(folder.glob("*_trials_data.csv")):
        attempts.update(_completed(table))
    return Past(
        sessions=max(numbers),
        complete=any(e.get("status") == "complete" for e in ends),
        attempts=dict(attempts),
        given=_given(folder),
        slot=number_in(said[0], "slot", sidecars[0]),
        digest=str(part_of(said[0], "provenance", sidecars[0]).get("study_sha256", "")),
        made=part_of(said[last], "provenance", sidecars[last]),
    )


@dataclass(frozen=True)
class Start:
    """Where a session starts: its number, its slot, what need not be played or asked again."""

    session: int
    slot: int
    done: frozenset[int]
    attempts: Mapping[int, int]
    given: Given
    made: Mapping[str, object] | None = None  # provenance of the session that it goes on from


def starting_point(study: Study, data: Path, source: str, participant: str, slot: int) -> Start:
    """The start of a new session, or where an interrupted one goes on. Raises InputError.

    A complete participant is refused, and so is one who began another version of the study.
    """
    before = past(data, source, participant)
    if before is None:
        return Start(1, slot, frozenset(), {}, {})
    folder = folder_of(data, source, participant)
    if before.complete:
        raise InputError(
            f"{folder}: participant {participant} exists already; "
            f"the next free one is {next_free(data, source)}"
        )
    if before.digest != study.digest():
        raise InputError(
            f"{folder}: participant {participant} began another version of this study "
            f"({before.digest[:12]}, now {study.digest()[:12]}); expected the same"
        )
    task_sets = session_for(before.slot, study.plan)
    done = already_done(task_sets, before, study.session.resume)
    return Start(before.sessions + 1, before.slot, done, before.attempts, before.given, before.made)


def going_on(study: Study, start: Start) -> str:
    """A line for the experimenter: where an interrupted session goes on."""
    sets = session_for(start.slot, study.plan)
    coming = [t for s in sets for t in s.trials if t.number not in start.done]
    where = f"trial {coming[0].number}, part {coming[0].task_set} of {len(sets)}" if coming else ""
    again = sum(t.number in start.attempts for t in coming)
    said = f"session {start.session} goes on at {where or 'the questionnaire'}"
    return f"{said}; {again} trials of a broken block are played again" if again else said


def already_done(task_sets: tuple[TaskSet, ...], past_: Past, policy: str) -> frozenset[int]:
    """Numbers of the trials that need not be played again.

    `policy` "trial": every completed trial counts. "block": the block in which the session broke
    off is played again from its start, so that no condition is torn apart (its trials' `attempt`
    says so); blocks completed before count.
    """
    done = frozenset(past_.attempts)
    if policy == "trial":
        return done
    blocks: dict[int, set[int]] = {}
    for task_set in task_sets:
        for trial in task_set.trials:
            blocks.setdefault(trial.block, set()).add(trial.number)
    whole = [numbers for numbers in blocks.values() if numbers <= done]
    return frozenset().union(*whole)


def _completed(table: Path) -> list[int]:
    """Trial numbers of a table's whole rows."""
    return [_number(row["trial"], table) for row in _rows(table, ("trial",))]


def _number(cell: str, table: Path) -> int:
    if not (cell.isascii() and cell.isdecimal()):
        raise InputError(f"{table}: trial = {shown(cell)}: expected a whole number")
    return int(cell)


def _given(folder: Path) -> Given:
    """What was answered in the sessions so far, the last answer to each item."""
    given: dict[Item, Said] = {}
    for table in sorted(folder.glob(f"*{ANSWERS_TABLE}")):
        for row in _rows(table, ("item", "value")):
            given.pop(item_of(row), None)  # asked again after a trial that was played again
            given[item_of(row)] = said_in(row)
    return given


def _rows(table: Path, columns: tuple[str, ...]) -> list[dict[str, str]]:
    """A table's whole rows; one that a crash cut short does not count. Raises InputError."""
    data = table.read_bytes()
    text = data[: whole_rows(data)].decode("utf-8", "replace")
    csv.field_size_limit(LONGEST_CELL)  # a remark may be longer than Python's own limit
    rows = csv.reader(io.StringIO(text, newline=""))
    header = next(rows, [])
    for name in columns:
        if name not in header:
            found = ", ".join(header) or "none"
            raise InputError(f"{table}: expected a column {name}, found {found}")
    return [dict(zip(header, row, strict=True)) for row in rows if len(row) == len(header)]
