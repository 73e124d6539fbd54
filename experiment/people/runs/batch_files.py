"""Data mode's results on disk: chunk by chunk, each whole or not at all.

A chunk is a folder like a participant's (CONVENTIONS.md), with the tables of up to sixteen people.
Where DuckDB is installed the same rows lie in `parquet/TABLE/`, a file a chunk: one data set for
whatever reads Parquet. A chunk's folder appears last: where there is one, everything is there.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.export.parquet import INSTALL, ParquetWriter
from seethrough.experiment.files.folders import stem_of
from seethrough.experiment.files.json_files import part_of, read_object
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.people.runs.data_mode import Played
from seethrough.experiment.people.runs.looks import Rows
from seethrough.experiment.record.chain import link, seal_of, start_of
from seethrough.experiment.record.columns import Column, with_factors
from seethrough.experiment.record.dataset import FILE, check_name, describe_dataset
from seethrough.experiment.record.record_files import cell, csv_line, header_of
from seethrough.experiment.study.config import Study
from seethrough.experiment.study.shown.described import design_entry

CHUNK = 16  # participants a folder: the published study's number
NAME = re.compile(r"S(\d{5,})-S(\d{5,})")
DRAFTS = "unfinished"  # beside `data`, so that nobody reads half a chunk

Slots = Sequence[int]


@dataclass(frozen=True)
class Chunk:
    """The files of some participants, as texts by name; made by whoever simulated them."""

    slots: tuple[int, ...]
    texts: Mapping[str, str]
    looks: Rows = field(default_factory=dict)  # drawn on a machine that can't write them itself


def chunk_name(slots: Slots) -> str:
    """The name of a chunk's folder."""
    return f"S{slots[0]:05d}-S{slots[-1]:05d}"


def render(
    about: Mapping[str, object], study: Study, slots: Slots, played: Sequence[Played]
) -> Chunk:
    """A chunk's files: `about` is its sidecar, the same for every chunk of a run."""
    stem = stem_of(study.general.name, chunk_name(slots).replace("-", "to"))
    columns = columns_of(study)
    start = start_of({**about, "chain": {}}, header_of(columns["trials"]))
    trials, last = _chained([row for p in played for row in p.trials], columns["trials"], start)
    questions = _plain([row for p in played for row in p.questions], columns["questionnaire"])
    sidecar = {**about, "chain": {"start": start}}
    texts = {f"{stem}_trials_data.csv": trials, f"{stem}_trials_data.json": _json(sidecar)}
    if any(p.questions for p in played):
        texts[f"{stem}_questionnaire_data.csv"] = questions
    early = {p.participant: p.status for p in played if p.status != "complete"}
    end = {
        "status": ", ".join(sorted(set(early.values()))) or "complete",
        "early": early,
        "trials": sum(len(p.trials) for p in played),
        "chain": last,
        "files": {
            name: hashlib.sha256(text.encode()).hexdigest()
            for name, text in texts.items()
            if "questionnaire" in name
        },
    }
    return Chunk(tuple(slots), {**texts, f"{stem}_end.json": _json({**end, "seal": seal_of(end)})})


def _plain(rows: Sequence[Mapping[str, object]], columns: tuple[Column, ...]) -> str:
    names = [c.name for c in columns]
    lines = [csv_line([cell(row.get(name)) for name in names]) for row in rows]
    return "\n".join([header_of(columns), *lines]) + "\n"


def columns_of(study: Study) -> dict[str, tuple[Column, ...]]:
    """Every table's columns in a study."""
    entry = design_entry(study)
    return with_factors(entry["factors"], entry["tasks"])


def _chained(
    rows: Sequence[Mapping[str, object]], columns: tuple[Column, ...], chain: str
) -> tuple[str, str]:
    """The trial table's text, and its chain's end."""
    names = [c.name for c in columns[:-1]]
    lines = [header_of(columns)]
    for row in rows:
        text = csv_line([cell(row.get(name)) for name in names])
        chain = link(chain, text)
        lines.append(f"{text},{chain}")
    return "\n".join(lines) + "\n", chain


def _json(content: Mapping[str, object]) -> str:
    return json.dumps(content, indent=2) + "\n"


