"""Every column of every table the recorder writes: the data dictionary is made from this file.

Every study has the columns of TABLES; its factors are columns besides, in the order of its file,
after the column that FACTORS_AFTER says.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any


@dataclass(frozen=True)
class Column:
    """A column: its type ("text", "integer", "number" or "boolean"), unit, meaning and levels.

    In the file, booleans are `true` and `false`, and what does not apply is empty. Columns that
    came later say with which version of the tables they were `added`; tables of an earlier one lack
    them all, and are read with empty cells.
    """

    name: str
    type: str
    description: str
    unit: str = ""
    levels: tuple[str, ...] = ()
    added: int = 0


_WHO = (
    Column("row_id", "text", "unique in the whole study: participant, session and row"),
    Column("study", "text", "name of the study, from its config"),
    Column("participant", "text", "participant's id; no names"),
    Column("session", "integer", "1 for the participant's first session"),
    Column("source", "text", "who answered", levels=("human", "simulated", "pilot")),
)

_TRIAL = Column("trial", "integer", "position of the trial in the session, from 1")
_TEXT = Column("text", "text", "free text: an answer, or the experimenter's note")

TRIALS = (
    *_WHO,
    Column("slot", "integer", "row of the counterbalanced design, from 1"),
    _TRIAL,
    Column("block", "integer", "position of the condition in the session, from 1"),
    Column("task_set", "integer", "position of the task set in the session, from 1"),
    Column("trial_in_set", "integer", "position of the trial in its task set, from 1"),
    Column("attempt", "integer", "1, and one more each time the trial was repeated"),
    Column("world", "text", "the world that the task was done in", added=2),
    Column("task", "text", "what was to be done: a task's name, as T1 count"),
    Column("scene", "text", "which scene: a name of the study's set, or the stream it came from"),
    Column("targets", "integer", "number of targets in the scene"),
    Column(
        "answer", "text", "the participant's answer, as given; unknown: left by \"I don't know\""
    ),
    Column("truth", "text", "the right answer"),
    Column(
        "correct",
        "boolean",
        "whether the answer is right: T1, T4 the number exactly, T2 the letter, T3 the mark in the "
        "same room as the thing, however far off it is there",
    ),
    Column("count_error", "integer", "answer − truth, for the counting tasks", "objects"),
    Column("distance", "number", "from the mark to the target's place, for T3", "world units"),
    Column("time", "number", "first frame shown to the answer's confirmation", "s"),
    Column(
        "time_within",
        "number",
        "how much longer than `time` it may have been: the first frame's flip and the last event "
        "are known no better",
        "s",
        added=1,
    ),
    Column("time_clean", "number", "time, less what passed while the window had no focus", "s"),
    Column("timed_out", "boolean", "whether the trial ended at its time limit"),
    Column(
        "early",
        "integer",
        "keys and buttons pressed before a frame could answer them: not taken",
        added=1,
    ),
    Column("frames", "integer", "frames shown", "frames"),
    Column(
        "frames_missed",
        "integer",
        "frames that took over 1.5 periods of the display, as measured",
        "frames",
    ),
    Column("worst_frame", "number", "longest time between two frames", "s"),
    Column("path_length", "number", "how far the viewer moved", "world units"),
    Column("turned", "number", "how far the view direction turned", "rad"),
    Column("started", "text", "when the first frame was shown, UTC, ISO 8601"),
    Column("events_file", "text", "the trial's input events, beside this table"),
    Column("camera_file", "text", "the trial's camera path, beside this table"),
    Column("events_sha256", "text", "hash of the events file"),
    Column("camera_sha256", "text", "hash of the camera file"),
    Column("chain", "text", "hash of the row before and this row: nothing was changed since"),
)

QUESTIONNAIRE = (
    *_WHO,
    Column(
        "item",
        "text",
        "efficiency, ease, enjoy (0–4, for each of some levels), preference (of two levels 1 the "
        "second, 0 not; text: the level or neutral), "
        "depth_self_report (0–4), depth_pair_1 … 3 (1: right), depth_test (right of 3), consent, "
        "age (years), gender, "
        "color_plate_1 … 4 (1: read), tlx_… (0–20), sus_1 … sus_10 (0–4), sus (0–100), remarks",
    ),
    Column(
        "after_trial",
        "integer",
        "the trial that it was asked after, if it was: of a task set, its last",
        added=3,
    ),
    Column("after_task", "text", "the task of that trial", added=3),
    Column("value", "number", "the answer as a number"),
    _TEXT,
)  # fmt: skip

NOTES = (
    *_WHO,
    _TRIAL,
    Column("written", "text", "when, UTC, ISO 8601"),
    _TEXT,
)

TABLES = {"trials": TRIALS, "questionnaire": QUESTIONNAIRE, "notes": NOTES}
FACTORS_AFTER = {"trials": "attempt", "questionnaire": "item", "notes": ""}
MEASURES_AFTER = "distance"  # of the trial table: what tasks measure besides what ours do
RESERVED = tuple(dict.fromkeys(column.name for table in TABLES.values() for column in table))


def factor_column(name: str, levels: Sequence[str] = ()) -> Column:
    """The column of a factor."""
    return Column(name, "text", "factor of the study", levels=tuple(levels))


def measure_columns(tasks: Iterable[Mapping[str, Any]]) -> tuple[Column, ...]:
    """The columns of what tasks measure, as a sidecar describes them, where no table has them."""
    measures = {m["name"]: m for task in tasks for m in task["measures"]}
    return tuple(
        Column(name, "number", m["label"] or f"measure {name}", m["unit"])
        for name, m in measures.items()
        if name not in RESERVED
    )


def with_factors(
    factors: Iterable[Mapping[str, Any]], tasks: Iterable[Mapping[str, Any]] = ()
) -> dict[str, tuple[Column, ...]]:
    """Every table's columns in a study with these factors and tasks, as a sidecar describes them.

    Answers on a page say the levels that they are about: those that everybody meets.
    """
    measures = measure_columns(tasks)
    own = [(f["kind"], factor_column(f["name"], f["levels"])) for f in factors]
    everybodys = tuple(column for kind, column in own if kind == "within")
    every = tuple(column for _, column in own)
    found = {t: _inserted(t, every if t == "trials" else everybodys) for t in TABLES}
    return {**found, "trials": _after(found["trials"], MEASURES_AFTER, measures)}


def _inserted(table: str, factors: tuple[Column, ...]) -> tuple[Column, ...]:
    return _after(TABLES[table], FACTORS_AFTER[table], factors)


def _after(columns: tuple[Column, ...], name: str, more: tuple[Column, ...]) -> tuple[Column, ...]:
    at = next((i for i, c in enumerate(columns, start=1) if c.name == name), None)
    return columns if at is None else (*columns[:at], *more, *columns[at:])


def columns_in(table: str, header: Sequence[str]) -> tuple[Column, ...]:
    """The columns of a file of a table by its header: those that stand where factors do are its
    study's factors, those that stand where measures do its tasks'."""
    found = _inserted(table, tuple(map(factor_column, _own(table, header, FACTORS_AFTER[table]))))
    measures = _own(table, header, MEASURES_AFTER)
    return _after(
        found, MEASURES_AFTER, tuple(Column(n, "number", f"measure {n}") for n in measures)
    )


def measures_among(columns: Sequence[Column]) -> list[Column]:
    """Those of a trial table's columns that are measures of tasks besides what ours measure."""
    own = set(_own("trials", [column.name for column in columns], MEASURES_AFTER))
    return [column for column in columns if column.name in own]


def factors_in(header: Sequence[str]) -> tuple[str, ...]:
    """The factors among the names of a trial table's columns."""
    return tuple(_own("trials", header, FACTORS_AFTER["trials"]))


def _own(table: str, header: Sequence[str], after: str) -> list[str]:
    """Names in a header that follow a column of a table and are none of its columns."""
    known = {column.name for column in TABLES[table]}
    rest = header[list(header).index(after) + 1 :] if after in header else []
    return list(takewhile(lambda name: name not in known, rest))


def versions(columns: Sequence[Column]) -> list[tuple[Column, ...]]:
    """The columns as each version of the tables had them, this one last."""
    last = max(column.added for column in columns)
    return [tuple(c for c in columns if c.added <= version) for version in range(last + 1)]
