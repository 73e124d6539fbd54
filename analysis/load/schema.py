"""The columns that the analysis reads, and their types; those of factors and measures come from the
design.

This is the reader's own half of the interface; a contract test holds it to what the recorder
declares. Further columns are allowed and ignored.
"""

from __future__ import annotations

from collections.abc import Mapping

from seethrough.analysis.design import Design

SOURCES = ("human", "simulated", "pilot")
ID_PATTERN = r"[A-Za-z0-9_-]{1,32}"

FIXED = {
    "row_id": "text",
    "study": "text",
    "participant": "text",
    "session": "integer",
    "source": "text",
    "slot": "integer",
    "trial": "integer",
    "block": "integer",
    "task_set": "integer",
    "trial_in_set": "integer",
    "attempt": "integer",
    "task": "text",
    "scene": "text",
    "targets": "integer",
    "answer": "text",
    "truth": "text",
    "correct": "boolean",
    "time": "number",
    "time_clean": "number",
    "timed_out": "boolean",
    "frames": "integer",
    "frames_missed": "integer",
    "path_length": "number",
    "turned": "number",
}
"""Columns of every `…_trials_data.csv` and their types."""

ASKED = {
    "row_id": "text",
    "participant": "text",
    "session": "integer",
    "source": "text",
    "item": "text",
    "value": "number",
    "text": "text",
}
"""Columns of every `…_questionnaire_data.csv` and their types."""

CERTIFICATE = {
    "scene": "text",
    "task": "text",
    "targets": "number",
    "visible": "number",
    "hidden": "number",
    "occluders": "number",
    "clutter": "number",
    "path": "number",
}
"""Columns of the difficulty certificate that `seethrough check --certificate` writes."""

REQUIRED = (
    "row_id",
    "participant",
    "session",
    "source",
    "slot",
    "trial",
    "block",
    "attempt",
    "task",
    "time",
    "time_clean",
    "timed_out",
)
"""Columns of the trials table that may not be empty."""

BOUNDS = {
    "time": ("a positive time in seconds", 0.0, False),
    "time_clean": ("a time in seconds, 0 or more", 0.0, True),
    "attempt": ("1 or more", 1.0, True),
}
"""column → (what was expected, lower bound, whether the bound itself is allowed)."""

TYPES = {"binary": "boolean", "count": "integer", "ordinal": "integer"}
"""A measure's scale → its column's type; a number elsewhere."""


def trial_columns(design: Design) -> dict[str, str]:
    """The columns of a study's trial tables: the fixed ones, its factors', its measures'."""
    factors = {f.name: "text" for f in design.factors}
    measures = {m.column: TYPES.get(m.scale, "number") for t in design.tasks for m in t.measures}
    return {**FIXED, **factors, **{k: v for k, v in measures.items() if k not in FIXED}}


def answer_columns(design: Design) -> dict[str, str]:
    """The columns of its questionnaires."""
    return {**ASKED, **{f.name: "text" for f in design.factors if f.within}}


def certificate_columns(design: Design) -> dict[str, str]:
    """The columns of its difficulty certificate."""
    alone = {f.name: "text" for f in design.crossed if f.scenes == "alone"}
    where = {name: CERTIFICATE[name] for name in ("scene", "task")}
    return {**where, **alone, **CERTIFICATE}


def levels(design: Design) -> Mapping[str, tuple[str, ...]]:
    """What a column of levels may hold."""
    return {**design.levels, "task": design.task_names, "source": SOURCES}


def bounds(design: Design) -> dict[str, tuple[str, float, bool]]:
    """column → (what was expected, lower bound, whether the bound itself is allowed)."""
    ratio = {
        m.column: (f"a {m.said}, 0 or more", 0.0, True)
        for t in design.tasks
        for m in t.measures
        if m.scale == "ratio" and not m.log and m.column not in BOUNDS
    }
    return {**BOUNDS, **ratio}
