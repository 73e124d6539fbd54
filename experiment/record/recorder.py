"""The only writer of a study's data folder. Files are created exclusively, never overwritten.

A trial's row is appended, flushed and fsynced as the trial ends: what was completed survives a
crash. The folder's layout is in CONVENTIONS.md, the columns in experiment/record/columns.py.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from seethrough.analysis.load.person import Folder
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.folders import folder_of, next_free, plain, stem_of, taken
from seethrough.experiment.files.private import make_folder, refused, write_new
from seethrough.experiment.record.chain import (
    END,
    TRIALS_TABLE,
    end_of,
    latest_table,
    loose_files,
    seal_of,
    start_of,
)
from seethrough.experiment.record.columns import Column, with_factors
from seethrough.experiment.record.dataset import describe_dataset
from seethrough.experiment.record.record_files import Table, Traces, ask_again, header_of, mend
from seethrough.experiment.record.trial_record import TrialRecord
from seethrough.renderer.events import Event
from seethrough.tasks.kit.base import View

if TYPE_CHECKING:
    from seethrough.experiment.study.design.design import Trial


@dataclass(frozen=True)
class Who:
    """Whose session is recorded, and what the sidecar says about how."""

    study: str
    participant: str
    source: str
    slot: int
    provenance: Mapping[str, object]
    session: int = 1  # one more each time an interrupted session is gone on with
    design: Mapping[str, Any] = field(default_factory=dict)  # factors and tasks, for the analysis


def utc_now() -> str:
    """The time for a record: UTC, ISO 8601, milliseconds."""
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


class FileRecorder:
    """Writes one participant's session. Raises InputError if there are files of it already."""

    def __init__(
        self,
        data: Path,
        who: Who,
        now: Callable[[], str] = utc_now,
        attempts: Mapping[int, int] | None = None,
        guard: Callable[[], None] = lambda: None,
    ) -> None:
        """`attempts`: how often each trial number was completed before this session; `guard` is
        called before each write, and raises where the session is somebody else's by now."""
        self.who = who
        self._guard = guard
        self._attempts = dict(attempts or {})
        self._now = now
        self.folder = folder_of(data, who.source, who.participant)
        self.stem = stem_of(who.study, who.participant, who.session)
        self._columns = with_factors(who.design.get("factors", ()), who.design.get("tasks", ()))
        _check_alike(data, who)
        describe_dataset(data, who.study, self._columns)
        try:
            self._trials = self._begin(data)
        except FileExistsError:
            raise InputError(
                f"{self.folder}: participant {who.participant} exists already; "
                f"the next free one is {next_free(data, who.source)}"
            ) from None
        except OSError as error:
            raise InputError(f"{self.folder}: cannot be written: {error.strerror}") from None
        self._questions: Table | None = None
        self._notes: Table | None = None
        self._rows = self._asked = self._noted = 0
        self._traces: Traces | None = None
        self._started = ""

    def _begin(self, data: Path) -> Table:
        """Folder, sidecar and table. Whoever writes the sidecar first has the session."""
        sidecar, table = (self._file(f"trials_data.{kind}") for kind in ("json", "csv"))
        if sidecar.exists():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(sidecar))
        for place in (data / "data", self.folder.parent, self.folder, self.folder / "traces"):
            if place.is_symlink():  # whoever planted it would get what is recorded
                raise InputError(f"{place}: a link: expected a folder of this study's own")
        make_folder(self.folder / "traces")
        chain: dict[str, object] = {}
        content = {"started": self._now(), **asdict(self.who), "chain": chain}
        before = latest_table(self.folder)
        if before is not None:
            _check_before(self.folder, data)
            content["mended"] = mend(self.folder)
            chain["follows"] = end_of(before)
            if not before.with_name(before.name.replace(TRIALS_TABLE, END)).exists():
                # It was killed: nothing else holds them.
                chain["holds"] = loose_files(before, killed=True)
        start = start_of(content, header_of(self._columns["trials"]))
        chain["start"] = start
        write_new(sidecar, _json(content))
        try:
            return Table(table, self._columns["trials"], start, self._guard)
        except OSError:
            sidecar.unlink()  # no session began
            raise

    def trial_begins(self, trial: Trial) -> None:
        """Open the traces of a trial; those of an unfinished one are kept as they are."""
        self._guard()
        if self._traces:
            self._traces.close()
        kind = "training" if trial.training else "trial"
        number = trial.task_set * 100 + trial.in_set if trial.training else trial.number
        name = f"session-{self.who.session}_{kind}-{number:03d}"
        attempt = self._attempts.get(trial.number, 0) + 1
        if attempt > 1 and not trial.training:
            name += f"_attempt-{attempt}"
        self._traces = Traces(self.folder / "traces", name, self._guard)
        self._started = self._now()

    def event(self, event: Event) -> None:
        """One input event of the running trial."""
        assert self._traces is not None
        self._traces.event(event)

    def frame(self, time: float, view: View, digest: str = "") -> None:
        """One frame shown in the running trial; the digest of its pixels now and then."""
        assert self._traces is not None
        self._traces.frame(time, view, digest)

    def trial_ends(self, record: TrialRecord) -> None:
        """Append the trial's row; it is on disk when this returns."""
        assert self._traces is not None
        self._traces.close()
        number = record.trial.number
        self._rows += 1
        events, camera = self._traces.events, self._traces.camera
        self._attempts[number] = attempt = self._attempts.get(number, 0) + 1
        self._trials.append(
            {
                **self._identity(f"trial{number:03d}" + (f".{attempt}" if attempt > 1 else "")),
                **trial_row(record),
                "slot": self.who.slot,
                "attempt": attempt,
                "started": self._started,
                "events_file": f"traces/{events.path.name}",
                "events_sha256": events.sha256,
                "camera_file": f"traces/{camera.path.name}",
                "camera_sha256": camera.sha256,
            }
        )

    def answers(self, rows: list[Mapping[str, str]]) -> None:
        """Append rows of the questionnaire; they are on disk when this returns."""
        if not rows:
            return
        if self._questions is None:
            self._questions = self._another("questionnaire", self._columns["questionnaire"])
        first = self._asked + 1
        self._asked += len(rows)
        self._questions.append(
            *(
                {**self._identity(f"question{number:03d}"), **row}
                for number, row in enumerate(rows, start=first)
            )
        )

    def note(self, trial: Trial | None, text: str) -> None:
        """Append a note of the experimenter's; it is on disk when this returns."""
        if self._notes is None:
            self._notes = self._another("notes", self._columns["notes"])
        self._noted += 1
        number = trial.number if trial and not trial.training else None
        row = {"trial": number, "written": self._now(), "text": text}
        self._notes.append({**self._identity(f"note{self._noted:03d}"), **row})

    def _another(self, name: str, columns: tuple[Column, ...]) -> Table:
        path = self._file(f"{name}_data.csv")
        try:
            return Table(path, columns, guard=self._guard)
        except OSError as error:
            raise refused(error, path) from None

    def close(self, status: str) -> None:
        """Close the files and note how the session ended (experiment/session/session.py)."""
        with ExitStack() as last:  # from the last to the first; an error in one stops no other
            last.callback(self._end, status)
            for file in (self._trials, self._questions, self._notes, self._traces):
                if file is not None:
                    last.callback(file.close)

    def _end(self, status: str) -> None:
        """The end file: how it ended, the chain's end, and hashes of what is not in the chain."""
        self._guard()
        how = {"ended": self._now(), "status": status, "trials": self._rows}
        files = loose_files(self._trials.path)
        content = {**how, "chain": self._trials.chain, "files": files}
        path = self._file("end.json")
        try:
            write_new(path, _json({**content, "seal": seal_of(content)}))
        except OSError as error:
            raise refused(error, path) from None
        ask_again(self._guard, path.unlink)

    def _file(self, name: str) -> Path:
        return self.folder / f"{self.stem}_{name}"

    def _identity(self, row: str) -> dict[str, object]:
        who = self.who
        return {
            "row_id": f"{who.source}-{who.participant}-{who.session}-{row}",
            "study": who.study,
            "participant": who.participant,
            "session": who.session,
            "source": who.source,
        }


