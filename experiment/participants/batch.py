"""Many participants in data mode: chunks of slots, played by any worker, written as they come."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from experiment.columns import TRIALS
from experiment.config import Study, load
from experiment.dataset import describe_dataset
from experiment.design import Trial, session_for
from experiment.errors import InputError
from experiment.participants.data_mode import play_session
from experiment.participants.pool import LazyDraw, Pool
from experiment.participants.profile import AVERAGE, Profile
from experiment.workers import ordered_map
from tasks.catalog import TASKS

CHUNK = 16  # participants a file: the published study's number


@dataclass(frozen=True)
class Batch:
    """What a worker needs to know; everything in it can be sent to another process."""

    study: str
    seed: int
    pool: int
    tables: Path | None = None
    profile: Profile = AVERAGE
    without: frozenset[str] = frozenset()
    draws: bool = True


_ready: dict[str, Any] = {}  # this process's study and pool: made once by `prepare`


def prepare(batch: Batch) -> None:
    """Make this process ready for `play_chunk`."""
    study = load(batch.study)
    aspect = study.display.width / study.display.height
    pool = Pool(study, batch.pool, LazyDraw(study, aspect) if batch.draws else None)
    if batch.tables is not None and batch.tables.exists():
        pool.load(batch.tables)
    _ready.update(batch=batch, study=study, pool=pool)


def play_chunk(slots: Sequence[int], profile: Profile | None = None) -> list[dict[str, Any]]:
    """Rows of the trial table of these slots, in order; `profile` instead of the batch's."""
    batch, study, pool = _ready["batch"], _ready["study"], _ready["pool"]
    person = profile or batch.profile
    rows = []
    for slot in slots:
        rows += play_session(study, slot, batch.seed, pool, person, batch.without).trials
    return rows


def play(batch: Batch, slots: Sequence[int], workers: int) -> Iterator[list[dict[str, Any]]]:
    """Rows chunk by chunk, the same whatever the number of workers."""
    chunks = [tuple(slots[i : i + CHUNK]) for i in range(0, len(slots), CHUNK)]
    return ordered_map(play_chunk, chunks, workers, prepare, (batch,))


def keep_tables() -> None:
    """Save this process's tables, with what was drawn since they were loaded."""
    batch, pool = _ready["batch"], _ready["pool"]
    if batch.tables is not None:
        pool.save(batch.tables)


def fill(batch: Batch, progress: Any = None) -> int:
    """Fill the tables of every abstract scene of the pool, and save them: looks they hold.

    Each scene is drawn from the viewpoints that a participant of this profile looks from.
    """
    from experiment.participants.tables import views_of

    prepare(batch)
    study, pool = _ready["study"], _ready["pool"]
    aspect = study.display.width / study.display.height
    for trial in abstract_trials(study):
        for which in range(batch.pool):
            view = TASKS[trial.task].view(pool.world(trial, which, aspect))
            eyes = pool.eyes(view.scene, trial.transparency)
            for camera in views_of(trial.task, view.camera):
                eyes.look(view.scene, camera)
            if progress is not None:
                progress.step(f"{trial.task} {trial.transparency}")
    assert batch.tables is not None
    pool.save(batch.tables)
    return int(pool.looks)


def abstract_trials(study: Study) -> list[Trial]:
    """One trial of each abstract task at each transparency level."""
    trials = {}
    for task_set in session_for(1, study.design.factors()):
        trial = task_set.trials[0]
        if trial.scenario == "abstract":
            trials[trial.task, trial.transparency] = trial
    return list(trials.values())


def write(
    out: Path, batch: Batch, study: Study, slots: Sequence[int], rows: Sequence[dict[str, Any]]
) -> None:
    """One chunk's table with its sidecar, whole or not at all."""
    describe_dataset(out, study.study.name)
    name = f"S{slots[0]:05d}-S{slots[-1]:05d}"
    folder = chunk_folder(out, slots)
    draft = folder.with_name(folder.name + ".part")
    draft.mkdir(parents=True, exist_ok=True)
    stem = f"study-{study.study.name}_subject-{name.replace('-', 'to')}_session-1_trials_data"
    text = io.StringIO()
    # No chain: nobody sat here whose answers could have been changed.
    names = [c.name for c in TRIALS if c.name != "chain"]
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in rows:
        writer.writerow([_cell(row.get(n)) for n in names])
    (draft / f"{stem}.csv").write_text(text.getvalue(), encoding="utf-8")
    sidecar = {
        "mode": "data: decisions from visibility tables; a tool for planning, never evidence",
        "config": study.model_dump(mode="json"),
        "simulation_seed": batch.seed,
        "profile": asdict(batch.profile),
        "without": sorted(batch.without),
        "pool": batch.pool,
    }
    (draft / f"{stem}.json").write_text(json.dumps(sidecar, indent=2) + "\n", encoding="utf-8")
    draft.rename(folder)


def chunk_folder(out: Path, slots: Sequence[int]) -> Path:
    """Where a chunk's files lie."""
    return out / "data" / "simulated" / f"S{slots[0]:05d}-S{slots[-1]:05d}"


def missing_chunks(out: Path, study: Study, count: int) -> list[tuple[int, ...]]:
    """The chunks that `out` lacks. Raises InputError for a folder of another study."""
    about = out / "dataset_description.json"
    if about.exists():
        name = json.loads(about.read_text(encoding="utf-8")).get("name")
        if name != study.study.name:
            raise InputError(f"--out = {out}: holds study {name}, expected {study.study.name}")
    slots = range(1, count + 1)
    chunks = [tuple(slots[i : i + CHUNK]) for i in range(0, count, CHUNK)]
    return [c for c in chunks if not chunk_folder(out, c).exists()]


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)