class Results(AbstractContextManager["Results"]):
    """A data folder that grows by chunks. Raises InputError for one of another study or run."""

    def __init__(self, out: Path, study: Study, about: Mapping[str, object]) -> None:
        self.out = out
        self._folder = out / "data" / "simulated"
        self._check(study, about)
        describe_dataset(out, study.general.name, columns_of(study))
        try:
            self._parquet: ParquetWriter | nullcontext[None] = ParquetWriter()
            self.note = ""
        except ModuleNotFoundError:
            self._parquet = nullcontext()
            self.note = f"no Parquet files, only CSV: they need DuckDB: {INSTALL}"
        try:
            self._mend_parquet()
        except OSError as error:
            raise InputError(f"{out / 'parquet'}: cannot be written: {error.strerror}") from None

    def __exit__(self, *error: object) -> None:
        self._parquet.__exit__(None, None, None)
        shutil.rmtree(self.out / DRAFTS, ignore_errors=True)

    def missing(self, slots: Slots) -> list[tuple[int, ...]]:
        """Those slots that are not there yet, in chunks."""
        there = {slot for a, b in self._there() for slot in range(a, b + 1)}
        chunks: dict[int, list[int]] = {}
        for slot in sorted(slots):
            if slot not in there:
                chunks.setdefault((slot - 1) // CHUNK, []).append(slot)
        return [run for chunk in chunks.values() for run in _runs(chunk)]

    def add(self, chunk: Chunk) -> None:
        """Write a chunk; it is on disk when this returns. Raises InputError."""
        name = chunk_name(chunk.slots)
        draft = self.out / DRAFTS / name
        try:
            if draft.exists():
                shutil.rmtree(draft)
            make_folder(draft)
            for file, text in chunk.texts.items():
                write_new(draft / file, text)
            self._as_parquet(draft, name)
            make_folder(self._folder)
            draft.rename(self._folder / name)
        except OSError as error:
            raise InputError(f"{draft}: cannot be written: {error.strerror}") from None

    def _mend_parquet(self) -> None:
        """Parquet files for exactly the chunks that are there.

        A run that was killed leaves files of a chunk whose folder had not appeared yet, which may
        be made again in other pieces; one without DuckDB leaves chunks without files.
        """
        for file in self.out.glob("parquet/*/*.parquet"):
            if NAME.fullmatch(file.stem) and not (self._folder / file.stem).is_dir():
                file.unlink()
        for slots in self._there():
            name = chunk_name(slots)
            self._as_parquet(self._folder / name, name)

    def _as_parquet(self, folder: Path, name: str) -> None:
        """The Parquet files that a chunk lacks, of the tables in `folder`."""
        if not isinstance(self._parquet, ParquetWriter):
            return
        for path in folder.glob("*_data.csv"):
            table = path.stem.split("_")[-2]
            whole = self.out / "parquet" / table / f"{name}.parquet"
            if whole.exists():
                continue
            make_folder(whole.parent)
            make_folder(self.out / DRAFTS)
            part = self.out / DRAFTS / f"{name}-{table}.parquet"
            self._parquet.write(table, [path], part)
            part.replace(whole)

    def _there(self) -> Iterator[tuple[int, int]]:
        for folder in sorted(self._folder.glob("*")):
            found = NAME.fullmatch(folder.name)
            if not found:
                raise InputError(
                    f"--out = {self.out}: holds {folder.name} of visual mode: data mode expects a "
                    "folder of its own"
                )
            yield int(found[1]), int(found[2])

    def _check(self, study: Study, about: Mapping[str, object]) -> None:
        """One folder holds one study, simulated in one way."""
        described = self.out / FILE
        if described.exists():
            check_name(described, study.general.name)
        list(self._there())
        sidecar = next(self._folder.glob("*/*_trials_data.json"), None)
        if sidecar is None:
            return
        before = part_of(read_object(sidecar), "provenance", sidecar)
        # As JSON gives it back: tuples are lists there.
        for key, value in json.loads(json.dumps(about["provenance"])).items():
            if before.get(key) != value:
                short = f": {before.get(key)}, expected {value}" if key not in LONG else ""
                raise InputError(f"--out = {self.out}: simulated with another {key}{short}")


LONG = ("study", "study_sha256", "profile")  # keys whose values are too long for a line


def _runs(slots: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Consecutive slots together."""
    run: list[int] = []
    for slot in slots:
        if run and slot != run[-1] + 1:
            yield tuple(run)
            run = []
        run.append(slot)
    yield tuple(run)
