"""A data folder as one checked value: tables, sidecars, and a record of every file read."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.errors import DataError
from analysis.load import schema
from analysis.load.chain import ChainState, verify_all
from analysis.load.table import Source, read_table

REPAIR = "_repair.json"
CERTIFICATE = "certificate.csv"
"""The difficulty certificate, where the study has one, beside dataset_description.json."""


@dataclass(frozen=True, slots=True)
class FileRead:
    """What was read, for the report's table of files."""

    name: str
    sha256: str
    rows: int


@dataclass(frozen=True, slots=True)
class Study:
    """A loaded study of one source. `sidecars` maps a table's file name to its sidecar."""

    folder: Path
    name: str
    description: str
    source: str
    trials: pd.DataFrame
    questionnaire: pd.DataFrame
    sidecars: Mapping[str, Mapping[str, Any]]
    files: tuple[FileRead, ...]
    chains: tuple[ChainState, ...] = ()
    other_sources: tuple[str, ...] = ()
    certificate: pd.DataFrame | None = None
    repairs: tuple[str, ...] = ()


def load_study(folder: Path, source: str | None = None) -> Study:
    """Read and check the data folder; `source` chooses among several ("human", …).

    Raises DataError with one line for each problem.
    """
    about = _description(folder)
    chosen, others = _source(folder, source)
    base = folder / "data" / chosen
    paths = sorted(base.glob("*/*_trials_data.csv"))
    if not paths:
        raise DataError(f"{base}: no trial tables (*_trials_data.csv): expected one a participant")
    asked = sorted(base.glob("*/*_questionnaire_data.csv"))
    sources = [_source_file(path, folder) for path in paths]
    answers = [_source_file(path, folder) for path in asked]
    trials = read_table(sources, schema.TRIALS)
    check_trials(trials, chosen)
    empty = {name: pd.Series(dtype="object") for name in (*schema.QUESTIONNAIRE, "_file", "_row")}
    questions = read_table(answers, schema.QUESTIONNAIRE) if answers else pd.DataFrame(empty)
    if answers:
        _check_ids(questions)
        _check_source(questions, chosen)
    _same_people(trials, questions)
    files = [*_records(sources, trials), *_records(answers, questions)]
    certificate = None
    if (folder / CERTIFICATE).is_file():
        hardness = _source_file(folder / CERTIFICATE, folder)
        certificate = read_table([hardness], schema.CERTIFICATE)
        _check_levels(certificate, ("task", "transparency"))
        files += _records([hardness], certificate)
    sidecars = _sidecars(paths, folder)
    chains = verify_all(sources, sidecars, folder)
    return Study(
        folder,
        str(about.get("name", folder.name)),
        str(about.get("description", "")),
        chosen,
        trials,
        questions,
        sidecars,
        tuple(files),
        tuple(chains),
        others,
        certificate,
        _repairs(base, folder),
    )


def _repairs(base: Path, folder: Path) -> tuple[str, ...]:
    """A line for each participant who was played twice at once: what counts, what was set aside."""
    lines = []
    for path in sorted(base.glob(f"*/*{REPAIR}")):
        mark = _json(path, folder)
        try:
            counts = ", ".join(f"session {c['session']} ({c['trials']} trials)"
                               for c in mark["counts"])  # fmt: skip
            out = ", ".join(str(number) for number in mark["left_out"]) or "the rest of it"
            lines.append(
                f"{path.parent.name} was played twice at once: {counts} counts, session {out} does "
                f"not; all of it is kept in {mark['as_it_was']} (repaired {mark['repaired']})"
            )
        except (KeyError, TypeError):
            name = path.relative_to(folder).as_posix()
            raise DataError(f"{name}: expected what `seethrough repair` writes") from None
    return tuple(lines)


def _same_people(*tables: pd.DataFrame) -> None:
    """Give every table all participants as categories, so that nobody is missing unnoticed."""
    names = sorted({str(name) for table in tables for name in pd.unique(table["participant"])})
    for table in tables:
        table["participant"] = pd.Categorical(table["participant"].astype("str"), categories=names)


def _description(folder: Path) -> dict[str, Any]:
    """The dataset's description; its presence is what makes a folder a dataset."""
    if not folder.is_dir():
        raise DataError(f"{folder}: no such folder")
    path = folder / "dataset_description.json"
    if not path.is_file():
        what = "an empty folder" if not any(folder.iterdir()) else "no dataset"
        raise DataError(f"{folder}: {what}: expected dataset_description.json in it")
    return _json(path, folder)


