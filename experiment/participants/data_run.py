"""A run of data mode: tables made or read, participants simulated, results written as they come."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from experiment.config import Study, find, load
from experiment.errors import InputError
from experiment.participants import batch as b
from experiment.participants.batch_files import Chunk, Results, Slots
from experiment.participants.pool import Pool
from experiment.participants.tables import load as load_tables
from experiment.progress import Progress
from experiment.workers import ordered_map

SAVE_EVERY = 300.0  # seconds after which looks drawn on the way are saved


def run(
    job: b.Batch, out: Path, count: int, workers: int = 1, scheduler: str | None = None
) -> None:
    """Simulate what `out` lacks of `count` participants. Raises InputError.

    The numbers are the same whoever simulates: this process, `workers` of them, or the Dask
    cluster of a scheduler. Looks that nobody had drawn before are added to the tables' file.
    """
    assert job.tables is not None
    study = load(job.study)
    if scheduler is not None:
        _check_models(job, study)
    if (workers > 1 or scheduler is not None) and job.tables.exists():
        load_tables(job.tables)  # a file that holds something else is refused here, not there
    with Results(out, study, job.about(study)) as results:
        chunks = results.missing(count)
        if results.note:
            print(results.note, file=sys.stderr)
        if chunks and not job.tables.exists():
            make_tables(job, min(count, b.CHUNK))
        with Progress("simulating", sum(map(len, chunks))) as progress, _Growing(job) as tables:
            for chunk in _played(job, chunks, workers, scheduler):
                results.add(chunk)
                tables.add(chunk)
                progress.step(f"S{chunk.slots[-1]:02d}", len(chunk.slots))


def _check_models(job: b.Batch, study: Study) -> None:
    """Workers of a cluster share no disk with this machine, where a study's own models lie."""
    own = [model.name for model in study.walkthrough.models]
    if own:
        raise InputError(
            f"{find(job.study)}: walkthrough.models = {own}: expected none with --scheduler, whose "
            "workers have no files of this machine: use --workers"
        )


def make_tables(job: b.Batch, walkers: int) -> None:
    """Draw every abstract viewpoint, and of the buildings those that so many people look from.

    A building has too many viewpoints to draw them all beforehand.
    """
    study = load(job.study)
    looks = len(b.abstract_trials(study)) * job.pool
    with Progress("making tables", looks + walkers) as progress:
        b.fill(job, progress)
        for slot in range(1, walkers + 1):
            b.play_chunk([slot])
            progress.step(f"buildings, S{slot:02d}")
        b.keep_tables()


def _played(
    job: b.Batch, chunks: Sequence[Slots], workers: int, scheduler: str | None
) -> Iterator[Chunk]:
    if scheduler is not None:
        from experiment.participants import cluster

        return cluster.play(job, chunks, scheduler)
    return ordered_map(b.play_files, chunks, workers, b.prepare, (job,))


class _Growing:
    """The tables' file, which takes in what was drawn on the way; now and then, and at the end."""

    def __init__(self, job: b.Batch) -> None:
        self.job = job
        self._looks: list[Any] = []
        self._saved = time.monotonic()

    def __enter__(self) -> _Growing:
        return self

    def __exit__(self, *_: object) -> None:
        self._save()

    def add(self, chunk: Chunk) -> None:
        """Remember the looks of a chunk."""
        if chunk.looks:
            self._looks.append(chunk.looks)
        if time.monotonic() - self._saved > SAVE_EVERY:
            self._save()

    def _save(self) -> None:
        if self._looks:
            assert self.job.tables is not None
            pool = Pool(load(self.job.study), self.job.pool)
            if self.job.tables.exists():
                pool.load(self.job.tables)
            for looks in self._looks:
                pool.merge(looks)
            pool.save(self.job.tables)
            self._looks.clear()
        self._saved = time.monotonic()
