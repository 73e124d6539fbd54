"""A run of data mode: tables made, participants simulated, results written as they come."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

from seethrough.experiment.errors import InputError, gathered
from seethrough.experiment.people.runs import batch as b
from seethrough.experiment.people.runs.batch_files import CHUNK, Chunk, Results, Slots
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.session.progress import Progress
from seethrough.experiment.study.beside.own_model_files import models_of, own_scenes
from seethrough.experiment.study.config import Study, find, load
from seethrough.experiment.workers import ordered_map


def run(
    job: b.Batch, out: Path, count: int, workers: int = 1, scheduler: str | None = None
) -> None:
    """Simulate what `out` lacks of `count` participants. Raises InputError.

    The numbers are the same whoever simulates: this process, `workers` of them, or the Dask
    cluster of a scheduler. KeptLooks that nobody had drawn before are added to the tables' file.
    """
    assert job.tables is not None
    study = load(job.study)
    refuse_hands(study, str(find(job.study)))
    if scheduler is not None:
        _check_models(job, study)
    if job.tables.exists():
        KeptLooks(job.tables).close()  # a file that holds something else is refused before anything
    with Results(out, study, job.about(study)) as results:
        chunks = results.missing(study.plan.slots(count))
        if results.note:
            print(results.note, file=sys.stderr)
        if not chunks:
            print(f"{out}: all {count} participants are there", file=sys.stderr)
            return
        # Few people look from few places: what they need is drawn as they come.
        if count > CHUNK or count >= job.pool:
            make_tables(job, min(count, CHUNK))
        with (
            Progress("simulating", sum(map(len, chunks))) as progress,
            closing(KeptLooks(job.tables)) as tables,
        ):
            for chunk in _played(job, chunks, workers, scheduler):
                results.add(chunk)
                tables.add(chunk.looks)  # of machines that share no disk with this one
                progress.step(f"S{chunk.slots[-1]:02d}", len(chunk.slots))


def refuse_hands(study: Study, file: str) -> None:
    """Raises InputError where what is seen depends on the pointer: tables hold what is seen from
    somewhere, and nobody's hands."""
    drawn = {part.technique_name: part.technique for part in study.parts.values()}
    hands = [name for name, p in drawn.items() if p.technique.active(p)]
    if hands:
        raise gathered(
            [
                f'{file}: technique.use = "{name}": expected a technique that no pointer moves in '
                "data mode, whose tables know none: simulate it with --mode visual"
                for name in hands
            ],
            0,
        )


def _check_models(job: b.Batch, study: Study) -> None:
    """Workers of a cluster share no disk with this machine, where a study's own models lie."""
    own = {"building.models": [m.name for m in models_of(study)], "scene.files": own_scenes(study)}
    for key, names in own.items():
        if names:
            raise InputError(
                f"{find(job.study)}: world.{key} = {list(names)}: expected none with --scheduler, "
                "whose workers have no files of this machine: use --workers"
            )


def make_tables(job: b.Batch, walkers: int) -> bool:
    """Draw every viewpoint of the pool's scenes, and of shared ones those that so many people look
    from.

    False where the tables' file says that this was done before. A building has too many viewpoints
    to draw them all beforehand.
    """
    study = load(job.study)
    what = f"{study.digest()}, {job.pool} scenes a task"
    with closing(KeptLooks(job.tables)) as looks:
        if looks.is_filled(what, walkers):
            return False
        worlds = len(b.pooled_trials(study)) * job.pool
        with Progress("making tables", worlds + walkers) as progress:
            b.fill(job, progress)
            for slot in study.plan.slots(walkers):
                b.play_chunk([slot])
                b.keep_tables()
                progress.step(f"buildings, S{slot:02d}")
        looks.mark_filled(what, walkers)
    return True


def _played(
    job: b.Batch, chunks: Sequence[Slots], workers: int, scheduler: str | None
) -> Iterator[Chunk]:
    if scheduler is not None:
        from seethrough.experiment.people.runs import cluster

        return cluster.play(job, chunks, scheduler)
    return ordered_map(b.play_files, chunks, workers, b.prepare, (job,))
