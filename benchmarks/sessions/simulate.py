"""What simulating a study costs, and how near simulated people come to the published ones.

`seethrough bench simulate` prints the whole table; `--only data,many` parts of it. Visibility
tables are made first, in a folder of their own, and timed apart; `python -m
seethrough.benchmarks.sessions.simulate --tables FILE` keeps them for the next time.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from multiprocessing.synchronize import Barrier
from pathlib import Path
from typing import TypeVar

from seethrough.benchmarks.memory import Watch
from seethrough.benchmarks.rows import Row, row
from seethrough.benchmarks.sessions import eyes
from seethrough.experiment.people.fitted.calibration import ENOUGH, FITTED, SEEN, lines, measured
from seethrough.experiment.people.fitted.fitting import Crowd
from seethrough.experiment.people.persons.profile_file import find
from seethrough.experiment.people.runs import batch, data_run
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import drawing
from seethrough.experiment.study.config import load
from seethrough.tasks.kit.skills.profile import Profile

STUDY = "published"
PROFILE = "calibrated"
POOL = 200
WORKERS = 2
MANY = 10_000
VISITORS = 500  # of visual mode, whose memory is measured
WALKERS = 128  # whose way through the buildings is drawn into the tables
LONG = 64  # participants whose seconds are measured
CHUNK = 4  # of them that a worker plays at a time
WARM = 16  # others that each worker plays before clocks run
PEOPLE = 1024  # whose times are compared with the published ones
PEOPLE_LOOKING = 8  # for each of eight trials, with each way to look


def figure(name: str, value: float, unit: str, must: float, aim: float, more: bool = False) -> Row:
    """One row; `more` where larger is better."""
    return row(name, STUDY, value, unit, must, aim, more)


def told(name: str, value: float, unit: str) -> Row:
    """A row without a goal."""
    return row(name, STUDY, value, unit)


Made = TypeVar("Made")


def timed(work: Callable[[], Made]) -> tuple[float, Made]:
    """Seconds that `work` took, and what it gave."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def visual() -> Iterator[Row]:
    """The published study through the real session, on this machine."""
    from seethrough.experiment.commands.sessions.simulate import simulate

    study = load(STUDY)
    with tempfile.TemporaryDirectory() as folder:
        seconds, _ = timed(lambda: simulate(study, 16, 1, Path(folder) / "data"))
    yield figure("16 participants, visual", seconds / 60, "min", 10, 3)


def memory() -> Iterator[Row]:
    """Many people in visual mode, one after the other before one pair of eyes."""
    words = ["simulate", "demo", "--participants", VISITORS]
    with tempfile.TemporaryDirectory() as folder, Watch(own=False) as watch:
        command = [sys.executable, "-m", "seethrough", *map(str, words), "--out", f"{folder}/data"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if watch.peak is not None:
        name = f"memory, visual, after {VISITORS} people"
        yield row(name, "demo", watch.peak, "MiB", 600, None)


def make_tables(job: batch.Batch) -> Iterator[Row]:
    """Tables of every abstract viewpoint, and of the buildings as people walk through them."""
    assert job.tables is not None
    seconds, made = timed(lambda: data_run.make_tables(job, WALKERS))
    if made:
        yield told("tables", seconds / 60, "min")


def _prepare(job: batch.Batch, together: Barrier) -> None:
    """A worker that has its tables, every world of the pool, and has played for a while.

    Nobody begins before all are ready: the start of a process takes longer than 16 participants.
    """
    batch.prepare(job)
    batch.make_worlds()
    batch.play_chunk(range(LONG + 1, LONG + WARM + 1))
    together.wait()


def _seconds(job: batch.Batch, workers: int) -> tuple[float, float]:
    """Seconds and processor seconds that so many workers take for 16 of `LONG` participants.

    One worker is a process of its own as well: it differs from two in nothing but their number.
    """
    _say(f"{LONG} participants, workers: {workers}")
    context = get_context("spawn")
    chunks = [tuple(range(i, i + CHUNK)) for i in range(1, LONG + 1, CHUNK)]
    with ProcessPoolExecutor(
        workers, context, initializer=_prepare, initargs=(job, context.Barrier(workers))
    ) as executor:
        for ready in [executor.submit(time.process_time) for _ in range(workers)]:
            ready.result()
        seconds, used = timed(lambda: list(executor.map(_processor_seconds, chunks)))
    return seconds * 16 / LONG, sum(used) * 16 / LONG


def _processor_seconds(slots: tuple[int, ...]) -> float:
    start = time.process_time()
    batch.play_files(slots)
    return time.process_time() - start


def data(job: batch.Batch) -> Iterator[Row]:
    """The published study from tables, on one worker and on two that are ready."""
    batch.prepare(job)
    batch.play_chunk(range(1, LONG + WARM + 1))  # what these people look at is drawn before
    batch.keep_tables()
    (one, processor), (two, _) = (_seconds(job, workers) for workers in (1, WORKERS))
    yield told("16 participants, data mode, one worker", one, "s")
    yield told("the same, processor time", processor, "s")
    yield figure("16 participants, data mode", two, "s", 3, 1)
    yield figure("two workers against one", one / two, "×", 1.7, 1.9, more=True)
    with tempfile.TemporaryDirectory() as folder:
        seconds, _ = timed(lambda: data_run.run(job, Path(folder) / "data", 16))
    yield told("16 participants, data mode, with its start and files", seconds, "s")


def many(job: batch.Batch, count: int = MANY) -> Iterator[Row]:
    """Many participants by the command, files and all; memory of the largest process.

    Fewer than `MANY` are told under their own number, and meet no goal.
    """
    words = ["simulate", job.study, "--mode", "data", "--seed", job.seed, "--pool", job.pool,
             "--participants", count, "--workers", WORKERS, "--tables", job.tables]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder, Watch(own=False) as watch:
        command = [sys.executable, "-m", "seethrough", *map(str, words), "--out", f"{folder}/data"]
        before = sum(os.times()[2:4])
        seconds, _ = timed(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL))
        processor = sum(os.times()[2:4]) - before
    whole = count == MANY
    name = f"{count} participants, data mode"
    yield figure(name, seconds / 60, "min", 20, 5) if whole else told(name, seconds / 60, "min")
    yield told("the same, processor time a participant", processor / count, "s")
    if watch.peak is not None:
        name, gib = f"memory at {count} participants, largest process", watch.peak / 1024
        yield figure(name, gib, "GiB", 0.7, 0.7) if whole else told(name, gib, "GiB")
        yield told("the same, all processes together", watch.total / 1024, "GiB")


