"""A data folder as one checked value: tables, sidecars, and a record of every file read."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from seethrough.analysis.before import design_before
from seethrough.analysis.design import NO_DESIGN, Design
from seethrough.analysis.errors import DataError
from seethrough.analysis.load import schema
from seethrough.analysis.load.chain import ChainState
from seethrough.analysis.load.files import Source, is_there, list_in, read_bytes, read_json
from seethrough.analysis.load.ledger import NO_LEDGER, Ledger
from seethrough.analysis.load.person import REPAIR, table_name
from seethrough.analysis.load.sidecar_design import ENTRY, read_design
from seethrough.analysis.load.table import read_table
from seethrough.analysis.load.whole import verified

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
    sidecars: Mapping[str, Mapping[str, object]]
    files: tuple[FileRead, ...]
    chains: tuple[ChainState, ...] = ()
    other_sources: tuple[str, ...] = ()
    certificate: pd.DataFrame | None = None
    ledger: Ledger = NO_LEDGER
    repairs: tuple[str, ...] = ()
    design: Design = NO_DESIGN


def load_study(folder: Path, source: str | None = None) -> Study:
    """Read and check the data folder; `source` chooses among several ("human", …).

    Raises DataError with one line for each problem.
    """
    whole = verified(folder, source)
    sources = [s.table for s in whole.sessions if s.table is not None]
    answers = [s.answers for p in whole.people for s in p.sessions if s.answers is not None]
    if not sources:
        base = folder / "data" / whole.source
        raise DataError(f"{base}: no trial tables (*_trials_data.csv): expected one a participant")
    sidecars = {table_name(s): s.sidecar for s in whole.sessions if s.sidecar is not None}
    design = _design(sidecars)
    trials = read_table(sources, schema.trial_columns(design))
    check_trials(trials, whole.source, design)
    columns = schema.answer_columns(design)
    empty = {name: pd.Series(dtype="object") for name in (*columns, "_file", "_row")}
    if answers and all(_AFTER in _names(source) for source in answers):
        columns = {**columns, _AFTER: "integer"}
    questions = read_table(answers, columns) if answers else pd.DataFrame(empty)
    if answers:
        questions = _last_asked(questions, columns)
        _check_ids(questions)
        _check_source(questions, whole.source)
    _same_people(trials, questions)
    files = [*_records(sources, trials), *_records(answers, questions)]
    certificate = None
    if is_there(folder / CERTIFICATE):
        hardness = Source(CERTIFICATE, read_bytes(folder / CERTIFICATE, folder))
        columns = schema.certificate_columns(design)
        certificate = read_table([hardness], columns)
        _check_levels(certificate, [k for k in columns if k in schema.levels(design)], design)
        files += _records([hardness], certificate)
    return Study(
        folder,
        str(whole.about.get("name", folder.name)),
        str(whole.about.get("description", "")),
        whole.source,
        trials,
        questions,
        sidecars,
        tuple(files),
        tuple(s.chain for s in whole.sessions if s.chain is not None),
        whole.others,
        certificate,
        whole.ledger,
        _repairs(folder / "data" / whole.source, folder),
        design,
    )


def _design(sidecars: Mapping[str, Mapping[str, object]]) -> Design:
    """The one design of all sessions; of data of before, what the adapter knows of them."""
    stated = {name: s[ENTRY] for name, s in sidecars.items() if ENTRY in s}
    if not stated:
        configs = (config_of(sidecar) for sidecar in sidecars.values())
        known = (c for c in configs if isinstance(c.get("analysis"), Mapping))
        return design_before(next(known, {}))
    first, entry = next(iter(stated.items()))
    others = [name for name in sidecars if stated.get(name) != entry]
    if others:
        raise DataError(
            f"{_sidecar(name)}: {ENTRY}: expected the one of {_sidecar(first)}: a study has one"
            for name in others
        )
    return read_design(entry, _sidecar(first))


def _sidecar(table: str) -> str:
    return f"{table.removesuffix('.csv')}.json"


def config_of(sidecar: Mapping[str, object]) -> Mapping[str, object]:
    """The study's resolved config in a sidecar, `provenance.study`; empty if there is none."""
    provenance = sidecar.get("provenance")
    config = provenance.get("study") if isinstance(provenance, Mapping) else None
    return config if isinstance(config, Mapping) else {}


