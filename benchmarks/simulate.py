"""What simulating a study costs, and how near simulated people come to the published ones.

`seethrough bench simulate` prints the whole table; `--only data,many` parts of it. Visibility
tables are made first, in a folder of their own, and timed apart; `python -m benchmarks.simulate
--tables FILE` keeps them for the next time.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks import eyes
from benchmarks.memory import Watch
from benchmarks.rows import Row, row
from experiment.config import load
from experiment.participants import batch, data_run
from experiment.participants.calibration import FITTED, HELD_OUT, measured, published
from experiment.participants.profile import Profile
from experiment.participants.profile_file import find
from experiment.workers import ordered_map

STUDY = "published"
PROFILE = "calibrated"
POOL = 200
WORKERS = 2
MANY = 10_000
LONG = 64  # participants of the longer of two runs, whose difference is what 16 cost
CHUNK = 4  # participants a worker plays at a time where seconds are measured


def figure(name: str, value: float, unit: str, must: float, aim: float, more: bool = False) -> Row:
    """One row; `more` where larger is better."""
    return row(name, STUDY, value, unit, must, aim, more)


def told(name: str, value: float, unit: str) -> Row:
    """A row without a goal."""
    return row(name, STUDY, value, unit)


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds that `work` took, and what it gave."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def visual() -> Iterator[Row]:
    """The published study through the real session, on this machine."""
    from experiment.commands.simulate import simulate

    study = load(STUDY)
    with tempfile.TemporaryDirectory() as folder:
        seconds, _ = timed(lambda: simulate(study, 16, 1, Path(folder) / "data"))
    yield figure("16 participants, visual", seconds / 60, "min", 10, 3)


def make_tables(job: batch.Batch) -> Iterator[Row]:
    """Tables of every abstract viewpoint, and of the buildings as 16 people walk through them."""
    assert job.tables is not None
    if not job.tables.exists():
        seconds, _ = timed(lambda: data_run.make_tables(job, 16))
        yield told("tables", seconds / 60, "min")


def _prepare(job: batch.Batch) -> None:
    """A worker that has its tables and has made every world of the pool, before clocks run."""
    batch.prepare(job)
    batch.make_worlds()


def _rows(job: batch.Batch, count: int, workers: int, chunk: int = CHUNK) -> list[dict[str, Any]]:
    slots = range(1, count + 1)
    chunks = [tuple(slots[i : i + chunk]) for i in range(0, count, chunk)]
    _say(f"{count} participants on {workers} workers")
    results = ordered_map(batch.play_chunk, chunks, workers, _prepare, (job,))
    return [row for rows in results for row in rows]


def data(job: batch.Batch) -> Iterator[Row]:
    """The published study from tables, on one worker and on two.

    What the start of the processes costs is in both runs of a pair, and cancels.
    """
    _rows(job, LONG, 1)  # whatever these people look at is drawn before clocks run
    batch.keep_tables()
    seconds = {}
    for workers in (1, WORKERS):
        few, _ = timed(lambda w=workers: _rows(job, 16, w))  # type: ignore[misc]
        more, _ = timed(lambda w=workers: _rows(job, LONG, w))  # type: ignore[misc]
        seconds[workers] = (more - few) * 16 / (LONG - 16)
    yield told("16 participants, data mode, one worker", seconds[1], "s")
    yield figure("16 participants, data mode", seconds[WORKERS], "s", 3, 1)
    ratio = seconds[1] / seconds[WORKERS]
    yield figure("two workers against one", ratio, "×", 1.7, 1.9, more=True)


def many(job: batch.Batch, count: int = MANY) -> Iterator[Row]:
    """Many participants as `simulate` plays them, files and all; memory of the largest process."""
    with tempfile.TemporaryDirectory() as folder, Watch() as watch:
        out = Path(folder) / "data"
        seconds, _ = timed(lambda: data_run.run(job, out, count, WORKERS))
    yield figure(f"{count} participants, data mode", seconds / 60, "min", 30, 5)
    if watch.peak is not None:
        yield figure(f"memory at {count} participants", watch.peak / 1024, "GiB", 1, 1)


def calibration(job: batch.Batch, profile: Profile, count: int = 64) -> Iterator[Row]:
    """How far simulated times lie from the published ones, fitted and held-out half."""
    found = measured(_rows(replace(job, profile=profile), count, WORKERS))
    for half, tasks in (("fitted", FITTED), ("held out", HELD_OUT)):
        means = max(_off(found[t].means, published()[t].means) for t in tasks)
        sds = max(_off(found[t].sds, published()[t].sds) for t in tasks)
        r = max(abs(found[t].r - published()[t].r) for t in tasks)
        yield figure(f"time means off, {half}", means, "share", 0.15, 0.05)
        yield figure(f"time s.d. off, {half}", sds, "share", 0.30, 0.15)
        yield figure(f"time r off, {half}", r, "", 0.2, 0.1)


def _off(ours: Sequence[float], theirs: Sequence[float]) -> float:
    return max(abs(a / b - 1) for a, b in zip(ours, theirs, strict=True))


def _eyes() -> Iterator[Row]:
    """What accuracy costs in time: coarser eyes against the finest."""
    for way in eyes.run(4):
        more = {key: way[key] for key in ("time_error", "count_error")}
        yield {**told(f"eyes: {way['scene']}", way["value"], way["unit"]), **more}


PARTS = ("visual", "data", "many", "calibration", "eyes")


def figures(
    only: Sequence[str] = PARTS, tables: Path | None = None, count: int = MANY
) -> Iterator[Row]:
    """The rows of these parts; tables are made anew in a folder of its own, unless given."""
    with tempfile.TemporaryDirectory() as folder:
        job = batch.Batch(STUDY, 1, POOL, tables or Path(folder) / "tables.npz")
        parts: dict[str, Callable[[], Iterator[Row]]] = {
            "visual": visual,
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
    from experiment.commands.bench import line

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