def calibration(job: batch.Batch, profile: Profile) -> Iterator[Row]:
    """How many standard errors simulated measures lie from the published ones.

    As `calibrate` plays: trial by trial, so that the session's limit ends nobody's half-way.
    """
    assert job.tables is not None
    crowd = Crowd(job.seed, PEOPLE, drawing(load(STUDY), job.pool, KeptLooks(job.tables)))
    found = lines(measured(crowd.play(profile, (*FITTED, *SEEN))))
    for line in found:
        must = ENOUGH if line.fitted else None
        yield row(f"off: {line.name}", STUDY, abs(line.off), "s.e.", must, must)


def _eyes() -> Iterator[Row]:
    """What accuracy costs in time: coarser eyes against the finest."""
    for way in eyes.run(PEOPLE_LOOKING):
        more = {key: value for key, value in way.items() if key not in ("figure", "scene")}
        yield {**told(f"eyes: {way['scene']}", way["value"], way["unit"]), **more}


PARTS = ("visual", "memory", "data", "many", "calibration", "eyes")


def figures(
    only: Sequence[str] = PARTS, tables: Path | None = None, count: int = MANY
) -> Iterator[Row]:
    """The rows of these parts; tables are made anew in a folder of its own, unless given."""
    with tempfile.TemporaryDirectory() as folder:
        job = batch.Batch(STUDY, 1, POOL, tables or Path(folder) / "tables.db")
        parts: dict[str, Callable[[], Iterator[Row]]] = {
            "visual": visual,
            "memory": memory,
            "data": lambda: data(job),
            "many": lambda: many(job, count),
            "calibration": lambda: calibration(job, find(PROFILE)),
            "eyes": _eyes,
        }
        for name in only:
            _say(name)
            if name in ("data", "many", "calibration"):
                yield from make_tables(job)
            yield from parts[name]()


def chart(rows: Sequence[Row], path: Path) -> None:
    """Error of the measures against time, a point for each way to look."""
    named = [{**row, "scene": row["figure"].removeprefix("eyes: ")} for row in rows]
    eyes.draw([row for row in named if "time_error" in row], path)


def _say(what: str) -> None:
    print(f"bench simulate: {what}", file=sys.stderr, flush=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Parts of the benchmark from tables that are kept."""
    from seethrough.benchmarks.bench import line

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tables", type=Path, required=True, help="made if it is not there")
    parser.add_argument("--many", type=int, default=MANY, help="participants of the large run")
    parser.add_argument("--only", default=",".join(PARTS))
    chosen = parser.parse_args(arguments)
    for measured_row in figures(chosen.only.split(","), chosen.tables, chosen.many):
        print(line(measured_row), flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
