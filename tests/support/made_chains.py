"""Gives folders of made_data.py what the recorder writes besides: chains, traces, ends, ledger."""

from __future__ import annotations

import hashlib
import json
import sqlite3
from contextlib import closing
from pathlib import Path

from data_folders import ANSWERS, TRIALS

from seethrough.analysis.load.chain import link, seal_of, start_of


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def chain(folder: Path) -> Path:
    """Chain every participant's session; P01's end file."""
    for table in sorted(folder.glob("data/*/*/*_trials_data.csv")):
        chain_table(table)
    return folder / TRIALS.replace("_trials_data.csv", "_end.json")


def chain_table(path: Path) -> None:
    """Give a table a hash chain, traces and an end file, as the recorder does."""
    traces = path.parent / "traces"
    traces.mkdir()
    lines = path.read_text().rstrip("\n").split("\n")
    names = lines[0].split(",")
    header = lines[0] + ",events_sha256,camera_sha256,chain"
    sidecar = path.with_suffix(".json")
    who = {"participant": path.parent.name, "source": path.parent.parent.name, "session": 1}
    about = {**json.loads(sidecar.read_text()), **who, "chain": {}}
    before = start_of(about, header)
    sidecar.write_text(json.dumps({**about, "chain": {"start": before}}))
    out = [header]
    for number, line in enumerate(lines[1:], start=1):
        cells = line.split(",")
        for trace in ("events", "camera"):
            name = f"traces/session-1_trial-{number:03d}_{trace}.csv"
            (path.parent / name).write_text(f"t,{trace}\n{number},0.5\n")
            cells[names.index(f"{trace}_file")] = name
        cells += [
            sha256(path.parent / cells[names.index(f"{t}_file")]) for t in ("events", "camera")
        ]
        before = link(before, ",".join(cells))
        out.append(",".join([*cells, before]))
    path.write_text("\n".join(out) + "\n")
    training = traces / "session-1_training-101_events.csv"
    training.write_text("t,event\n")
    answers = path.with_name(path.name.replace("_trials_", "_questionnaire_"))
    files = {str(p.relative_to(path.parent)): sha256(p) for p in (answers, training) if p.is_file()}
    end = {"status": "complete", "trials": len(lines) - 1, "chain": before, "files": files}
    close(path, end)


def close(table: Path, end: dict) -> None:
    """Write a session's end file, with its seal."""
    path = table.with_name(table.name.replace("_trials_data.csv", "_end.json"))
    path.write_text(json.dumps({**end, "seal": seal_of(end)}))


def enter(folder: Path, **statuses: str) -> None:
    """A ledger with these participants; everybody there complete, if none is named."""
    found = sorted(p.name for p in folder.glob("data/human/*"))
    entries = statuses or dict.fromkeys(found, "complete")
    with closing(sqlite3.connect(folder / "ledger.sqlite")) as file, file:
        file.execute("CREATE TABLE seethrough_entries (id INTEGER PRIMARY KEY, study TEXT, "
                     "slot INTEGER, participant TEXT, status TEXT)")  # fmt: skip
        file.executemany(
            "INSERT INTO seethrough_entries (study, slot, participant, status) "
            "VALUES ('made', ?, ?, ?)",
            [(slot, *entry) for slot, entry in enumerate(entries.items(), start=1)],
        )


__all__ = ["ANSWERS", "TRIALS", "chain", "chain_table", "close", "enter", "sha256"]
