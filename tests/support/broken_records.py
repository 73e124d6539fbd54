"""Ways to break a recorded folder, chains, ends, traces and ledger included: each has to be seen.

For broken_data.py; every function takes the folder as made_chains.py leaves it and a generator, and
tells what it did. No value is changed together with its hash: who recomputes the chain is a forger,
and only a seal kept elsewhere shows what they did (SECURITY.md).
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
from pathlib import Path

import numpy as np


def pick(rng: np.random.Generator, options):
    return options[int(rng.integers(len(options)))]


def recorded(folder: Path, pattern: str = "*") -> list[Path]:
    """Files of participants, all of which hashes hold."""
    return sorted(p for p in (folder / "data").rglob(pattern) if p.is_file())


def saved_again(folder, rng):
    """Opened and saved by another program, perhaps with a cell changed on the way."""
    path = pick(rng, recorded(folder, "*_data.csv"))
    rows = list(csv.reader(io.StringIO(path.read_text("utf-8"), newline="")))
    changed = bool(rng.random() < 0.5)
    if changed:
        row = rows[int(rng.integers(1, len(rows)))]
        at = int(rng.integers(len(row)))
        row[at] = row[at] + "0" if row[at] else "1"
    how = pick(rng, ("crlf", "cr", "bom", "quoted", "no end", "utf-16", ";", "tabs", "blank"))
    quoting = csv.QUOTE_ALL if how == "quoted" else csv.QUOTE_MINIMAL
    separator = {";": ";", "tabs": "\t"}.get(how, ",")
    end = {"crlf": "\r\n", "cr": "\r", "blank": "\n\n"}.get(how, "\n")
    out = io.StringIO()
    csv.writer(out, quoting=quoting, delimiter=separator, lineterminator=end).writerows(rows)
    text = out.getvalue()[:-1] if how == "no end" else out.getvalue()
    code = {"bom": "utf-8-sig", "utf-16": "utf-16"}.get(how, "utf-8")
    path.write_bytes(text.encode(code))
    return f"{path.name}: {how}{', a cell changed' if changed else ''}"


def changed(folder, rng):
    """Any digit or letter of any recorded file, one for another."""
    path = pick(rng, recorded(folder))
    data = bytearray(path.read_bytes())
    places = [m.start() for m in re.finditer(rb"[A-Za-z0-9]", bytes(data))]
    at = pick(rng, places)
    data[at] = int(pick(rng, [b for b in b"0123456789abcdefXYZ" if b != data[at]]))
    path.write_bytes(bytes(data))
    return f"{path.name}: byte {at}"


def removed(folder, rng):
    """A file, several kinds of files, or a participant."""
    own = pick(rng, sorted((folder / "data" / "human").iterdir()))
    kinds = ("*_trials_data.csv", "*_trials_data.json", "*_end.json", "*_questionnaire_data.csv",
             "traces/*-003_events.csv", "traces/*-101_events.csv")  # fmt: skip
    count = int(rng.integers(0, len(kinds)))
    if count == 0:
        shutil.rmtree(own)
        return f"{own.name}: the folder"
    chosen = [str(k) for k in rng.permutation(kinds)[:count]]
    for kind in chosen:
        for path in own.glob(kind):
            path.unlink()
    return f"{own.name}: {', '.join(chosen)}"


def replaced(folder, rng):
    """Something else under a file's name."""
    path = pick(rng, [*recorded(folder), folder / "ledger.sqlite"])
    path.unlink()
    how = pick(rng, ("folder", "pipe", "nowhere", "out", "itself", "device", "empty", "nulls"))
    if how == "folder":
        path.mkdir()
    elif how == "pipe":
        os.mkfifo(path)
    elif how in ("empty", "nulls"):
        path.write_bytes(b"" if how == "empty" else b"\0" * 300)
    else:
        target = {"nowhere": "gone", "out": "/etc/hostname", "itself": path.name}
        path.symlink_to(target.get(how, "/dev/zero"))
    return f"{path.name}: {how}"


