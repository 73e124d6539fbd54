"""Brain Imaging Data Structure: trials as events of a behavioural task, answers as phenotype."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from datetime import datetime
from math import inf
from pathlib import Path

from seethrough.analysis.load.files import read_json
from seethrough.experiment.export.dataset import Dataset, Row, as_json, check_labels, harmless, put
from seethrough.experiment.export.wide import in_sets, item_name
from seethrough.experiment.record.columns import Column

VERSION = "1.10.0"
TASK = "seethrough"
IDENTITY = ("row_id", "study", "participant", "session", "source", "events_file", "camera_file")
FIRST = {
    "onset": {"Description": "first frame of the trial, from the session's first", "Units": "s"},
    "duration": {"Description": "completion time", "Units": "s"},
    "trial_type": {"Description": "levels of the factors and the task, with _ between"},
    "response_time": {"Description": "first frame to the answer's confirmation", "Units": "s"},
}
README = """{name}

Trials of a user study of occlusion management, recorded by Seethrough, exported as BIDS {version}.
Events are trials; the columns are described in task-{task}_events.json.
"""


def bids(data: Dataset, out: Path) -> None:
    """A BIDS dataset without recordings of the brain: sub-…/ses-…/beh. Raises InputError."""
    labels = _labels(data.participants)
    about = {"Name": data.name, "BIDSVersion": VERSION, "DatasetType": "raw"}
    put(out / "dataset_description.json", as_json(about))
    put(out / "README", README.format(name=data.name, version=VERSION, task=TASK))
    kept = _kept(data)
    columns = {**FIRST, **{c.name: _column(c) for c in kept}}
    put(out / f"task-{TASK}_events.json", as_json({"TaskName": TASK, **columns}))
    _participants(data, out, labels)
    sessions: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in data.tables["trials"]:
        sessions[row["participant"], row["session"]].append(row)
    for (participant, session), rows in sessions.items():
        label = labels[participant]
        stem = f"sub-{label}_ses-{session}_task-{TASK}_events"
        folder = out / f"sub-{label}" / f"ses-{session}" / "beh"
        put(folder / f"{stem}.tsv", _tsv([*FIRST, *(c.name for c in kept)], _events(rows, data)))
        put(folder / f"{stem}.json", as_json(_presentation(data, participant, session)))
    if data.tables["questionnaire"]:
        _phenotype(data, out, labels)


def _labels(participants: Sequence[str]) -> dict[str, str]:
    """BIDS labels are letters and digits only."""
    check_labels("bids", participants)
    return {p: re.sub(r"[^A-Za-z0-9]", "", p) for p in participants}


def _kept(data: Dataset) -> tuple[Column, ...]:
    """The columns of a trial that are no record's own."""
    return tuple(
        c for c in data.columns("trials")
        if c.name not in (*IDENTITY, "started", "chain") and not c.name.endswith("sha256")
    )  # fmt: skip


def _events(rows: Sequence[Row], data: Dataset) -> list[dict[str, str]]:
    """Trials with their onset from the session's first, in the order of their onsets.

    Rows that do not say when they started (data mode's) follow in their order, without an onset.
    """
    starts = [datetime.fromisoformat(row["started"]) for row in rows if row["started"]]
    onsets = [_onset(row["started"], starts) for row in rows]
    events = []
    for onset, row in sorted(zip(onsets, rows, strict=True), key=lambda pair: pair[0]):
        kind = "_".join([*(row[factor] for factor in data.factors), row["task"]])
        first = {
            "onset": "" if onset == inf else repr(onset),
            "duration": row["time"],
            "trial_type": kind,
        }
        kept = {c.name: row[c.name] for c in _kept(data)}
        events.append({**first, "response_time": row["time"], **kept})
    return events


def _onset(started: str, starts: Sequence[datetime]) -> float:
    """Seconds from the first start; infinity where nothing says when."""
    return (datetime.fromisoformat(started) - min(starts)).total_seconds() if started else inf


def _presentation(data: Dataset, participant: str, session: str) -> dict[str, object]:
    """How it was shown, from the session's sidecar."""
    folder = data.folder / "data" / data.source / participant
    found = list(folder.glob(f"*_session-{session}_trials_data.json"))
    made: object = read_json(found[0], data.folder).get("provenance") if found else None
    made = made if isinstance(made, Mapping) else {}
    display = made.get("display", {})
    return {
        "StimulusPresentation": {
            "OperatingSystem": made.get("system", "unknown"),
            "SoftwareName": "Seethrough",
            "SoftwareVersion": made.get("versions", {}).get("seethrough", "unknown"),
            "Renderer": display.get("renderer", "unknown"),
            "WindowSize": display.get("size", "unknown"),
            "RefreshRate": display.get("refresh_declared", "unknown"),
        }
    }


def _participants(data: Dataset, out: Path, labels: Mapping[str, str]) -> None:
    slots = {row["participant"]: row["slot"] for row in data.tables["trials"]}
    rows = [{"participant_id": f"sub-{labels[p]}", "slot": slots[p]} for p in data.participants]
    put(out / "participants.tsv", _tsv(["participant_id", "slot"], rows))
    slot = next(c for c in data.columns("trials") if c.name == "slot")
    put(out / "participants.json", as_json({"slot": _column(slot)}))


def _phenotype(data: Dataset, out: Path, labels: Mapping[str, str]) -> None:
    rows: dict[str, dict[str, str]] = {}
    places = in_sets(data)
    for answer in data.tables["questionnaire"]:
        if answer["participant"] in labels:
            label = f"sub-{labels[answer['participant']]}"
            row = rows.setdefault(label, {"participant_id": label})
            row[item_name(answer, data.factors, places)] = answer["value"] or harmless(
                answer["text"]
            )
    items = sorted({name for row in rows.values() for name in row} - {"participant_id"})
    path = out / "phenotype"
    put(path / "questionnaire.tsv", _tsv(["participant_id", *items], list(rows.values())))
    about = {name: {"Description": f"questionnaire: {name}"} for name in items}
    put(path / "questionnaire.json", as_json(about))


def _column(column: Column) -> dict[str, object]:
    about: dict[str, object] = {"Description": column.description}
    if column.unit:
        about["Units"] = column.unit
    if column.levels:
        about["Levels"] = {level: level for level in column.levels}
    return about


def _tsv(columns: Sequence[str], rows: Sequence[Mapping[str, str]]) -> str:
    """Tab-separated; what does not apply is n/a; no cell holds a tab or a line's end."""
    lines = [[" ".join(row.get(name, "").split()) or "n/a" for name in columns] for row in rows]
    return "".join("\t".join(line) + "\n" for line in [list(columns), *lines])
