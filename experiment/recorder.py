"""The only writer of a study's data folder. Files are created exclusively, never overwritten.

A trial's row is appended, flushed and fsynced as the trial ends: what was completed survives a
crash. The folder's layout is in CONVENTIONS.md, the columns in experiment/columns.py.
"""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TextIO

from experiment.columns import NOTES, QUESTIONNAIRE, TABLES, TRIALS, Column
from experiment.design import Trial
from experiment.errors import InputError
from experiment.folders import folder_of, next_free, stem_of
from experiment.trial import TrialRecord
from tasks.base import View
from tasks.events import Event, Tick


@dataclass(frozen=True)
class Who:
    """Whose session is recorded, and what the sidecar says about how."""

    study: str
    participant: str
    source: str
    slot: int
    provenance: Mapping[str, Any]
    session: int = 1  # one more each time an interrupted session is gone on with


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
    ) -> None:
        """`attempts`: how often each trial number was completed before this session."""
        self.who = who
        self._attempts = dict(attempts or {})
        self._now = now
        self.folder = folder_of(data, who.source, who.participant)
        self.stem = stem_of(who.study, who.participant, who.session)
        describe_dataset(data, who.study)
        try:
            self.folder.mkdir(parents=True, exist_ok=who.session > 1)
            (self.folder / "traces").mkdir(exist_ok=who.session > 1)
        except FileExistsError:
            raise InputError(
                f"{self.folder}: participant {who.participant} exists already; "
                f"the next free one is {next_free(data, who.source)}"
            ) from None
        except OSError as error:
            raise InputError(f"{self.folder}: cannot be written: {error.strerror}") from None
        self._json("trials_data.json", {"started": now(), **asdict(who)})
        self._trials = _Table(self.folder / f"{self.stem}_trials_data.csv", TRIALS)
        self._questions: _Table | None = None
        self._notes: _Table | None = None
        self._rows = self._asked = self._noted = 0
        self._traces: _Traces | None = None
        self._started = ""

    def trial_begins(self, trial: Trial) -> None:
        """Open the traces of a trial; those of an unfinished one are kept as they are."""
        if self._traces:
            self._traces.close()
        kind = "training" if trial.training else "trial"
        number = trial.task_set * 100 + trial.in_set if trial.training else trial.number
        name = f"session-{self.who.session}_{kind}-{number:03d}"
        attempt = self._attempts.get(trial.number, 0) + 1
        if attempt > 1 and not trial.training:
            name += f"_attempt-{attempt}"
        self._traces = _Traces(self.folder / "traces", name)
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
        self._attempts[number] = attempt = self._attempts.get(number, 0) + 1
        self._trials.append(
            {
                **self._identity(f"trial{number:03d}" + (f".{attempt}" if attempt > 1 else "")),
                **_trial_row(record),
                "slot": self.who.slot,
                "attempt": attempt,
                "started": self._started,
                "events_file": f"traces/{self._traces.events_name}",
                "camera_file": f"traces/{self._traces.camera_name}",
            }
        )

    def answers(self, rows: list[Mapping[str, str]]) -> None:
        """Append rows of the questionnaire; they are on disk when this returns."""
        for row in rows:
            if self._questions is None:
                path = self.folder / f"{self.stem}_questionnaire_data.csv"
                self._questions = _Table(path, QUESTIONNAIRE)
            self._asked += 1
            self._questions.append({**self._identity(f"question{self._asked:03d}"), **row})

    def note(self, trial: Trial | None, text: str) -> None:
        """Append a note of the experimenter's; it is on disk when this returns."""
        if self._notes is None:
            self._notes = _Table(self.folder / f"{self.stem}_notes_data.csv", NOTES)
        self._noted += 1
        number = trial.number if trial and not trial.training else None
        row = {"trial": number, "written": self._now(), "text": text}
        self._notes.append({**self._identity(f"note{self._noted:03d}"), **row})

    def close(self, status: str) -> None:
        """Close the files and note how the session ended: `complete`, `left` or `time limit`."""
        if self._traces:
            self._traces.close()
        for table in (self._trials, self._questions, self._notes):
            if table is not None:
                table.close()
        self._json("end.json", {"ended": self._now(), "status": status, "trials": self._rows})

    def _identity(self, row: str) -> dict[str, Any]:
        who = self.who
        return {
            "row_id": f"{who.source}-{who.participant}-{who.session}-{row}",
            "study": who.study,
            "participant": who.participant,
            "session": who.session,
            "source": who.source,
        }

    def _json(self, name: str, content: Mapping[str, Any]) -> None:
        _write_new(self.folder / f"{self.stem}_{name}", json.dumps(content, indent=2) + "\n")


