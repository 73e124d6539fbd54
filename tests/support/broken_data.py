"""Makes malformed data folders: case number → the same folder on every machine.

Each case begins with a valid folder and breaks one thing that the reader has to refuse.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from broken_records import RECORDS
from made_chains import chain, enter
from made_data import ANSWER_COLUMNS, TRIAL_COLUMNS, Made, make_folder

WRONG = {
    "session": ("x", "1.5", "inf", "nan", "1,5", "١٢x"),
    "slot": ("", "1.5", "x", "1e400"),
    "trial": ("", "-", "1.5", "first"),
    "transparency": ("", "Standard", "dynamic ", "glass", "\x1b[2J"),
    "scenario": ("", "abstract2", "ABSTRACT", "\u2028"),
    "task": ("", "counting", "T1", "\0"),
    "source": ("", "simulated", "pilot", "Human"),
    "participant": ("", "../P01", "a b", "x" * 33, "é", "P01\x1b[2J"),
    "correct": ("True", "1", "yes", "TRUE"),
    "timed_out": ("", "0", "False", "no"),
    "time": ("", "0", "-1", "nan", "inf", "1e400", "fast", "1:20"),
    "time_clean": ("", "-0.5", "-inf", "x"),
    "distance": ("-1", "far", "nan"),
    "attempt": ("", "0", "-1", "1.5"),
    "row_id": ("",),
    "frames": ("1.5", "many"),
}


@dataclass(frozen=True)
class Case:
    """What was broken."""

    kind: str
    what: str


def valid(folder: Path) -> Path:
    """The folder that cases begin with: two participants, one trial a cell."""
    return make_folder(folder, Made(participants=2, trials=1))


def break_one(folder: Path, number: int) -> Case:
    """Break the folder (made by `valid`) in the way of this number."""
    rng = np.random.default_rng(np.random.SeedSequence(20261123, spawn_key=(number,)))
    kinds = list(KINDS)
    kind = kinds[number % len(kinds)]
    if kind in RECORDS:
        chain(folder)
        enter(folder)
    return Case(kind, KINDS[kind](folder, rng))


def _pick(rng, options):
    return options[int(rng.integers(len(options)))]


def _table(folder, rng, name="trials"):
    return _pick(rng, sorted(folder.rglob(f"*_{name}_data.csv")))


def _change(path, change):
    lines = path.read_text("utf-8").split("\n")
    change(lines)
    path.write_bytes("\n".join(lines).encode("utf-8"))


def _value(folder, rng):
    path, column = _table(folder, rng), _pick(rng, sorted(WRONG))
    value, at = _pick(rng, WRONG[column]), TRIAL_COLUMNS.index(column)

    def change(lines):
        number = int(rng.integers(1, len(lines) - 1))
        cells = lines[number].split(",")
        cells[at] = f'"{value}"' if "," in value else value
        lines[number] = ",".join(cells)

    _change(path, change)
    return f"{column} = {value!r}"


def _answer(folder, rng):
    path, at = _table(folder, rng, "questionnaire"), ANSWER_COLUMNS.index("value")
    value = _pick(rng, ("x", "nan", "inf", "4 of 4", "1,5", "--1"))

    def change(lines):
        cells = lines[1].split(",")
        cells[at] = f'"{value}"' if "," in value else value
        lines[1] = ",".join(cells)

    _change(path, change)
    return f"value = {value!r}"


def _header(folder, rng):
    path = _table(folder, rng)
    how = _pick(rng, ("missing", "twice", "renamed", "empty", "none", "tabs"))
    column = _pick(rng, [c for c in TRIAL_COLUMNS if c in WRONG])

    def change(lines):
        names = lines[0].split(",")
        at = names.index(column)
        if how == "missing":
            del names[at]
        elif how == "twice":
            names[at - 1 if at else 1] = column
        elif how == "renamed":
            names[at] = _pick(rng, (column.upper(), column + " ", "\x1b[2J", "x"))
        elif how == "empty":
            names = [""]
        lines[0] = ("\t" if how == "tabs" else ",").join(names)
        if how == "none":
            del lines[0]

    _change(path, change)
    return f"header: {how} {column}"


def _shape(folder, rng):
    path = _table(folder, rng)
    how = _pick(rng, ("short", "long", "half", "blank", "quote", "joined"))

    def change(lines):
        number = int(rng.integers(1, len(lines) - 1))
        line = lines[number]
        if how == "short":
            lines[number] = line.rpartition(",")[0]
        elif how == "long":
            lines[number] = line + ",x"
        elif how == "half":
            lines[-2:] = [line[: len(line) // 2]]
        elif how == "blank":
            lines.insert(number, "")
        elif how == "quote":
            lines[number] = '"' + line
        else:
            lines[number] = line + line

    _change(path, change)
    return f"row: {how}"


def _twice(folder, rng):
    """The same row again, in the same table or in another one's."""
    paths = sorted(folder.rglob("*_trials_data.csv"))
    line = paths[0].read_text("utf-8").split("\n")[int(rng.integers(1, 5))]
    path = _pick(rng, paths)
    _change(path, lambda lines: lines.insert(2, line))
    return "row_id twice"


def _bytes(folder, rng):
    path = _table(folder, rng, _pick(rng, ("trials", "questionnaire")))
    data, wrong = path.read_bytes(), _pick(rng, (b"\xff", b"\xc3(", b"\xed\xa0\x80", b"\x80"))
    at = int(rng.integers(len(data)))
    path.write_bytes(data[:at] + wrong + data[at:])
    return f"not UTF-8: {wrong!r}"


def _json(folder, rng):
    path = _pick(rng, [folder / "dataset_description.json", *sorted(folder.rglob("*_data.json"))])
    text = path.read_text("utf-8")
    wrong = _pick(
        rng,
        [
            "", "{", "[]", "null", "3", '"x"', text[: len(text) // 2], text + "}", "{'a': 1}",
            "[" * 100_000, "\x1b[2J", '{"a": 1,}', "\0",
        ],
    )  # fmt: skip
    path.write_bytes(_pick(rng, (wrong.encode(), b"\xff" + text.encode())))
    return f"{path.name}: {wrong[:20]!r}"


def _gone(folder, rng):
    how = _pick(rng, ("description", "data", "tables", "folder", "emptied", "directory", "file"))
    if how == "description":
        (folder / "dataset_description.json").unlink()
    elif how == "data":
        shutil.rmtree(folder / "data")
    elif how == "tables":
        for path in folder.rglob("*_trials_data.csv"):
            path.unlink()
    elif how == "folder":
        shutil.rmtree(folder)
    elif how == "emptied":
        _table(folder, rng).write_bytes(b"")
    elif how == "directory":
        path = _table(folder, rng)
        path.unlink()
        path.mkdir()
    else:
        shutil.rmtree(folder)
        folder.write_text("a file")
    return f"gone: {how}"


KINDS: dict[str, Callable[[Path, np.random.Generator], str]] = {
    "value": _value,
    "answer": _answer,
    "header": _header,
    "shape": _shape,
    "twice": _twice,
    "bytes": _bytes,
    "json": _json,
    "gone": _gone,
    **RECORDS,
}