def stripped(folder, rng):
    """The chain cut off, in as many places as somebody would think of."""
    table = pick(rng, recorded(folder, "*_trials_data.csv"))
    how = [w for w in ("column", "sidecar", "key", "end") if rng.random() < 0.6] or ["column"]
    if "column" in how:
        lines = table.read_text("utf-8").split("\n")
        table.write_text("\n".join(line.rpartition(",")[0] for line in lines), "utf-8")
    sidecar = table.with_suffix(".json")
    if "sidecar" in how:
        sidecar.unlink()
    elif "key" in how:
        about = json.loads(sidecar.read_text("utf-8"))
        del about["chain"]
        sidecar.write_text(json.dumps(about), "utf-8")
    if "end" in how:
        Path(str(table).replace("_trials_data.csv", "_end.json")).unlink()
    return f"{table.name}: without {', '.join(how)}"


def renamed(folder, rng):
    """A file or a folder under another name, or twice."""
    own = pick(rng, sorted((folder / "data" / "human").iterdir()))
    how = pick(rng, ("folder", "copy", "exchange", "file", "session", "source"))
    if how == "folder":
        own.rename(own.with_name("P09"))
    elif how == "copy":
        shutil.copytree(own, own.with_name("P09"))
    elif how == "exchange":
        for old, new in (("P01", "P00"), ("P02", "P01"), ("P00", "P02")):
            own.with_name(old).rename(own.with_name(new))
    elif how == "source":
        shutil.move(folder / "data" / "human", folder / "data" / "pilot")
    else:
        path = pick(rng, sorted(p for p in own.iterdir() if p.is_file()))
        old, new = (".", ".old.") if how == "file" else ("session-1", "session-2")
        path.rename(path.with_name(path.name.replace(old, new)))
        return f"{path.name}: {how}"
    return f"{own.name}: {how}"


def added(folder, rng):
    """What was never recorded."""
    own = pick(rng, sorted((folder / "data" / "human").iterdir()))
    name = pick(rng, (
        "study-made_subject-{}_session-1_notes_data.csv",
        "study-made_subject-{}_session-2_questionnaire_data.csv",
        "study-made_subject-{}_session-2_trials_data.csv",
        "traces/session-1_trial-900_events.csv",
        "more_trials_data.csv",
        "more.csv",
    )).format(own.name)  # fmt: skip
    (own / name).write_text("row_id,time\nx,1\n", "utf-8")
    return f"{own.name}: {name}"


def ledger(folder, rng):
    """A ledger that cannot be read, or that knows of somebody else."""
    path = folder / "ledger.sqlite"
    whole = path.read_bytes()
    how = pick(rng, ("text", "cut", "head", "empty", "url", "folder", "schema"))
    if how == "url":
        (folder / "ledger.url").write_text(pick(rng, ("", "mysql://x", "\0", "a\nb", "\xff")))
    elif how == "folder":
        path.unlink()
        path.mkdir()
    else:
        broken = {"text": b"P01,1,complete\n", "cut": whole[: len(whole) // 2], "empty": b"",
                  "head": b"SQLite format 4\0" + whole[16:],
                  "schema": whole.replace(b"seethrough_entr", b"seethrough_antr")}  # fmt: skip
        path.write_bytes(broken[how])
    return how


def json_files(folder, rng):
    """Sidecars and end files that are no longer what they were, each in its own way."""
    path = pick(rng, recorded(folder, "*.json"))
    text = path.read_text("utf-8")
    how = pick(rng, ("twice", "utf-16", "bom", "cut", "nul", "deep", "list", "number", "moved"))
    broken = {
        "twice": '{"participant": "P02", "status": "left", "participant": "P01", ' + text[1:],
        "cut": text[: int(rng.integers(1, len(text) - 1))],
        "nul": text.replace(" ", "\0", 1),
        "deep": "[" * 100_000,
        "list": f"[{text}]",
        "number": "1" * 5000,
        "moved": json.dumps({key: {} for key in json.loads(text)}),
    }
    code = {"utf-16": "utf-16", "bom": "utf-8-sig"}.get(how, "utf-8")
    path.write_bytes(broken.get(how, text).encode(code))
    return f"{path.name}: {how}"


RECORDS = {
    "saved again": saved_again,
    "changed": changed,
    "removed": removed,
    "replaced": replaced,
    "stripped": stripped,
    "renamed": renamed,
    "added": added,
    "ledger": ledger,
    "JSON": json_files,
}
