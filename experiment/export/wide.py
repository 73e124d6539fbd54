"""One row for each participant, one column for each measure of each trial: for SPSS, JASP, R."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
from seethrough.experiment.record.columns import measures_among

MEASURES = ("time", "time_clean", "timed_out", "correct", "count_error", "distance")
NUMBERS = {"true": "1", "false": "0"}


def wide(data: Dataset, out: Path) -> None:
    """wide.csv, and wide.json that says what each column is."""
    tables = ("trials", "questionnaire")
    said = {c.name: c.description for table in tables for c in data.columns(table)}
    meaning = {"participant": said["participant"], "slot": said["slot"]}
    naming, grouping = _naming(data), _grouping(data)
    meaning |= {factor: said[factor] for factor in grouping}
    rows: dict[str, dict[str, str]] = {p: {"participant": p} for p in data.participants}
    own = [c.name for c in measures_among(data.columns("trials"))]
    for trial in latest_attempts(data.tables["trials"]):
        rows[trial["participant"]]["slot"] = trial["slot"]
        for factor in grouping:
            rows[trial["participant"]][factor] = trial[factor]
        for measure in (*MEASURES, *own):
            if trial[measure] != "":
                levels = [trial[factor] for factor in naming]
                name = "_".join([measure, *levels, trial["task"], trial["trial_in_set"]])
                rows[trial["participant"]][name] = _number(trial[measure])
                where = ", ".join(trial[factor] for factor in data.factors)
                meaning[name] = f"{said[measure]}; {where}" if where else said[measure]
    places = in_sets(data)
    for answer in data.tables["questionnaire"]:
        name = item_name(answer, data.factors, places)
        if answer["participant"] in rows:
            rows[answer["participant"]][name] = answer["value"] or harmless(answer["text"])
            meaning[name] = said["item"]
    first = ["participant", "slot", *grouping]
    columns = [*first, *sorted(set(meaning) - set(first))]
    put(out / "wide.csv", as_csv(columns, [rows[p] for p in data.participants]))
    put(out / "wide.json", as_json(_codebook(meaning)))


def _naming(data: Dataset) -> list[str]:
    """The factors that name a column: not those that the task alone tells, nor what is one level
    for each person."""
    trials = data.tables["trials"]
    named = []
    for factor in data.factors:
        of_task, of_person = _groups(trials, "task", factor), _groups(trials, "participant", factor)
        if any(len(levels) > 1 for levels in of_task.values()) and any(
            len(levels) > 1 for levels in of_person.values()
        ):
            named.append(factor)
    return named


def _grouping(data: Dataset) -> list[str]:
    """The factors of which each person has one level, and people differ."""
    trials = data.tables["trials"]
    return [
        factor
        for factor in data.factors
        if len({row[factor] for row in trials}) > 1
        and all(len(v) == 1 for v in _groups(trials, "participant", factor).values())
    ]


def _groups(rows: Sequence[Row], by: str, factor: str) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for row in rows:
        found.setdefault(row[by], set()).add(row[factor])
    return found


Place = tuple[str, str]  # participant, trial


def in_sets(data: Dataset) -> dict[Place, str]:
    """The position of each participant's trials in their task sets."""
    return {(t["participant"], t["trial"]): t["trial_in_set"] for t in data.tables["trials"]}


def item_name(answer: Row, factors: Sequence[str], in_set: Mapping[Place, str]) -> str:
    """A column for an item of the questionnaire: in its condition where it has one, after its trial
    where it was asked after one."""
    trial = answer.get("after_trial", "")
    where = (answer.get("after_task", ""), in_set.get((answer["participant"], trial), ""))
    parts = (answer["item"], *(answer.get(factor, "") for factor in factors), *where)
    return "_".join(part for part in parts if part)


def _number(text: str) -> str:
    """Booleans are 1 and 0 here, as programs for statistics like them."""
    return NUMBERS.get(text, text)


def _codebook(meaning: Mapping[str, str]) -> dict[str, str]:
    rules = "booleans are 1 and 0; of a repeated trial, the last attempt; " + HARMLESS
    return {**meaning, "*": rules}