def _trial_row(record: TrialRecord) -> dict[str, Any]:
    trial, outcome = record.trial, record.outcome
    row = {
        "trial": trial.number,
        "block": trial.block,
        "task_set": trial.task_set,
        "trial_in_set": trial.in_set,
        "transparency": trial.transparency,
        "scenario": trial.scenario,
        "task": trial.task,
        "scene": trial.scene,
        "targets": record.targets,
        "time": record.time,
        "time_clean": record.time - record.away,
        "timed_out": record.timed_out,
        "frames": record.frames,
        "frames_missed": record.frames_missed,
        "worst_frame": record.worst_frame,
        "path_length": record.path_length,
        "turned": record.turned,
    }
    if outcome is not None:
        row |= asdict(outcome)
    return row


class _Table:
    """A CSV file that grows by whole, fsynced rows."""

    def __init__(self, path: Path, columns: tuple[Column, ...]) -> None:
        self._names = [c.name for c in columns]
        self._file: TextIO = _open_new(path)
        self._writer = csv.writer(self._file, lineterminator="\n")
        self._write(self._names)

    def append(self, row: Mapping[str, Any]) -> None:
        """One row; columns that are not given stay empty. Unknown columns raise KeyError."""
        unknown = set(row) - set(self._names)
        if unknown:
            raise KeyError(f"columns not declared: {sorted(unknown)}")
        self._write([_cell(row.get(name)) for name in self._names])

    def _write(self, cells: list[str]) -> None:
        self._writer.writerow(cells)
        self._file.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        self._file.close()


class _Traces:
    """What happened between a trial's first frame and its end, in two files of its own."""

    def __init__(self, folder: Path, name: str) -> None:
        self.events_name, self.camera_name = f"{name}_events.csv", f"{name}_camera.csv"
        self._events = _open_new(folder / self.events_name)
        self._camera = _open_new(folder / self.camera_name)
        self._events.write("time,event,x,y,dx,dy,dragging,key\n")
        self._camera.write("time,eye_x,eye_y,eye_z,forward_x,forward_y,forward_z,digest\n")
        self._last_camera: Any = None

    def event(self, event: Event) -> None:
        if isinstance(event, Tick):
            kind, rest = "tick", ",,,,,"
        else:
            values = asdict(event)
            kind = type(event).__name__
            names = ("x", "y", "dx", "dy", "dragging", "key")
            rest = ",".join(_cell(values.get(n)) for n in names)
        self._events.write(f"{event.time!r},{kind},{rest}\n")

    def frame(self, time: float, view: View, digest: str) -> None:
        camera = view.camera
        values = [] if camera is self._last_camera else [*camera.eye, *camera.forward]
        cells = [repr(float(v)) for v in values] or [""] * 6
        self._camera.write(",".join([repr(time), *cells, digest]) + "\n")
        self._last_camera = camera

    def close(self) -> None:
        """Flush to disk; closing twice does no harm."""
        for file in (self._events, self._camera):
            if not file.closed:
                file.flush()
                os.fsync(file.fileno())
                file.close()


def describe_dataset(data: Path, study: str) -> None:
    """Psych-DS: what the folder holds, and every column of every table in it."""
    path = data / "dataset_description.json"
    if path.exists():
        return
    columns = {c.name: c for table in TABLES.values() for c in table}
    content = {
        "@context": "https://schema.org/",
        "@type": "Dataset",
        "name": study,
        "description": f"Trials and questionnaires of the study {study}, recorded by Seethrough.",
        "variableMeasured": [
            {
                "@type": "PropertyValue",
                "name": c.name,
                "description": c.description,
                **({"unitText": c.unit} if c.unit else {}),
            }
            for c in columns.values()
        ],
    }
    try:
        data.mkdir(parents=True, exist_ok=True)
        _write_new(path, json.dumps(content, indent=2, ensure_ascii=False) + "\n")
    except FileExistsError:
        return  # another station described the study first: the same words
    except OSError as error:
        raise InputError(f"{data}: cannot be written: {error.strerror}") from None


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def _open_new(path: Path) -> TextIO:
    return open(path, "x", encoding="utf-8", newline="")


def _write_new(path: Path, text: str) -> None:
    with _open_new(path) as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
