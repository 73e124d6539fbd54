"""The columns that the analysis reads, and their types and levels.

This is the reader's own half of the interface; a contract test holds it to what the recorder
declares. Further columns are allowed and ignored.
"""

from __future__ import annotations

TRANSPARENCY = ("standard", "dynamic")
SCENARIO = ("abstract", "walkthrough")
TASKS = ("count", "pattern", "unique", "count_in_building")
SOURCES = ("human", "simulated", "pilot")
ID_PATTERN = r"[A-Za-z0-9_-]{1,32}"

TASK_CODES = {"count": "T1", "pattern": "T2", "unique": "T3", "count_in_building": "T4"}

TRIALS = {
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
    "transparency": "text",
    "scenario": "text",
    "task": "text",
    "scene": "text",
    "targets": "integer",
    "answer": "text",
    "truth": "text",
    "correct": "boolean",
    "count_error": "integer",
    "distance": "number",
    "time": "number",
    "time_clean": "number",
    "timed_out": "boolean",
    "frames": "integer",
    "frames_missed": "integer",
    "path_length": "number",
    "turned": "number",
}
"""Columns of `…_trials_data.csv` and their types."""

QUESTIONNAIRE = {
    "row_id": "text",
    "participant": "text",
    "session": "integer",
    "source": "text",
    "item": "text",
    "transparency": "text",
    "scenario": "text",
    "value": "number",
    "text": "text",
}
"""Columns of `…_questionnaire_data.csv` and their types."""

CERTIFICATE = {
    "scene": "text",
    "task": "text",
    "transparency": "text",
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
    "transparency",
    "scenario",
    "task",
    "time",
    "time_clean",
    "timed_out",
)
"""Columns of the trials table that may not be empty."""

LEVELS = {
    "transparency": TRANSPARENCY,
    "scenario": SCENARIO,
    "task": TASKS,
    "source": SOURCES,
}

BOUNDS = {
    "time": ("a positive time in seconds", 0.0, False),
    "time_clean": ("a time in seconds, 0 or more", 0.0, True),
    "distance": ("a distance, 0 or more", 0.0, True),
    "attempt": ("1 or more", 1.0, True),
}
"""column → (what was expected, lower bound, whether the bound itself is allowed)."""
