"""One row for each participant, one column for each measure of each trial: for SPSS, JASP, R."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from seethrough.experiment.export.dataset import (
    HARMLESS,
    Dataset,
    Row,
    as_csv,
    as_json,
    harmless,
    latest_attempts,
    put,
)
from seethrough.experiment.record.columns import QUESTIONNAIRE, TRIALS

MEASURES = ("time", "time_clean", "timed_out", "correct", "count_error", "distance")
NUMBERS = {"true": "1", "false": "0"}


def wide(data: Dataset, out: Path) -> None:
    """wide.csv, and wide.json that says what each column is."""
    said = {c.name: c.description for c in (*TRIALS, *QUESTIONNAIRE)}
    meaning = {"participant": said["participant"], "slot": said["slot"]}
    rows: dict[str, dict[str, str]] = {p: {"participant": p} for p in data.participants}
    for trial in latest_attempts(data.tables["trials"]):
        rows[trial["participant"]]["slot"] = trial["slot"]
        for measure in MEASURES:
            if trial[measure] != "":
                name = f"{measure}_{trial['transparency']}_{trial['task']}_{trial['trial_in_set']}"
                rows[trial["participant"]][name] = _number(trial[measure])
                meaning[name] = f"{said[measure]}; {trial['transparency']}, {trial['scenario']}"
    for answer in data.tables["questionnaire"]:
        name = item_name(answer)
        if answer["participant"] in rows:
            rows[answer["participant"]][name] = answer["value"] or harmless(answer["text"])
            meaning[name] = said["item"]
    first = ["participant", "slot"]
    columns = [*first, *sorted(set(meaning) - set(first))]
    put(out / "wide.csv", as_csv(columns, [rows[p] for p in data.participants]))
    put(out / "wide.json", as_json(_codebook(meaning)))


def item_name(answer: Row) -> str:
    """A column for an item of the questionnaire, in its condition where it has one."""
    parts = (answer["item"], answer["transparency"], answer["scenario"])
    return "_".join(part for part in parts if part)


def _number(text: str) -> str:
    """Booleans are 1 and 0 here, as programs for statistics like them."""
    return NUMBERS.get(text, text)


def _codebook(meaning: Mapping[str, str]) -> dict[str, str]:
    rules = "booleans are 1 and 0; of a repeated trial, the last attempt; " + HARMLESS
    return {**meaning, "*": rules}