def _json(path: Path, folder: Path) -> dict[str, Any]:
    name = path.relative_to(folder)
    try:
        value = json.loads(path.read_bytes())
    except (ValueError, RecursionError) as error:
        raise DataError(f"{name}: not JSON ({error})") from None
    if not isinstance(value, dict):
        raise DataError(f"{name}: expected a JSON object")
    return value


def _source(folder: Path, wanted: str | None) -> tuple[str, tuple[str, ...]]:
    """Which of data/human, data/simulated, data/pilot to read; they are never mixed."""
    there = [s for s in schema.SOURCES if any((folder / "data" / s).glob("*/*_data.csv"))]
    if wanted is not None and wanted not in there:
        have = ", ".join(there) or "none"
        raise DataError(f"{folder}: source = {wanted}: expected one that has data ({have})")
    if not there:
        raise DataError(f"{folder}: no participants yet: expected data/SOURCE/PARTICIPANT/*.csv")
    if wanted is None and len(there) > 1:
        have = ", ".join(there)
        raise DataError(f"{folder}: source = {have}: sources are never mixed: choose with --source")
    chosen = wanted or there[0]
    return chosen, tuple(s for s in there if s != chosen)


def _source_file(path: Path, folder: Path) -> Source:
    return Source(path.relative_to(folder).as_posix(), path.read_bytes())


def _records(sources: Iterable[Source], table: pd.DataFrame) -> list[FileRead]:
    counts = table["_file"].value_counts().to_dict() if len(table) else {}
    return [
        FileRead(s.name, hashlib.sha256(s.data).hexdigest(), int(counts.get(s.name, 0)))
        for s in sources
    ]


def _sidecars(paths: Iterable[Path], folder: Path) -> dict[str, Mapping[str, Any]]:
    """The trial tables' sidecars; a table without one is possible and shows in the report."""
    found: dict[str, Mapping[str, Any]] = {}
    for path in paths:
        sidecar = path.with_suffix(".json")
        if sidecar.is_file():
            found[path.relative_to(folder).as_posix()] = _json(sidecar, folder)
    return found


def at(table: pd.DataFrame, index: Any) -> str:
    """`file: row N` of a table's row."""
    return f"{table.at[index, '_file']}: row {table.at[index, '_row']}"


def check_trials(trials: pd.DataFrame, source: str) -> None:
    """Levels, required values, bounds and unique rows; raises DataError naming each."""
    lines = _level_problems(trials, tuple(schema.LEVELS))
    for name in schema.REQUIRED:
        empty = trials[name].isna()
        if not pd.api.types.is_numeric_dtype(trials[name]):
            empty |= trials[name] == ""
        gaps = trials.index[empty]
        lines += [f"{at(trials, i)}: {name} = '': expected a value" for i in gaps]
    for name, (what, bound, closed) in schema.BOUNDS.items():
        low = trials[name] < bound if closed else trials[name] <= bound
        lines += [
            f"{at(trials, i)}: {name} = {trials.at[i, name]:g}: expected {what}"
            for i in trials.index[low]
        ]
    if lines:
        raise DataError(lines)
    _check_ids(trials)
    _check_source(trials, source)


def _level_problems(table: pd.DataFrame, names: Iterable[str]) -> list[str]:
    return [
        f"{at(table, i)}: {name} = {table.at[i, name]!r}: expected {', '.join(schema.LEVELS[name])}"
        for name in names
        for i in table.index[~table[name].isin(schema.LEVELS[name])]
    ]


def _check_levels(table: pd.DataFrame, names: Iterable[str]) -> None:
    if lines := _level_problems(table, names):
        raise DataError(lines)


def _check_source(table: pd.DataFrame, source: str) -> None:
    """The column must agree with the folder that the file lies in."""
    wrong = table.index[table["source"] != source]
    if len(wrong):
        raise DataError(
            f"{at(table, i)}: source = {table.at[i, 'source']!r}: "
            f"expected {source}, the folder's (sources are never mixed)"
            for i in wrong
        )


def _check_ids(table: pd.DataFrame) -> None:
    """Row ids are unique in the study; participants' ids are plain."""
    lines = []
    again = table.index[table["row_id"].duplicated()]
    first = table.drop_duplicates("row_id").set_index("row_id") if len(again) else table
    for i in again:
        row_id = table.at[i, "row_id"]
        lines.append(
            f"{at(table, i)}: row_id = {row_id!r}: expected a unique one, but "
            f"{first.at[row_id, '_file']}: row {first.at[row_id, '_row']} has it too"
        )
    for name in pd.unique(table["participant"]):
        if not re.fullmatch(schema.ID_PATTERN, str(name)):
            i = table.index[table["participant"] == name][0]
            lines.append(f"{at(table, i)}: participant = {name!r}: expected {schema.ID_PATTERN}")
    if lines:
        raise DataError(lines)