def _repairs(base: Path, folder: Path) -> tuple[str, ...]:
    """A line for each participant who was played twice at once: what counts, what was set aside."""
    lines = []
    for path in sorted(base.glob(f"*/*{REPAIR}")):
        mark = read_json(path, folder)
        try:
            counted = [c for c in list_in(mark, "counts") if isinstance(c, Mapping)]
            counts = ", ".join(f"session {c['session']} ({c['trials']} trials)" for c in counted)
            out = ", ".join(map(str, list_in(mark, "left_out"))) or "the rest of it"
            lines.append(
                f"{path.parent.name} was played twice at once: {counts} counts, session {out} does "
                f"not; all of it is kept in {mark['as_it_was']} (repaired {mark['repaired']})"
            )
        except (KeyError, TypeError):
            name = path.relative_to(folder).as_posix()
            raise DataError(f"{name}: expected what `seethrough repair` writes") from None
    return tuple(lines)


_AFTER = "after_trial"  # tables of before lack it


def _names(source: Source) -> list[str]:
    return source.data.partition(b"\n")[0].decode("utf-8", "replace").rstrip("\r").split(",")


def _last_asked(questions: pd.DataFrame, columns: Mapping[str, str]) -> pd.DataFrame:
    """Of what was asked after a trial that was played again, the answers to the last time."""
    if _AFTER not in questions:
        return questions
    told_by = [name for name in columns if name not in ("row_id", "session", "value", "text")]
    again = questions[_AFTER].notna() & questions.duplicated(told_by, keep="last")
    return questions[~again].reset_index(drop=True) if again.any() else questions


def _same_people(*tables: pd.DataFrame) -> None:
    """Give every table all participants as categories, so that nobody is missing unnoticed."""
    names = sorted({str(name) for table in tables for name in pd.unique(table["participant"])})
    for table in tables:
        table["participant"] = pd.Categorical(table["participant"].astype("str"), categories=names)


def _records(sources: Iterable[Source], table: pd.DataFrame) -> list[FileRead]:
    counts = table["_file"].value_counts().to_dict() if len(table) else {}
    return [
        FileRead(s.name, hashlib.sha256(s.data).hexdigest(), int(counts.get(s.name, 0)))
        for s in sources
    ]


def at(table: pd.DataFrame, index: object) -> str:
    """`file: row N` of a table's row."""
    return f"{table.at[index, '_file']}: row {table.at[index, '_row']}"


def check_trials(trials: pd.DataFrame, source: str, design: Design) -> None:
    """Levels, required values, bounds and unique rows; raises DataError naming each."""
    lines = _level_problems(trials, schema.levels(design))
    lines += _cell_problems(trials, design)
    for name in (*schema.REQUIRED, *design.levels):
        empty = trials[name].isna()
        if not pd.api.types.is_numeric_dtype(trials[name]):
            empty |= trials[name] == ""
        gaps = trials.index[empty]
        lines += [f"{at(trials, i)}: {name} = '': expected a value" for i in gaps]
    for name, (what, bound, closed) in schema.bounds(design).items():
        low = trials[name] < bound if closed else trials[name] <= bound
        lines += [
            f"{at(trials, i)}: {name} = {trials.at[i, name]:g}: expected {what}"
            for i in trials.index[low]
        ]
    if lines:
        raise DataError(lines)
    _check_ids(trials)
    _check_source(trials, source)


def _level_problems(table: pd.DataFrame, known: Mapping[str, Sequence[str]]) -> list[str]:
    return [
        f"{at(table, i)}: {name} = {table.at[i, name]!r}: expected {', '.join(levels)}"
        for name, levels in known.items()
        for i in table.index[~table[name].isin(levels)]
    ]


def _cell_problems(trials: pd.DataFrame, design: Design) -> list[str]:
    """Trials of cells that the study leaves out; people of two groups."""
    lines = []
    for gone in design.excluded:
        there = np.logical_and.reduce([trials[k].astype("str") == v for k, v in gone.items()])
        cell = ", ".join(f"{k} = {v}" for k, v in gone.items())
        lines += [f"{at(trials, i)}: {cell}: a cell that the study leaves out"
                  for i in trials.index[there]]  # fmt: skip
    for factor in design.groups:
        own = trials[factor.name].astype("str")
        first = own.groupby(trials["participant"].astype("str")).transform("first")
        lines += [
            f"{at(trials, i)}: {factor.name} = {own[i]!r}: expected {first[i]}, the participant's"
            for i in trials.index[own != first]
        ]
    return lines


def _check_levels(table: pd.DataFrame, names: Iterable[str], design: Design) -> None:
    if lines := _level_problems(table, {k: schema.levels(design)[k] for k in names}):
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