def _check_alike(data: Path, who: Who) -> None:
    """File names hold an id's letters and digits alone: A-1, A1 and A_1 would be one subject."""
    own = plain(who.participant)
    same = [p for p in taken(data, who.source) if p != who.participant and plain(p) == own]
    if same:
        raise InputError(
            f"--participant = {who.participant!r}: {same[0]!r} has files already: expected an id "
            "that differs in its letters and digits, of which file names are made"
        )


def _check_before(folder: Path, data: Path) -> None:
    """Nobody goes on after files that are not as they were written: it would vouch for them."""
    for line in Folder(folder, data).read().problems[:1]:
        raise InputError(f"{data}: {line}; expected the earlier files as they were written")


def _json(content: Mapping[str, object]) -> str:
    return json.dumps(content, indent=2) + "\n"


def trial_row(record: TrialRecord) -> dict[str, object]:
    """What a trial's record says about its row of the trial table."""
    trial, outcome = record.trial, record.outcome
    row = {
        "trial": trial.number,
        "block": trial.block,
        "task_set": trial.task_set,
        "trial_in_set": trial.in_set,
        **trial.levels,
        "world": trial.world,
        "task": trial.task,
        "scene": trial.scene,
        "targets": record.targets,
        "time": record.time,
        "time_within": record.within,
        "time_clean": record.time - record.away,
        "timed_out": record.timed_out,
        "early": record.early,
        "frames": record.frames,
        "frames_missed": record.frames_missed,
        "worst_frame": record.worst_frame,
        "path_length": record.path_length,
        "turned": record.turned,
    }
    if outcome is not None:
        row |= {f.name: getattr(outcome, f.name) for f in fields(outcome) if f.name != "more"}
        row |= outcome.more
    return row
